//! Export of circuits as OpenQASM, for other programs.
//!
//! An [`Export`] writes the oracle, the Grover iterate or the whole counting circuit of a pixel as
//! flat OpenQASM 3 or 2. It writes gate by gate and does not hold the circuit in memory.
//!
//! # Subset of OpenQASM
//!
//! The text uses the smallest subset: registers, single gates of the standard library on single
//! qubits, numbers as angles, one measurement a line. It has no `gate`, `def`, modifier, loop,
//! broadcast or constant expression. Therefore Qiskit (two importers of OpenQASM 3, one of 2), Q#,
//! Cirq and MQT Core read both languages. pytket reads OpenQASM 2. PennyLane reads OpenQASM 3
//! without the lines of `include` and of measurements. (`benches/peers/openqasm.py` runs them.)
//!
//! | gate | OpenQASM 3 | OpenQASM 2 |
//! |---|---|---|
//! | X, CNOT, Toffoli, Hadamard | `x`, `cx`, `ccx`, `h` | the same |
//! | a phase flip on one qubit, two, three | `z`, `cz`, `h ccx h` | the same |
//! | another phase on one qubit, two | `p`, `cp` | `u1`, `cu1` |
//! | a rotation | `ry` | `ry` |
//!
//! The Grover iterate's global phase of -1 is `z x z x` on one qubit. With it, phase estimation of
//! the circuit under a control counts the good basis states. Without it, phase estimation would
//! count the others.
//!
//! # Registers
//!
//! `index` is in superposition; the caller may name parts of it. `work` is zero before and after. A
//! counting circuit also has `phase_register`, whose qubits are measured into `outcome`, and for
//! the sine window `bond`, which is zero before and after. Bit 0 of each register is its least
//! significant.
//!
//! ```
//! use qrt_circuit::quantum::{CountingCircuit, CircuitPart, PhaseOracle, Window};
//! use qrt_circuit::export::{Export, ExportFormat};
//!
//! // 3 of 4 basis states are good; one bit of phase.
//! let oracle = PhaseOracle::polynomial(2, vec![vec![0], vec![1], vec![0, 1]])?;
//! let counting = CountingCircuit::new(&oracle, 1, Window::Rect)?;
//! let mut text = Vec::new();
//! let export = Export::new(&counting, CircuitPart::Oracle, &[])?;
//! let written = export.write(ExportFormat::OpenQasm3, &[], &mut text)?;
//! assert_eq!(
//!     String::from_utf8(text)?,
//!     "\
//! OPENQASM 3.0;
//! include \"stdgates.inc\";
//! qubit[2] index;
//! z index[0];
//! z index[1];
//! cz index[0], index[1];
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
pub use format::ExportFormat;
pub use gates::ExportCounts;

use crate::quantum::{CircuitPart, CountingCircuit, MeanPhaseCircuit, QuantumGate, Turns};
use crate::{Gate, GateCircuit, Program, Qubit, lower};
use gates::Writer;
use std::borrow::Cow;
use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};

/// Number of gates between two checks of the cancel flag.
const STRIDE: u64 = 1 << 16;

/// Name of the phase register. (OpenQASM has a gate `phase`, and a gate `id`.)
const PHASE_REGISTER: &str = "phase_register";

/// A register of an exported circuit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExportRegister {
    /// The register's name, as the text declares it.
    pub name: Cow<'static, str>,
    /// The register's qubits in the circuit that is exported, bit 0 first.
    pub qubits: Vec<Qubit>,
}

/// A part of a counting circuit, ready to be written.
///
/// OpenQASM's libraries have no phase flip on more than three qubits. The phase flip of O_0 is on
/// all qubits in superposition and, in a counting circuit, on its control.
/// [`CountingCircuit::with`] and [`Conjunction::Toffolis`](crate::quantum::Conjunction::Toffolis)
/// make circuits without a phase flip on more than three qubits.
#[derive(Clone)]
pub struct Export<'a> {
    circuit: Circuit<'a>,
    registers: Vec<ExportRegister>,
    /// The measured qubits: those of the phase register, if there is one.
    measured: Vec<Qubit>,
    cancel: Option<&'a AtomicBool>,
    progress: Option<&'a dyn Fn(u64)>,
}

/// The circuit that is exported.
#[derive(Clone, Copy, Debug)]
enum Circuit<'a> {
    Part(&'a CountingCircuit<'a>, CircuitPart),
    MeanPhase(&'a MeanPhaseCircuit<'a>),
}

impl Circuit<'_> {
    fn qubits(self) -> u32 {
        match self {
            Self::Part(counting, part) => counting.qubits_of(part),
            Self::MeanPhase(circuit) => circuit.qubits(),
        }
    }

    fn gates(self) -> u64 {
        match self {
            Self::Part(counting, part) => counting.gates(part),
            Self::MeanPhase(circuit) => circuit.gates(),
        }
    }

    fn apply<E>(self, sink: &mut impl FnMut(QuantumGate<'_>) -> Result<(), E>) -> Result<(), E> {
        match self {
            Self::Part(counting, part) => counting.part(part, sink),
            Self::MeanPhase(circuit) => circuit.apply(sink),
        }
    }
}

