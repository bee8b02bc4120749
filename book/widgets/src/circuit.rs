//! The figure `circuit`: a tiny scene's oracle, gate by gate, on all its basis states at once.
//!
//! The scene's text is compiled like any other. The gates machine runs the oracle's circuit, one
//! operation of the program after another, forwards or backwards; in between, the figure shows the
//! registers of one basis state, and the signs of all of them.

use qrt_circuit::{Gate, GateCircuit, Qubit};
use qrt_lab::playground::Answer;
use qrt_machines::{GatesMachine, InvalidGate, Rows};
use std::fmt::Write;

/// The scene.
const SCENE: &str = include_str!("../scenes/lamp.yaml");

struct Register {
    name: &'static str,
    ty: &'static str,
    role: &'static str,
    /// Depth of its block; -1 for a block without one.
    depth: i32,
    width: u32,
    fraction: u32,
    meaning: Meaning,
}

#[derive(Clone, Copy, PartialEq)]
enum Meaning {
    Unsigned,
    Signed,
    Scratch,
}

struct Step {
    told: &'static str,
    block: &'static str,
    /// Registers that hold something afterwards.
    held: &'static [u8],
    /// True if the operation is, backwards, the one at the same distance from the other end.
    mirrored: bool,
    /// Kind, controls and target of each gate; empty if the operation is mirrored.
    gates: &'static [[u8; 4]],
}

/// Returns an operation's gates, in their order.
fn gates(place: usize) -> Vec<[u8; 4]> {
    if STEPS[place].mirrored {
        let twin = STEPS[STEPS.len() - 1 - place].gates;
        twin.iter().rev().copied().collect()
    } else {
        STEPS[place].gates.to_vec()
    }
}

/// The scene's oracle, compiled and lowered: see `build.rs`.
mod made {
    use super::{Meaning, Register, Step};
    include!(concat!(env!("OUT_DIR"), "/circuit.rs"));
}
use made::{BEFORE, COMPARATOR, COMPUTED, ID, PLACES, QUBITS, REGISTERS, STEPS};

fn id_bits() -> u32 {
    REGISTERS[ID].width
}

fn comparator_bits() -> u32 {
    REGISTERS[COMPARATOR].width
}

/// Returns the registers, and the operations in their order.
pub fn description() -> Answer {
    let registers = |part: fn(&Register) -> &'static str| -> Vec<&'static str> {
        REGISTERS.iter().map(part).collect()
    };
    let steps =
        |part: fn(&Step) -> &'static str| -> Vec<&'static str> { STEPS.iter().map(part).collect() };
    let counted = |counts: fn(&[u8; 4]) -> bool| {
        let steps = 0..STEPS.len();
        steps.map(move |step| gates(step).iter().filter(|gate| counts(gate)).count() as f64)
    };
    Answer::default()
        .number("id_bits", id_bits().into())
        .number("comparator_bits", comparator_bits().into())
        .number("scale", made::SCALE)
        .number("qubits", QUBITS as f64)
        .number("operations", STEPS.len() as f64)
        .number("computed", COMPUTED as f64)
        .number("flipped", (STEPS.len() - COMPUTED) as f64)
        .number("colour", made::COLOUR as f64)
        .number("count", made::COUNT as f64)
        .lines("names", &registers(|register| register.name))
        .lines("types", &registers(|register| register.ty))
        .lines("roles", &registers(|register| register.role))
        .list(
            "fractions",
            REGISTERS.iter().map(|register| register.fraction.into()),
        )
        .list(
            "depths",
            REGISTERS.iter().map(|register| register.depth.into()),
        )
        .lines("steps", &steps(|step| step.told))
        .lines("blocks", &steps(|step| step.block))
        .list("toffolis", counted(|gate| gate[0] == 2))
        .list("gates", counted(|_| true))
        .text("scene", SCENE)
}

/// An oracle whose circuit has run up to some operation.
pub struct Stepper {
    /// The operations' gates, followed by the inverse of each operation.
    machine: GatesMachine,
    rows: Rows,
    /// Number of operations that have run.
    position: usize,
}

