//! Circuits for other programs, as OpenQASM.
//!
//! An [`Export`] writes the oracle, the Grover iterate or the whole counting circuit of a pixel as
//! flat OpenQASM 3 or 2, gate by gate and without holding it.
//!
//! # Which OpenQASM
//!
//! As little as there can be: registers, single gates of the standard library on single qubits,
//! numbers as angles, one measurement a line. No `gate`, `def`, modifier, loop, broadcast or constant
//! expression. So Qiskit (two importers of OpenQASM 3, one of 2), Q#, Cirq and MQT Core read both
//! languages. pytket reads OpenQASM 2. PennyLane reads OpenQASM 3 without the lines of `include` and
//! of measurements. (`benches/peers/openqasm.py` has them do it.)
//!
//! | gate | OpenQASM 3 | OpenQASM 2 |
//! |---|---|---|
//! | X, CNOT, Toffoli, Hadamard | `x`, `cx`, `ccx`, `h` | the same |
//! | a sign on one qubit, two, three | `z`, `cz`, `h ccx h` | the same |
//! | another phase on one qubit, two | `p`, `cp` | `u1`, `cu1` |
//! | a rotation | `ry` | `ry` |
//!
//! The Grover iterate's global phase of -1 is `z x z x` on one qubit: whoever puts the circuit under
//! a control counts the right ids.
//!
//! # Registers
//!
//! `path` and `comparator`, the id (or `ids` alone); `work`, zero before and after; for counting also
//! `counter`, whose qubits are measured into `outcome`, and for the sine window `bond`, which is zero
//! before and after. Bit 0 of each is its least significant.
//!
//! ```
//! use qrt_circuit::quantum::{Counting, Part, PhaseOracle};
//! use qrt_core::scene::Window;
//! use qrt_runtime::export::{Export, Format};
//!
//! // 3 of 4 ids are good; one bit of phase.
//! let oracle = PhaseOracle::polynomial(2, vec![vec![0], vec![1], vec![0, 1]])?;
//! let counting = Counting::new(&oracle, 1, Window::Rect)?;
//! let mut text = Vec::new();
//! let written = Export::new(&counting, Part::Oracle, None)?.write(Format::OpenQasm3, &[], &mut text)?;
//! assert_eq!(
//!     String::from_utf8(text)?,
//!     "\
//! OPENQASM 3.0;
//! include \"stdgates.inc\";
//! qubit[2] ids;
//! z ids[0];
//! z ids[1];
//! cz ids[0], ids[1];
//! // 2 qubits, 3 gates: 2 z, 1 cz
//! "
//! );
//! assert_eq!(written.gates(), 3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod error;
mod format;
mod gates;
#[cfg(test)]
mod tests;

pub use error::ExportError;
pub use format::Format;
pub use gates::Tally;

use gates::Writer;
use qrt_circuit::Qubit;
use qrt_circuit::quantum::{Counting, Part};
use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};

/// How many gates are written between two looks at what may end the writing.
const STRIDE: u64 = 1 << 16;

/// A register of an exported circuit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Register {
    /// Its name.
    pub name: &'static str,
    /// Its qubits in the circuit that is exported, bit 0 first.
    pub qubits: Vec<Qubit>,
}

/// A part of a counting circuit, to be written.
///
/// OpenQASM's libraries have no sign on more than three qubits. O_0's is on those of the id and, in a
/// counting circuit, on its control: [`Counting::with`] and
/// [`Conjunction::Toffolis`](qrt_circuit::quantum::Conjunction::Toffolis) make circuits without.
#[derive(Clone)]
pub struct Export<'a> {
    counting: &'a Counting<'a>,
    part: Part,
    registers: Vec<Register>,
    cancel: Option<&'a AtomicBool>,
    progress: Option<&'a dyn Fn(u64)>,
}

impl std::fmt::Debug for Export<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Export")
            .field("part", &self.part)
            .field("registers", &self.registers)
            .finish_non_exhaustive()
    }
}

