//! Work that is distributed over the processor's cores.

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Number of threads of a computation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cores {
    /// The caller's thread alone.
    #[default]
    One,
    /// All threads that the machine can run at a time.
    All,
}

impl Cores {
    fn count(self) -> usize {
        match self {
            Self::One => 1,
            // A browser has one thread and does not report it.
            Self::All => thread::available_parallelism().map_or(1, NonZeroUsize::get),
        }
    }

    /// Applies `of` to each item and returns the results in the items' order. A thread takes
    /// `at_a_time` items at a time.
    pub fn map<T: Sync, R: Send>(
        self,
        items: &[T],
        at_a_time: usize,
        of: impl Fn(&T) -> R + Sync,
    ) -> Vec<R> {
        let threads = self.count().min(items.len().div_ceil(at_a_time));
        if threads < 2 {
            return items.iter().map(of).collect();
        }
        let next = AtomicUsize::new(0);
        let work = || {
            let mut parts = Vec::new();
            loop {
                let first = next.fetch_add(at_a_time, Ordering::Relaxed);
                let Some(rest) = items.get(first..).filter(|rest| !rest.is_empty()) else {
                    return parts;
                };
                let part = &rest[..at_a_time.min(rest.len())];
                parts.push((first, part.iter().map(&of).collect::<Vec<R>>()));
            }
        };
        let mut parts = thread::scope(|scope| {
            // If the machine has no thread left, this thread does all the work.
            let spawn = |_| thread::Builder::new().spawn_scoped(scope, work).ok();
            let others: Vec<_> = (1..threads).filter_map(spawn).collect();
            let mut parts = work();
            for other in others {
                match other.join() {
                    Ok(more) => parts.extend(more),
                    Err(panic) => std::panic::resume_unwind(panic),
                }
            }
            parts
        });
        parts.sort_unstable_by_key(|(first, _)| *first);
        parts.into_iter().flat_map(|(_, part)| part).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_the_order_of_the_items() {
        for length in [0, 1, 2, 16, 1000, 1003] {
            let items: Vec<usize> = (0..length).collect();
            let squares: Vec<usize> = items.iter().map(|item| item * item).collect();
            for cores in [Cores::One, Cores::All] {
                for at_a_time in [1, 7, 64] {
                    let found = cores.map(&items, at_a_time, |item| item * item);
                    assert_eq!(found, squares, "{length}");
                }
            }
        }
    }
}