impl Stepper {
    /// Prepares the state before the first operation, with all ids and comparators in superposition.
    ///
    /// # Errors
    /// This circuit gives no error.
    pub fn new() -> Result<Self, InvalidGate> {
        let forwards: Vec<GateCircuit> = (0..STEPS.len()).map(circuit).collect();
        let backwards: Vec<GateCircuit> = forwards.iter().map(inverse).collect();
        let all: Vec<&GateCircuit> = forwards.iter().chain(&backwards).collect();
        let machine = GatesMachine::new(&all)?;
        let mut rows = machine.rows();
        let states = 0..1_u64 << (id_bits() + comparator_bits());
        let ids: Vec<u64> = states.clone().map(|s| s & ((1 << id_bits()) - 1)).collect();
        let comparators: Vec<u64> = states.map(|s| s >> id_bits()).collect();
        for (register, values) in [(ID, &ids), (COMPARATOR, &comparators)] {
            rows.set(&qubits(register), values);
        }
        Ok(Self {
            machine,
            rows,
            position: 0,
        })
    }

    /// Runs forwards or backwards until `position` operations have run; returns the registers of one
    /// basis state, and the signs of all.
    pub fn step(&mut self, id: u64, comparator: u64, position: usize) -> Answer {
        let last = STEPS.len();
        let position = position.min(last);
        while self.position < position {
            self.machine.run(self.position, &mut self.rows);
            self.position += 1;
        }
        while self.position > position {
            self.position -= 1;
            self.machine.run(last + self.position, &mut self.rows);
        }
        let held = self.held();
        let states = 1_usize << (id_bits() + comparator_bits());
        let lane = (id | comparator << id_bits()) as usize % states;

        // For each register: 1 if it is computed, its value, its bits.
        let count = REGISTERS.len();
        let mut computed = vec![0.0; count];
        let mut values = vec![0.0; count];
        let mut bits = vec![String::new(); count];
        let mut all = Vec::new();
        for &register in held {
            let place = usize::from(register);
            let qubits = qubits(place);
            computed[place] = 1.0;
            bits[place] = self.bits(&qubits, lane);
            values[place] = value(&bits[place], REGISTERS[place].meaning);
            all.extend(qubits);
        }
        let dirty = self.rows.dirty(&all, states).is_some();
        let signs = self.rows.signs();
        let negative = |lane: usize| signs[lane / 64] >> (lane % 64) & 1 == 1;
        Answer::default()
            .number("position", position as f64)
            .number("held", all.len() as f64)
            .number("unowned_are_zero", f64::from(u8::from(!dirty)))
            .number("negative", f64::from(u8::from(negative(lane))))
            .list("computed", computed)
            .list("values", values)
            .lines("bits", &bits)
            .list(
                "signs",
                (0..states).map(|lane| f64::from(u8::from(negative(lane)))),
            )
    }

    /// Returns the registers that hold a value now.
    fn held(&self) -> &'static [u8] {
        match self.position.checked_sub(1) {
            None => BEFORE,
            Some(last) => STEPS[last].held,
        }
    }

    /// Returns the bits of `qubits` in a lane, the most significant first.
    fn bits(&self, qubits: &[Qubit], lane: usize) -> String {
        let mut values = vec![0; lane + 1];
        let mut bits = String::new();
        // A scratch register may be wider than a word.
        for word in qubits.chunks(64).rev() {
            self.rows.get(word, &mut values);
            let _ = write!(bits, "{:0width$b}", values[lane], width = word.len());
        }
        bits
    }
}

/// Returns the qubits of a register.
fn qubits(register: usize) -> Vec<Qubit> {
    let places = PLACES[register].iter();
    places.copied().map(Qubit::from).collect()
}

/// Returns an operation's gates, for a machine.
fn circuit(step: usize) -> GateCircuit {
    let gate = |&[kind, a, b, target]: &[u8; 4]| {
        let [a, b, target] = [a, b, target].map(Qubit::from);
        match kind {
            0 => Gate::X(target),
            1 => Gate::Cx(a, target),
            2 => Gate::Ccx(a, b, target),
            _ => Gate::Z(target),
        }
    };
    GateCircuit {
        gates: gates(step).iter().map(gate).collect(),
        qubits: QUBITS as u32,
        ..GateCircuit::default()
    }
}

/// Returns the gates in reverse order: each gate is its own inverse.
fn inverse(step: &GateCircuit) -> GateCircuit {
    let mut inverse = step.clone();
    inverse.gates.reverse();
    inverse
}

/// Returns the integer that `bits` encode; for scratch, the number of ones.
fn value(bits: &str, meaning: Meaning) -> f64 {
    let ones = || bits.bytes().filter(|bit| *bit == b'1').count();
    match meaning {
        Meaning::Scratch => ones() as f64,
        Meaning::Unsigned => unsigned(bits) as f64,
        Meaning::Signed => {
            let sign = i64::from(bits.starts_with('1')) << bits.len();
            (unsigned(bits).cast_signed() - sign) as f64
        }
    }
}

