//! Peak memory of this process and its memory budget. Work that would exceed the budget is refused
//! before it begins.

mod allowance;

pub use allowance::{CircuitSize, CircuitWork, Memory, MemoryError, compiling_seconds};
pub(crate) use allowance::{QUBITS_OF_ONE_TURN, bytes_of_rows, bytes_of_templates};

/// Returns the peak resident memory since the process began, in bytes. It is Linux's `VmHWM`,
/// correct to within the few pages per core that the kernel has not yet counted. `None` on systems
/// that report it only through foreign calls.
///
/// ```
/// if let Some(bytes) = qrt_runtime::memory::peak_resident_bytes() {
///     assert!(bytes > 100_000);
/// }
/// ```
pub fn peak_resident_bytes() -> Option<u64> {
    if cfg!(target_os = "linux") {
        high_water_mark(&std::fs::read_to_string("/proc/self/status").ok()?)
    } else {
        None
    }
}

/// The line `VmHWM:     1234 kB` of `/proc/PID/status` (proc(5): kB is 1,024 bytes).
fn high_water_mark(status: &str) -> Option<u64> {
    kilobytes(status, "VmHWM:")
}

fn kilobytes(text: &str, name: &str) -> Option<u64> {
    let value = text.lines().find_map(|line| line.strip_prefix(name))?;
    value
        .strip_suffix("kB")?
        .trim()
        .parse::<u64>()
        .ok()?
        .checked_mul(1024)
}

/// Returns the memory that this process may use, in bytes: the least of the machine's memory, the
/// limit of its control group, and the limit on its address space. `None` on systems that report
/// these only through foreign calls.
pub(crate) fn allowed_bytes() -> Option<u64> {
    if cfg!(not(target_os = "linux")) {
        return None;
    }
    let read = |path: &str| std::fs::read_to_string(path).ok();
    let machine = read("/proc/meminfo").and_then(|text| kilobytes(&text, "MemTotal:"));
    let group = read("/sys/fs/cgroup/memory.max").and_then(|text| text.trim().parse().ok());
    let space = read("/proc/self/limits").and_then(|text| address_space(&text));
    [machine, group, space].into_iter().flatten().min()
}

/// The soft limit in the line `Max address space 1024000000 unlimited bytes` of `/proc/PID/limits`.
fn address_space(limits: &str) -> Option<u64> {
    let mut lines = limits.lines();
    let limits = lines.find_map(|line| line.strip_prefix("Max address space"))?;
    limits.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_is_found_and_anything_else_is_none() {
        assert_eq!(
            high_water_mark("Name:\tqrt\nVmHWM:\t   1234 kB\nX:\t1\n"),
            Some(1_263_616)
        );
        for bad in [
            "",
            "VmHWM:\t1234",
            "VmHWM:\t-1 kB",
            "VmHWM:\t99999999999999999999 kB",
        ] {
            assert_eq!(high_water_mark(bad), None);
        }
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn touched_memory_counts_and_stays_counted() {
        // Sandboxed kernels may leave the line out.
        if peak_resident_bytes().is_none() {
            return;
        }
        let touched = vec![1u8; 64 << 20];
        assert!(std::hint::black_box(&touched).iter().all(|&b| b == 1));
        // The kernel sums its counters only now and then, so the test allows an eighth to be
        // missing.
        assert!(peak_resident_bytes().unwrap() >= 56 << 20);
        drop(touched);
        assert!(peak_resident_bytes().unwrap() >= 56 << 20);
    }

    #[test]
    fn the_limit_on_the_address_space_is_found() {
        let limits = "Limit  Soft Limit  Hard Limit  Units\nMax address space  1024000000  unlimited  bytes\n";
        assert_eq!(address_space(limits), Some(1_024_000_000));
        assert_eq!(
            address_space("Max address space  unlimited  unlimited  bytes"),
            None
        );
        if cfg!(target_os = "linux") {
            assert!(allowed_bytes().is_some_and(|bytes| bytes > 1 << 20));
        }
    }
}