impl std::fmt::Debug for Export<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Export")
            .field("registers", &self.registers)
            .finish_non_exhaustive()
    }
}

impl<'a> Export<'a> {
    /// Prepares a part of a circuit for writing.
    ///
    /// `parts` names parts of the index, whose qubits are in superposition or fixed. It has the
    /// name and the number of qubits of each register, from the index's bit 0 upwards. The rest of
    /// the index is called `index`.
    ///
    /// # Errors
    /// The index has fewer qubits than `parts` in all.
    pub fn new(
        counting: &'a CountingCircuit<'a>,
        part: CircuitPart,
        parts: &[(&'static str, u32)],
    ) -> Result<Self, ExportError> {
        let index = counting.iterate().oracle().index();
        let mut registers = index_registers(index, parts)?;
        // The phase register's qubits and the window's bond follow the iterate's qubits.
        let iterate = counting.iterate().qubits().min(counting.qubits_of(part));
        let work = (0..iterate)
            .filter(|qubit| !index.contains(qubit))
            .collect();
        registers.push(("work", work));
        let mut measured = Vec::new();
        if part == CircuitPart::Counting {
            let phase = counting.phase_register();
            measured = phase.to_vec();
            registers.push((PHASE_REGISTER, phase.to_vec()));
            let bond = phase.last().map_or(iterate, |last| last + 1);
            registers.push(("bond", (bond..counting.qubits()).collect()));
        }
        Ok(Self::with_registers(
            Circuit::Part(counting, part),
            registers,
            measured,
        ))
    }

    /// Prepares a mean-phase circuit for writing.
    ///
    /// `parts` names parts of the path index, as in [`Export::new`]. The register `sign` is the sign
    /// qubit, and `work` is zero before and after. Bit 0 of `outcome` is the sign qubit's, the others
    /// are those of the path index.
    ///
    /// # Errors
    /// As [`Export::new`].
    pub fn mean_phase(
        circuit: &'a MeanPhaseCircuit<'a>,
        parts: &[(&'static str, u32)],
    ) -> Result<Self, ExportError> {
        let paths = circuit.oracle().index();
        let mut registers = index_registers(paths, parts)?;
        registers.push(("work", circuit.ancillas()));
        registers.push(("sign", vec![circuit.sign()]));
        let measured = [&[circuit.sign()], paths].concat();
        Ok(Self::with_registers(
            Circuit::MeanPhase(circuit),
            registers,
            measured,
        ))
    }

    fn with_registers(
        circuit: Circuit<'a>,
        registers: Vec<(&'static str, Vec<Qubit>)>,
        measured: Vec<Qubit>,
    ) -> Self {
        let used = registers
            .into_iter()
            .filter(|(_, qubits)| !qubits.is_empty());
        let registers = used.map(|(name, qubits)| ExportRegister {
            name: name.into(),
            qubits,
        });
        Self {
            circuit,
            registers: registers.collect(),
            measured,
            cancel: None,
            progress: None,
        }
    }

    /// Sets a flag that ends the writing. The export checks it every few ten thousand gates.
    pub fn with_cancel(mut self, cancel: &'a AtomicBool) -> Self {
        self.cancel = Some(cancel);
        self
    }

    /// Sets a function that is called every few ten thousand gates with the number of gates written
    /// since its last call.
    pub fn with_progress(mut self, progress: &'a dyn Fn(u64)) -> Self {
        self.progress = Some(progress);
        self
    }

    /// Returns the registers in the order of their declarations; none is empty.
    pub fn registers(&self) -> &[ExportRegister] {
        &self.registers
    }

    /// Number of qubits of all registers together.
    pub fn qubits(&self) -> u32 {
        self.circuit.qubits()
    }

    /// Number of gates of the circuit. The text has a few more, since some are written as several.
    pub fn gates(&self) -> u64 {
        self.circuit.gates()
    }

    /// Writes the circuit, with `comments` under its header, a line each.
    ///
    /// Line breaks and characters outside ASCII, which comments cannot contain, are escaped.
    ///
    /// # Errors
    /// An error of `out`; [`ExportError::Interrupted`] if the cancel flag is set; a phase flip on
    /// more than three qubits, which the oracle of a scene does not have. By then a part of the
    /// text may have been written.
    pub fn write(
        &self,
        format: ExportFormat,
        comments: &[String],
        out: &mut impl Write,
    ) -> Result<ExportCounts, ExportError> {
        self.check_cancelled()?;
        let mut out = Writer::new(format, &self.registers, self.qubits(), out);
        out.header(comments, self.measured.len())?;
        let (mut sent, mut told) = (0, 0);
        self.circuit.apply(&mut |gate| {
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
        out.measure(&self.measured)?;
        Ok(out.end()?)
    }

    fn check_cancelled(&self) -> Result<(), ExportError> {
        match self.cancel {
            Some(cancel) if cancel.load(Ordering::Relaxed) => Err(ExportError::Interrupted),
            _ => Ok(()),
        }
    }
}

/// The registers of an index whose parts have names; the rest is called `index`.
fn index_registers(
    index: &[Qubit],
    parts: &[(&'static str, u32)],
) -> Result<Vec<(&'static str, Vec<Qubit>)>, ExportError> {
    let mut registers = Vec::new();
    let mut rest = index;
    for &(name, bits) in parts {
        let split = rest.split_at_checked(bits as usize);
        let (part, others) = split.ok_or(ExportError::IndexBits {
            parts: parts.iter().map(|(_, bits)| bits).sum(),
            index: index.len() as u32,
        })?;
        registers.push((name, part.to_vec()));
        rest = others;
    }
    registers.push(("index", rest.to_vec()));
    Ok(registers)
}

impl Program {
    /// Writes the program as OpenQASM: [`write_program`].
    ///
    /// ```
    /// use qrt_circuit::export::ExportFormat;
    /// use qrt_circuit::{Declaration, Machine, Operand, Recorder, Style, Type};
    ///
    /// let mut recorder = Recorder::new(Style::InPlace);
    /// let mut sum = recorder.input(&Declaration::work("sum", Type::UInt, 2));
    /// recorder.xor_into(&mut sum, Operand::Constant(2), None);
    /// let mut text = Vec::new();
    /// let tally = recorder.finish().write(ExportFormat::OpenQasm3, &mut text)?;
    /// assert_eq!(tally.by_name["x"], 1);
    /// assert!(String::from_utf8(text)?.contains("x sum[1];"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// An error of `out`. A program with classical parameters: [`Program::bound`] sets them.
    pub fn write(
        &self,
        format: ExportFormat,
        out: &mut impl Write,
    ) -> Result<ExportCounts, ExportError> {
        write_program(self, &[], format, &[], out)
    }
}

/// Writes a reversible program.
///
/// Its inputs and its results become registers of their names. Characters that OpenQASM's names
/// lack become `_`. A name gets the prefix `r_` if it is a word or a gate of OpenQASM, has one
/// letter, or does not begin with a lower-case letter. All other qubits, which are zero before and
/// after, become `work`. `words` are the contents of the classical parameters. `comments` are as in
/// [`Export::write`].
///
/// # Errors
/// An error of `out`; a parameter without a word.
pub fn write_program(
    program: &Program,
    words: &[u64],
    format: ExportFormat,
    comments: &[String],
    out: &mut impl Write,
) -> Result<ExportCounts, ExportError> {
    let circuit = lower::circuit(program);
    let registers = registers(program, &circuit);
    let mut out = Writer::new(format, &registers, circuit.qubits, out);
    out.header(comments, 0)?;
    for gate in &circuit.gates {
        match *gate {
            Gate::X(t) => out.gate(QuantumGate::X(t))?,
            Gate::Cx(a, t) => out.gate(QuantumGate::Cx(a, t))?,
            Gate::Ccx(a, b, t) => out.gate(QuantumGate::Ccx(a, b, t))?,
            Gate::Z(on) => out.gate(QuantumGate::Phase {
                turns: Turns::HALF,
                on: &[on],
            })?,
            Gate::Load {
                parameter,
                bit,
                target,
            } => {
                let word = words.get(parameter as usize);
                let word = word.ok_or(ExportError::MissingWord { parameter, bit })?;
                if word >> bit & 1 == 1 {
                    out.gate(QuantumGate::X(target))?;
                }
            }
        }
    }
    Ok(out.end()?)
}

/// Returns the registers of a program's circuit, each with a name of its own.
fn registers(program: &Program, circuit: &GateCircuit) -> Vec<ExportRegister> {
    let held = circuit.inputs.iter().chain(&circuit.outputs);
    let mut seen = Vec::new();
    let mut registers: Vec<ExportRegister> = Vec::new();
    let mut taken = vec![false; circuit.qubits as usize];
    for (id, qubits) in held {
        if seen.contains(id) || qubits.is_empty() {
            continue;
        }
        seen.push(*id);
        for qubit in qubits {
            taken[*qubit as usize] = true;
        }
        let legal = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
        let name: String = program.registers[id.index()]
            .name
            .chars()
            .map(legal)
            .collect();
        // Some names of one letter are gates, as some longer ones are; all names begin with a
        // letter.
        let plain = name.len() > 1 && name.starts_with(|c: char| c.is_ascii_lowercase());
        let plain = plain && !format::is_reserved(&name);
        let name = if plain { name } else { format!("r_{name}") };
        let alike = |name: &str| registers.iter().any(|other| other.name == name) || name == "work";
        let numbered = (2..).map(|number| format!("{name}_{number}"));
        let mut names = std::iter::once(name.clone()).chain(numbered);
        let name = names.find(|name| !alike(name)).unwrap_or_default();
        registers.push(ExportRegister {
            name: name.into(),
            qubits: qubits.clone(),
        });
    }
    let work: Vec<Qubit> = (0..circuit.qubits)
        .filter(|qubit| !taken[*qubit as usize])
        .collect();
    if !work.is_empty() {
        registers.push(ExportRegister {
            name: "work".into(),
            qubits: work,
        });
    }
    registers
}
