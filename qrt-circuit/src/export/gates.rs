//! The writer of gates, one a line.

use super::{ExportError, ExportFormat, ExportRegister};
use crate::quantum::{QuantumGate, Turns};
use crate::{Qubit, grouped};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::io::{self, Write};

/// Counts of an export: its gates, qubits and bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ExportCounts {
    /// Number of gates written, by the name of the gate.
    pub by_name: BTreeMap<&'static str, u64>,
    /// Number of qubits of the circuit, in all registers.
    pub qubits: u32,
    /// Number of bytes of the text.
    pub bytes: u64,
}

impl ExportCounts {
    /// Number of gates written, of all names.
    pub fn gates(&self) -> u64 {
        self.by_name.values().sum()
    }

    /// Describes the counts in words: `2 qubits, 3 gates: 2 z, 1 cz`, the most frequent gate first.
    pub fn text(&self) -> String {
        let mut names: Vec<_> = self.by_name.iter().collect();
        names.sort_by_key(|(name, gates)| (std::cmp::Reverse(**gates), **name));
        let counts: Vec<String> = names
            .into_iter()
            .map(|(name, gates)| format!("{} {name}", grouped(*gates)))
            .collect();
        let plural = |count: u64| if count == 1 { "" } else { "s" };
        let (qubits, gates) = (self.qubits.into(), self.gates());
        let colon = if gates == 0 { "" } else { ": " };
        format!(
            "{} qubit{}, {} gate{}{colon}{}",
            grouped(qubits),
            plural(qubits),
            grouped(gates),
            plural(gates),
            counts.join(", ")
        )
    }
}

/// Writes a circuit in an OpenQASM language, line by line.
pub(super) struct Writer<'a, W> {
    format: ExportFormat,
    registers: &'a [ExportRegister],
    /// The register of each qubit, and its bit there. The names of millions of qubits would take a
    /// gigabyte.
    places: Vec<[u32; 2]>,
    tally: ExportCounts,
    line: String,
    out: &'a mut W,
}

impl<'a, W: Write> Writer<'a, W> {
    pub(super) fn new(
        format: ExportFormat,
        registers: &'a [ExportRegister],
        qubits: u32,
        out: &'a mut W,
    ) -> Self {
        let mut places = vec![[0; 2]; qubits as usize];
        for (number, register) in (0..).zip(registers) {
            for (bit, qubit) in (0..).zip(&register.qubits) {
                places[*qubit as usize] = [number, bit];
            }
        }
        Self {
            format,
            registers,
            places,
            tally: ExportCounts {
                qubits,
                ..ExportCounts::default()
            },
            line: String::new(),
            out,
        }
    }

    fn put(&mut self, text: &str) -> io::Result<()> {
        self.tally.bytes += text.len() as u64;
        self.out.write_all(text.as_bytes())
    }

    fn comment(&mut self, text: &str) -> io::Result<()> {
        let plain = |c: char| c == ' ' || c.is_ascii_graphic();
        let escape = |c: char| {
            if plain(c) {
                c.to_string()
            } else {
                c.escape_default().to_string()
            }
        };
        let text: String = text.chars().map(escape).collect();
        self.put(&format!("// {text}\n"))
    }

    /// Writes the language's first lines, the comments, the registers and, if any bits are measured, the
    /// register of their outcome.
    pub(super) fn header(&mut self, comments: &[String], outcome: usize) -> io::Result<()> {
        self.put(self.format.header())?;
        for comment in comments {
            self.comment(comment)?;
        }
        let registers = self.registers;
        for ExportRegister { name, qubits } in registers {
            self.put(&self.format.qubits(name, qubits.len()))?;
        }
        if outcome > 0 {
            self.put(&self.format.bits("outcome", outcome))?;
        }
        Ok(())
    }

    /// Writes the line of one gate, with its angle in radians if it has one.
    fn line(&mut self, gate: &'static str, angle: Option<f64>, on: &[Qubit]) -> io::Result<()> {
        *self.tally.by_name.entry(gate).or_default() += 1;
        let mut line = std::mem::take(&mut self.line);
        line.clear();
        line.push_str(gate);
        if let Some(angle) = angle {
            // A decimal that reads back as the same number; without a point it would be an integer.
            let point = if angle.fract() == 0.0 { ".0" } else { "" };
            // Writing to a string cannot fail.
            let _ = write!(line, "({angle}{point})");
        }
        for (place, qubit) in on.iter().enumerate() {
            line.push_str(if place == 0 { " " } else { ", " });
            let [register, bit] = self.places[*qubit as usize];
            line.push_str(&self.registers[register as usize].name);
            line.push('[');
            push_number(&mut line, bit);
            line.push(']');
        }
        line.push_str(";\n");
        self.put(&line)?;
        self.line = line;
        Ok(())
    }

    pub(super) fn gate(&mut self, gate: QuantumGate<'_>) -> Result<(), ExportError> {
        match gate {
            QuantumGate::X(t) => self.line("x", None, &[t])?,
            QuantumGate::Cx(a, t) => self.line("cx", None, &[a, t])?,
            QuantumGate::Ccx(a, b, t) => self.line("ccx", None, &[a, b, t])?,
            QuantumGate::H(t) => self.line("h", None, &[t])?,
            QuantumGate::Ry { angle, target } => self.line("ry", Some(angle), &[target])?,
            QuantumGate::Phase { turns, on } => self.phase(turns, on)?,
        }
        Ok(())
    }

    fn phase(&mut self, turns: Turns, on: &[Qubit]) -> Result<(), ExportError> {
        match *on {
            // Z X Z X = -1, on any qubit.
            [] if turns == Turns::HALF && !self.places.is_empty() => {
                for name in ["z", "x", "z", "x"] {
                    self.line(name, None, &[0])?;
                }
            }
            [a] if turns == Turns::HALF => self.line("z", None, &[a])?,
            [a, b] if turns == Turns::HALF => self.line("cz", None, &[a, b])?,
            [a, b, c] if turns == Turns::HALF => {
                self.line("h", None, &[c])?;
                self.line("ccx", None, &[a, b, c])?;
                self.line("h", None, &[c])?;
            }
            _ => {
                let gate = self.format.phase(on.len());
                let gate = gate.ok_or(ExportError::TooManyQubits(on.len()))?;
                self.line(gate, Some(TAU * turns.as_f64()), on)?;
            }
        }
        Ok(())
    }

    /// Measures qubits, the first into bit 0 of the outcome.
    pub(super) fn measure(&mut self, qubits: &[Qubit]) -> io::Result<()> {
        for (bit, qubit) in qubits.iter().enumerate() {
            let [register, place] = self.places[*qubit as usize];
            let name = &self.registers[register as usize].name;
            let line = self
                .format
                .measure(&format!("{name}[{place}]"), &format!("outcome[{bit}]"));
            self.put(&line)?;
        }
        Ok(())
    }

    /// Writes a last line with the counts, and returns them.
    pub(super) fn end(mut self) -> io::Result<ExportCounts> {
        self.comment(&self.tally.text())?;
        self.out.flush()?;
        Ok(self.tally)
    }
}

/// Appends a number's digits. Most of a text is numbers, and the standard formatting takes twice
/// the time.
fn push_number(line: &mut String, mut number: u32) {
    let mut digits = [0; 10];
    let mut first = digits.len();
    loop {
        first -= 1;
        digits[first] = b'0' + (number % 10) as u8;
        number /= 10;
        if number == 0 {
            break;
        }
    }
    line.extend(digits[first..].iter().map(|digit| char::from(*digit)));
}
