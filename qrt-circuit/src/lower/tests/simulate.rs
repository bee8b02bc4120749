//! Simulates an operation's gates on basis states, 64 at a time, and compares them with the
//! integers.

use super::super::super::{
    Block, BlockId, Contents, Gate, GateCircuit, Instruction, Op, Parameter, Program, Qubit,
    Register, RegisterId, Type,
};
use super::super::{Templates, circuit, cost, least_toffoli, scratch_width, try_each_template};
use std::convert::Infallible;

/// Creates a program of one operation and, if `undone`, its inverse. `widths` are those of all
/// registers but the scratch register, which is the last.
pub(super) fn program(op: &Op, widths: &[u32], undone: bool) -> Program {
    let scratch = scratch_width(op, |id| widths[id.index()]);
    let mut widths = widths.to_vec();
    if let Some(id) = op.scratch() {
        assert_eq!(id.index(), widths.len(), "scratch comes last");
        widths.push(scratch);
    }
    let register = |width: &u32| Register::new("", Type::UInt, *width);
    let fresh = op.fresh();
    let ids = (0..widths.len() as u32).map(RegisterId);
    let instruction = |inverse| Instruction {
        op: 0,
        inverse,
        block: BlockId::ROOT,
    };
    let mut instructions = vec![instruction(false)];
    instructions.extend(undone.then(|| instruction(true)));
    Program {
        registers: widths.iter().map(register).collect(),
        blocks: vec![Block::default()],
        parameters: vec![
            Parameter {
                name: String::new(),
                width: 64,
            };
            2
        ],
        ops: vec![op.clone()],
        instructions,
        inputs: ids.filter(|id| !fresh.contains(id)).collect(),
    }
}

pub(super) const PARAMETERS: [u64; 2] = [0x9e37_79b9_7f4a_7c15, 0xd1b5_4a32_d192_ed03];

/// Qubits in 64 states each, and the signs of the amplitudes.
struct States {
    qubits: Vec<u64>,
    negative: u64,
}

impl States {
    fn run(&mut self, gates: &[Gate]) {
        let q = &mut self.qubits;
        for gate in gates {
            match *gate {
                Gate::X(t) => q[t as usize] ^= u64::MAX,
                Gate::Cx(a, t) => {
                    assert_ne!(a, t);
                    q[t as usize] ^= q[a as usize];
                }
                Gate::Ccx(a, b, t) => {
                    assert!(a != b && a != t && b != t, "{gate:?}");
                    q[t as usize] ^= q[a as usize] & q[b as usize];
                }
                Gate::Load {
                    parameter,
                    bit,
                    target,
                } => {
                    let set = PARAMETERS[parameter as usize] >> bit & 1 == 1;
                    q[target as usize] ^= if set { u64::MAX } else { 0 };
                }
                Gate::Z(t) => self.negative ^= q[t as usize],
            }
        }
    }

    fn read(&self, qubits: &[u32], lane: usize) -> u64 {
        let bits = qubits.iter().enumerate();
        bits.fold(0, |sum, (place, qubit)| {
            sum | (self.qubits[*qubit as usize] >> lane & 1) << place
        })
    }
}

/// An operation's circuit, forwards and backwards.
pub(super) struct Bench {
    op: Op,
    pub(super) program: Program,
    forth: GateCircuit,
    back: GateCircuit,
}

/// Returns the gates of a program and the number of operations lowered. Operations that are alike
/// are lowered once, within a memory budget of `room` bytes.
pub(super) fn by_templates(program: &Program, room: usize) -> (Vec<Gate>, u32) {
    let (mut gates, mut lowered) = (Vec::new(), 0);
    let done = try_each_template(
        program,
        &mut Templates::with_room(room),
        |own, _| {
            lowered += 1;
            Ok::<_, Infallible>((own.to_vec(), size_of_val(own)))
        },
        |own, qubits| {
            let at = |qubit: Qubit| qubits[qubit as usize];
            gates.extend(own.iter().map(|gate| match *gate {
                Gate::X(t) => Gate::X(at(t)),
                Gate::Cx(a, t) => Gate::Cx(at(a), at(t)),
                Gate::Ccx(a, b, t) => Gate::Ccx(at(a), at(b), at(t)),
                Gate::Z(q) => Gate::Z(at(q)),
                Gate::Load {
                    parameter,
                    bit,
                    target,
                } => Gate::Load {
                    parameter,
                    bit,
                    target: at(target),
                },
            }));
            Ok(())
        },
    );
    match done {
        Ok(()) => (gates, lowered),
        Err(never) => match never {},
    }
}