impl<'a> Export<'a> {
    /// A part of a circuit. Of its id the lowest `path_bits` are called `path` and the others
    /// `comparator`; without such a number it is `ids` (`id` is a gate in OpenQASM).
    ///
    /// # Errors
    /// The id has fewer bits.
    pub fn new(
        counting: &'a Counting<'a>,
        part: Part,
        path_bits: Option<u32>,
    ) -> Result<Self, ExportError> {
        let id = counting.iterate().oracle().superposed();
        let mut registers = match path_bits {
            None => vec![("ids", id.to_vec())],
            Some(bits) => {
                let split = id.split_at_checked(bits as usize);
                let (path, comparator) = split.ok_or(ExportError::PathBits {
                    path_bits: bits,
                    id: id.len() as u32,
                })?;
                vec![("path", path.to_vec()), ("comparator", comparator.to_vec())]
            }
        };
        // Beyond the iterate's qubits are the counting register's, and the window's bond.
        let iterate = counting.iterate().qubits().min(counting.qubits_of(part));
        let work = (0..iterate).filter(|qubit| !id.contains(qubit)).collect();
        registers.push(("work", work));
        if part == Part::Counting {
            let counter = counting.counter();
            registers.push(("counter", counter.to_vec()));
            let bond = counter.last().map_or(iterate, |last| last + 1);
            registers.push(("bond", (bond..counting.qubits()).collect()));
        }
        Ok(Self {
            counting,
            part,
            registers: registers
                .into_iter()
                .filter(|(_, qubits)| !qubits.is_empty())
                .map(|(name, qubits)| Register { name, qubits })
                .collect(),
            cancel: None,
            progress: None,
        })
    }

    /// With a flag that ends the writing, which is looked at now and then.
    pub fn with_cancel(mut self, cancel: &'a AtomicBool) -> Self {
        self.cancel = Some(cancel);
        self
    }

    /// With what is told, now and then, how many gates have been written since it was told last.
    pub fn with_progress(mut self, progress: &'a dyn Fn(u64)) -> Self {
        self.progress = Some(progress);
        self
    }

    /// The registers, in the order in which they are declared; none is empty.
    pub fn registers(&self) -> &[Register] {
        &self.registers
    }

    /// Qubits, of all registers.
    pub fn qubits(&self) -> u32 {
        self.counting.qubits_of(self.part)
    }

    /// Gates of the circuit. The text has a few more: some are written as several.
    pub fn gates(&self) -> u64 {
        self.counting.gates(self.part)
    }

    /// Writes the circuit, with `comments` under its header, a line each. What cannot stand in a
    /// comment, line breaks and all that is not ASCII, is escaped.
    ///
    /// # Errors
    /// What `out` says; the flag to end it; a sign on more than three qubits, of which the oracle of
    /// a scene has none. Some text may have been written by then.
    pub fn write(
        &self,
        format: Format,
        comments: &[String],
        out: &mut impl Write,
    ) -> Result<Tally, ExportError> {
        self.check_cancelled()?;
        let mut out = Writer::new(format, &self.registers, self.qubits(), out);
        out.header(comments)?;
        let (mut sent, mut told) = (0, 0);
        self.counting.part(self.part, &mut |gate| {
            out.gate(gate)?;
            sent += 1;
            if sent % STRIDE == 0 {
                self.check_cancelled()?;
                if let Some(progress) = self.progress {
                    progress(sent - told);
                    told = sent;
                }
            }
            Ok::<(), ExportError>(())
        })?;
        if self.part == Part::Counting {
            out.measure(self.counting.counter().len())?;
        }
        Ok(out.end()?)
    }

    fn check_cancelled(&self) -> Result<(), ExportError> {
        match self.cancel {
            Some(cancel) if cancel.load(Ordering::Relaxed) => Err(ExportError::Interrupted),
            _ => Ok(()),
        }
    }
}
