//! A reader of exported circuits that accepts the promised lines and no others.

use qrt::circuit::Qubit;
use qrt::circuit::quantum::{QuantumGate, Turns};
use qrt::machines::statevector::StateVector;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::ops::Range;

/// A gate: its name, its angle, its qubits.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Line {
    pub(crate) name: String,
    pub(crate) angle: Option<f64>,
    pub(crate) on: Vec<Qubit>,
}

/// A circuit read from a text.
#[derive(Clone, Debug, Default)]
pub(crate) struct Circuit {
    pub(crate) comments: Vec<String>,
    /// Qubits of each register by its name, in the order of declaration.
    pub(crate) registers: Vec<(String, Range<Qubit>)>,
    pub(crate) qubits: u32,
    pub(crate) gates: Vec<Line>,
    /// Qubits, by the classical bit into which each is measured.
    pub(crate) outcome: Vec<Qubit>,
}

fn whole(text: &str) -> u32 {
    assert!(!text.is_empty() && text.bytes().all(|b| b.is_ascii_digit()));
    text.parse().unwrap()
}

/// Parses `name[3]`.
fn indexed(text: &str) -> (&str, u32) {
    let (name, rest) = text.split_once('[').unwrap();
    (name, whole(rest.strip_suffix(']').unwrap()))
}

impl Circuit {
    pub(crate) fn read(text: &str) -> Self {
        assert!(text.is_ascii() && text.ends_with('\n') && !text.contains('\r'));
        let mut lines = text.lines();
        let mut header = || lines.next().unwrap();
        let three = match (header(), header()) {
            ("OPENQASM 3.0;", "include \"stdgates.inc\";") => true,
            ("OPENQASM 2.0;", "include \"qelib1.inc\";") => false,
            other => panic!("{other:?}"),
        };
        let mut read = Self::default();
        let mut bits = None;
        let mut measured = BTreeMap::new();
        for line in lines {
            if let Some(comment) = line.strip_prefix("// ") {
                read.comments.push(comment.to_owned());
                continue;
            }
            let line = line.strip_suffix(';').unwrap_or_else(|| panic!("{line}"));
            let (first, rest) = line.split_once(' ').unwrap();
            let declared = if three {
                first
                    .contains('[')
                    .then(|| (indexed(first).0, rest, indexed(first).1))
                    .filter(|(kind, ..)| ["qubit", "bit"].contains(kind))
            } else {
                let kind = ["qreg", "creg"].contains(&first);
                kind.then(|| (first, indexed(rest).0, indexed(rest).1))
            };
            match declared {
                Some(("qubit" | "qreg", name, size)) => {
                    assert!(read.gates.is_empty() && size > 0);
                    // The names must be neither gates of the libraries nor words of the languages.
                    let known = [
                        "path",
                        "comparator",
                        "index",
                        "work",
                        "phase_register",
                        "bond",
                        "sign",
                    ];
                    assert!(known.contains(&name), "{name}");
                    let end = read.qubits + size;
                    read.registers.push((name.to_owned(), read.qubits..end));
                    read.qubits = end;
                    continue;
                }
                Some((_, name, size)) => {
                    assert!(name == "outcome" && bits.is_none());
                    bits = Some(size);
                    continue;
                }
                None => {}
            }
            let measure = if three {
                let split = line.split_once(" = measure ");
                split.map(|(bit, qubit)| (qubit, bit))
            } else {
                let rest = line.strip_prefix("measure ");
                rest.and_then(|rest| rest.split_once(" -> "))
            };
            if let Some((qubit, bit)) = measure {
                let (name, bit) = indexed(bit);
                assert!(name == "outcome" && bit < bits.unwrap());
                assert_eq!(measured.insert(bit, read.qubit(qubit)), None);
                continue;
            }
            assert!(measured.is_empty(), "a gate after a measurement: {line}");
            let gate = read.gate(first, rest, three);
            read.gates.push(gate);
        }
        assert_eq!(bits.unwrap_or(0) as usize, measured.len());
        read.outcome = measured.into_values().collect();
        read
    }

    /// Returns the qubits of a register; empty if the circuit does not have it.
    pub(crate) fn register(&self, name: &str) -> Vec<Qubit> {
        let mut registers = self.registers.iter();
        let found = registers.find(|(known, _)| known == name);
        found.map_or(Vec::new(), |(_, qubits)| qubits.clone().collect())
    }

    fn qubit(&self, text: &str) -> Qubit {
        let (name, place) = indexed(text);
        let register = self.registers.iter().find(|(known, _)| known == name);
        let qubits = &register.unwrap_or_else(|| panic!("no register {name}")).1;
        assert!(place < qubits.end - qubits.start, "{text}");
        qubits.start + place
    }

    fn gate(&self, first: &str, rest: &str, three: bool) -> Line {
        let (name, angle) = match first.split_once('(') {
            Some((name, angle)) => (name, Some(angle.strip_suffix(')').unwrap())),
            None => (first, None),
        };
        let on: Vec<Qubit> = rest.split(", ").map(|qubit| self.qubit(qubit)).collect();
        let (qubits, angled) = match name {
            "x" | "h" | "z" => (1, false),
            "cx" | "cz" => (2, false),
            "ccx" => (3, false),
            "ry" => (1, true),
            "p" if three => (1, true),
            "cp" if three => (2, true),
            "u1" if !three => (1, true),
            "cu1" if !three => (2, true),
            _ => panic!("no such gate: {first}"),
        };
        assert_eq!((on.len(), angle.is_some()), (qubits, angled), "{first}");
        for (place, qubit) in on.iter().enumerate() {
            assert!(!on[..place].contains(qubit), "{first} {rest}");
        }
        Line {
            name: name.to_owned(),
            angle: angle.map(|angle| angle.parse().unwrap()),
            on,
        }
    }

    /// Returns the number of gates by name.
    pub(crate) fn tally(&self) -> BTreeMap<&str, u64> {
        let mut tally = BTreeMap::new();
        for gate in &self.gates {
            *tally.entry(&*gate.name).or_default() += 1;
        }
        tally
    }

    /// Runs all gates.
    pub(crate) fn run(&self, machine: &mut impl StateVector) {
        for Line { name, angle, on } in &self.gates {
            let gate = match (&**name, *angle, &on[..]) {
                ("x", None, [t]) => QuantumGate::X(*t),
                ("h", None, [t]) => QuantumGate::H(*t),
                ("cx", None, [a, t]) => QuantumGate::Cx(*a, *t),
                ("ccx", None, [a, b, t]) => QuantumGate::Ccx(*a, *b, *t),
                ("ry", Some(angle), [t]) => QuantumGate::Ry { angle, target: *t },
                ("z" | "cz", None, on) => QuantumGate::Phase {
                    turns: Turns::HALF,
                    on,
                },
                ("p" | "u1" | "cp" | "cu1", Some(angle), on) => QuantumGate::Phase {
                    turns: turns(angle),
                    on,
                },
                other => panic!("{other:?}"),
            };
            machine.gate(gate).unwrap();
        }
    }
}

/// Converts an angle that is a multiple of 1/2^40 turns.
fn turns(angle: f64) -> Turns {
    let steps = angle / TAU * 2_f64.powi(40);
    assert!((steps - steps.round()).abs() < 1e-3, "{angle}");
    Turns::new(steps.round() as i64, 40)
}