impl Bench {
    /// Lowers the operation, and compares its costs with its gates.
    pub(super) fn new(op: &Op, widths: &[u32]) -> Self {
        let program_forth = program(op, widths, false);
        let forth = circuit(&program_forth);
        let program = program(op, widths, true);
        let back = circuit(&program);
        let counts = |gates: &[Gate]| {
            let count = |of: fn(&Gate) -> bool| gates.iter().filter(|gate| of(gate)).count() as u64;
            [
                count(|gate| matches!(gate, Gate::Ccx(..))),
                count(|gate| matches!(gate, Gate::Cx(..))),
                count(|gate| matches!(gate, Gate::X(_) | Gate::Load { .. })),
            ]
        };
        for (range, inverse) in back.ranges.iter().zip([false, true]) {
            let cost = cost(op, inverse, |id| program.width(id));
            let counted = [cost.toffoli, cost.cnot, cost.x];
            assert_eq!(
                counted,
                counts(&back.gates[range.clone()]),
                "{op:?} {widths:?}"
            );
            assert!(cost.and_measured <= cost.toffoli);
            let least = least_toffoli(op, |id| program.width(id));
            assert!(least <= cost.toffoli, "{least}: {op:?} {widths:?}");
        }
        let (gates, _) = by_templates(&program, 1 << 20);
        assert!(gates == back.gates, "{op:?} {widths:?}");
        Self {
            op: op.clone(),
            program: program_forth,
            forth,
            back,
        }
    }

    /// Checks up to 64 inputs, each with the contents of the input registers.
    pub(super) fn check(&self, lanes: &[Vec<u64>]) {
        let mut states = States {
            qubits: vec![0; self.back.qubits as usize],
            negative: 0,
        };
        for (lane, contents) in lanes.iter().enumerate() {
            for ((_, qubits), content) in self.forth.inputs.iter().zip(contents) {
                for (place, qubit) in qubits.iter().enumerate() {
                    states.qubits[*qubit as usize] |= (content >> place & 1) << lane;
                }
            }
        }
        let before = states.qubits.clone();
        let forth = &self.back.gates[self.back.ranges[0].clone()];
        assert_eq!(forth, self.forth.gates);
        states.run(forth);
        let scratch = self.op.scratch();
        let mut owned = vec![false; states.qubits.len()];
        for (id, qubits) in &self.forth.outputs {
            for qubit in qubits {
                assert!(!owned[*qubit as usize]);
                owned[*qubit as usize] = true;
            }
            assert_eq!(qubits.len() as u32, self.program.width(*id));
        }
        for (qubit, owned) in owned.iter().enumerate() {
            let value = states.qubits[qubit];
            assert!(
                *owned || value == 0,
                "{:?}: borrowed {qubit} is left",
                self.op
            );
        }
        let widths: Vec<u32> = self.program.registers.iter().map(|r| r.width).collect();
        for (lane, contents) in lanes.iter().enumerate() {
            let mut expected = Contents {
                registers: vec![0; widths.len()],
                parameters: PARAMETERS.to_vec(),
                widths: widths.clone(),
                negative: false,
            };
            for ((id, _), content) in self.forth.inputs.iter().zip(contents) {
                expected.registers[id.index()] = *content;
            }
            expected.compute(&self.op);
            for (id, qubits) in &self.forth.outputs {
                if Some(*id) != scratch {
                    let found = states.read(qubits, lane);
                    assert_eq!(
                        found,
                        expected.registers[id.index()],
                        "{:?} {widths:?}: register {} of {contents:?}",
                        self.op,
                        id.0
                    );
                }
            }
            assert_eq!(states.negative >> lane & 1 == 1, expected.negative);
        }
        states.run(&self.back.gates[self.back.ranges[1].clone()]);
        assert_eq!(states.qubits, before, "{:?}: not undone", self.op);
        assert_eq!(states.negative, 0);
    }

    /// Checks all contents of the inputs that `valid` accepts.
    pub(super) fn check_all(&self, valid: impl Fn(&[u64]) -> bool) {
        let widths: Vec<u32> = self
            .forth
            .inputs
            .iter()
            .map(|input| input.1.len() as u32)
            .collect();
        let bits: u32 = widths.iter().sum();
        let mut lanes = Vec::with_capacity(64);
        for content in 0..1_u64 << bits {
            let mut rest = content;
            let mut contents = Vec::with_capacity(widths.len());
            for width in &widths {
                contents.push(rest & ((1 << width) - 1));
                rest >>= width;
            }
            if valid(&contents) {
                lanes.push(contents);
            }
            if lanes.len() == 64 {
                self.check(&lanes);
                lanes.clear();
            }
        }
        self.check(&lanes);
    }
}

/// Compares an operation with the integers, for all contents of its inputs.
pub(super) fn check(op: &Op, widths: &[u32]) {
    Bench::new(op, widths).check_all(|_| true);
}