fn unsigned(bits: &str) -> u64 {
    u64::from_str_radix(bits, 2).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use qrt_circuit::{Contents, Operand, Type};
    use qrt_core::oracle::{Oracle, OracleOptions};
    use qrt_scene::front;

    fn oracle() -> Oracle {
        let scene = front::parse(SCENE, "lamp.yaml", &[], "".as_ref()).unwrap();
        Oracle::new(&scene.valid, 0, OracleOptions::default()).unwrap()
    }

    fn states() -> impl Iterator<Item = (u64, u64)> {
        let (ids, comparators) = (1 << id_bits(), 1 << comparator_bits());
        (0..ids).flat_map(move |id| (0..comparators).map(move |comparator| (id, comparator)))
    }

    /// Compares with the definition of every operation, on integers: all registers but scratch, after
    /// each operation, forwards and then backwards.
    #[test]
    fn registers_hold_what_operations_define() {
        let oracle = oracle();
        let program = oracle.whole(0);
        let mut stepper = Stepper::new().unwrap();
        let widths: Vec<u32> = program.registers.iter().map(|r| r.width).collect();
        assert_eq!(program.instructions.len(), STEPS.len());
        let last = STEPS.len();
        for (id, comparator) in states() {
            let mut expected = Contents {
                registers: vec![0; widths.len()],
                parameters: oracle.parameter_words(0, [0, 0]),
                widths: widths.clone(),
                negative: false,
            };
            expected.registers[ID] = id;
            expected.registers[COMPARATOR] = comparator;
            let mut after = vec![expected.clone()];
            for step in &program.instructions {
                let op = &program.ops[step.op as usize];
                if step.inverse {
                    expected.uncompute(op);
                } else {
                    expected.compute(op);
                }
                after.push(expected.clone());
            }
            for position in (0..=last).chain((0..last).rev()) {
                let found = stepper.step(id, comparator, position);
                let expected = &after[position];
                let values = found.list_of("values").unwrap();
                for (place, register) in program.registers.iter().enumerate() {
                    if register.ty != Type::Scratch {
                        let width = register.width as usize;
                        let bits = format!("{:0width$b}", expected.registers[place]);
                        let expected = value(&bits, REGISTERS[place].meaning);
                        let name = &register.name;
                        assert_eq!(
                            values[place], expected,
                            "{id} {comparator} {position} {name}"
                        );
                    }
                }
                let negative = found.number_of("negative").unwrap() == 1.0;
                assert_eq!(negative, expected.negative);
                assert_eq!(found.number_of("unowned_are_zero"), Some(1.0));
            }
        }
    }

    /// Checks that good indices are those whose phase is flipped, and that no garbage is left.
    #[test]
    fn the_whole_call_turns_the_signs_of_good_ids_and_no_more() {
        let oracle = oracle();
        let mut stepper = Stepper::new().unwrap();
        let Operand::Word(count) = oracle.channels[0].count else {
            panic!("the count is constant");
        };
        let good: Vec<(u64, u64, bool)> = states()
            .map(|(id, comparator)| {
                let found = stepper.step(id, comparator, COMPUTED);
                let register = found.list_of("values").unwrap()[made::COUNT];
                let number = count.read((register as i64).cast_unsigned());
                (id, comparator, comparator < oracle.good(number))
            })
            .collect();
        let share = good.iter().filter(|(_, _, good)| *good).count();
        assert!(share > 0 && share < good.len());
        for (id, comparator, good) in good {
            let found = stepper.step(id, comparator, STEPS.len());
            assert_eq!(found.number_of("negative"), Some(f64::from(u8::from(good))));
            let held = f64::from(id_bits() + comparator_bits());
            assert_eq!(found.number_of("held"), Some(held));
            assert_eq!(found.number_of("unowned_are_zero"), Some(1.0));
        }
    }

    #[test]
    fn signed_registers_are_read_as_such() {
        assert_eq!(value("1110", Meaning::Signed), -2.0);
        assert_eq!(value("0110", Meaning::Signed), 6.0);
        assert_eq!(value("1110", Meaning::Unsigned), 14.0);
        assert_eq!(value("1110", Meaning::Scratch), 3.0);
        assert_eq!(value("", Meaning::Unsigned), 0.0);
    }

    /// Otherwise the figure would be unreadable, and states would not fit the machine's lanes.
    #[test]
    fn the_scene_is_tiny() {
        assert!(STEPS.len() < 100, "{}", STEPS.len());
        assert!(id_bits() + comparator_bits() <= 8);
    }
}
