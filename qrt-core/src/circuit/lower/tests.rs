//! Every operation's gates against its definition on integers.

use super::*;
use crate::circuit::{Block, BlockId, Contents, Instruction, Register, Role, Style, Type};
use proptest::prelude::*;
use std::sync::Arc;

/// One operation among registers of its own.
struct Bench {
    program: Program,
}

const fn id(number: u32) -> RegisterId {
    RegisterId(number)
}

fn all(register: u32, width: u32, signed: bool) -> Word {
    Word {
        register: id(register),
        offset: 0,
        width,
        signed,
        shift: 0,
    }
}

fn flag(register: u32) -> Bit {
    Bit {
        register: id(register),
        index: 0,
        inverted: false,
    }
}

impl Bench {
    /// Registers are numbered as in `widths`; the first `inputs` of them hold something.
    fn new(widths: &[u32], inputs: u32, op: Op) -> Self {
        let registers = widths.iter().map(|&width| Register {
            name: "register".to_owned(),
            ty: Type::UInt,
            role: Role::Work,
            width,
            block: BlockId::ROOT,
        });
        let mut program = Program {
            registers: registers.collect(),
            blocks: vec![Block {
                parent: None,
                name: "op".to_owned(),
                depth: None,
                scope: false,
            }],
            inputs: (0..inputs).map(RegisterId).collect(),
            ..Program::default()
        };
        if let Some(scratch) = op.scratch() {
            let width = scratch_width(&op, |register| program.width(register));
            program.registers[scratch.index()].width = width;
        }
        program.ops.push(op);
        program.instructions = [false, true]
            .map(|inverse| Instruction {
                op: 0,
                inverse,
                block: BlockId::ROOT,
            })
            .to_vec();
        Self { program }
    }

    fn op(&self) -> &Op {
        &self.program.ops[0]
    }

    fn widths(&self) -> Vec<u32> {
        self.program.registers.iter().map(|r| r.width).collect()
    }

    /// Runs the operation and its inverse on all `states`: contents of the inputs.
    fn check(&self, states: &[Vec<u64>]) {
        let parts = parts(&self.program, &[1]);
        let scratch = self.op().scratch();
        for states in states.chunks(64) {
            let mut rows = vec![0_u64; parts[0].qubits as usize];
            let mut load = |register: RegisterId, qubits: &[Qubit]| {
                for (place, &qubit) in qubits.iter().enumerate() {
                    for (lane, state) in states.iter().enumerate() {
                        let bit = state[register.index()] >> place & 1;
                        rows[qubit as usize] |= bit << lane;
                    }
                }
            };
            for (register, qubits) in &parts[0].inputs {
                load(*register, qubits);
            }
            let before = rows.clone();
            let mut sign = 0;
            run(self.op(), &parts[0], &mut rows, &mut sign);
            for (lane, state) in states.iter().enumerate() {
                let mut contents = Contents {
                    registers: state.clone(),
                    parameters: Vec::new(),
                    widths: self.widths(),
                    negative: false,
                };
                contents.registers.resize(self.program.registers.len(), 0);
                contents.compute(self.op());
                assert_eq!(contents.negative, sign >> lane & 1 == 1);
                for (register, qubits) in &parts[0].outputs {
                    if Some(*register) == scratch {
                        continue;
                    }
                    let found = read(&rows, qubits, lane);
                    assert_eq!(
                        found,
                        contents.registers[register.index()],
                        "{:?} register {register:?} on {state:?}",
                        self.op(),
                    );
                }
            }
            // What is nobody's is zero.
            let held: Vec<Qubit> = parts[0].outputs.iter().flat_map(|o| o.1.clone()).collect();
            for (qubit, row) in rows.iter().enumerate() {
                assert!(
                    held.contains(&(qubit as Qubit)) || *row == 0,
                    "{:?}",
                    self.op()
                );
            }
            run(self.op(), &parts[1], &mut rows, &mut sign);
            assert_eq!(rows, before, "{:?}", self.op());
            assert_eq!(sign, 0);
        }
        self.count(&parts);
    }

    fn count(&self, parts: &[Circuit]) {
        for (part, inverse) in parts.iter().zip([false, true]) {
            let cost = cost(self.op(), inverse, |register| self.program.width(register));
            let ccx = |gate: &&Gate| matches!(gate, Gate::Ccx(..));
            assert_eq!(cost.toffoli, part.gates.iter().filter(ccx).count() as u64);
            assert!(cost.and_measured <= cost.toffoli);
        }
    }

    fn toffoli(&self) -> u64 {
        cost(self.op(), false, |register| self.program.width(register)).toffoli
    }

    fn measured(&self) -> u64 {
        cost(self.op(), false, |register| self.program.width(register)).and_measured
    }

    /// All contents of the inputs.
    fn exhaust(&self) {
        let widths = self.widths();
        let inputs = self.program.inputs.len();
        let bits: u32 = widths[..inputs].iter().sum();
        assert!(bits <= 18);
        let states: Vec<Vec<u64>> = (0..1_u64 << bits)
            .map(|mut code| {
                let mut state = Vec::new();
                for &width in &widths[..inputs] {
                    state.push(code & ((1 << width) - 1));
                    code >>= width;
                }
                state
            })
            .collect();
        self.check(&states);
    }

    /// Contents drawn from `seeds`, and corners.
    fn sample(&self, seeds: &[u64]) {
        let widths = self.widths();
        let inputs = self.program.inputs.len();
        let states: Vec<Vec<u64>> = seeds
            .iter()
            .enumerate()
            .map(|(n, &seed)| {
                (0..inputs)
                    .map(|k| {
                        let mask = (1_u64 << widths[k]) - 1;
                        let mixed = (seed ^ k as u64)
                            .wrapping_mul(0x9e37_79b9_7f4a_7c15)
                            .rotate_left(29)
                            .wrapping_mul(0xd134_2543_de82_ef95);
                        match (n + k) % 5 {
                            0 => mask,
                            1 => mask >> (mixed % u64::from(widths[k])),
                            _ => mixed >> 17 & mask,
                        }
                    })
                    .collect()
            })
            .collect();
        self.check(&states);
    }
}

fn read(rows: &[u64], qubits: &[Qubit], lane: usize) -> u64 {
    let bits = qubits.iter().enumerate();
    bits.fold(0, |sum, (place, &q)| {
        sum | (rows[q as usize] >> lane & 1) << place
    })
}

fn run(op: &Op, circuit: &Circuit, rows: &mut [u64], sign: &mut u64) {
    for gate in &circuit.gates {
        match *gate {
            Gate::X(t) => rows[t as usize] ^= u64::MAX,
            Gate::Cx(c, t) => {
                assert_ne!(c, t, "{op:?}");
                rows[t as usize] ^= rows[c as usize];
            }
            Gate::Ccx(a, b, t) => {
                assert!(a != b && a != t && b != t, "{op:?}");
                rows[t as usize] ^= rows[a as usize] & rows[b as usize];
            }
            Gate::Load { .. } => {}
            Gate::Z(q) => *sign ^= rows[q as usize],
        }
    }
}

/// Both ways to read a register of `width` bits.
fn readings(register: u32, width: u32) -> Vec<Word> {
    [false, true]
        .map(|signed| all(register, width, signed))
        .to_vec()
}

const STYLES: [Style; 2] = [Style::Wide, Style::Lean];

#[test]
fn sums_and_comparisons_are_exact() {
    for width in 1..=4 {
        for other in 1..=4 {
            for a in readings(0, width) {
                for b in readings(1, other) {
                    for shift in [0, 1, 3] {
                        let b = Word { shift, ..b };
                        for target in [1, 3, 6, 9] {
                            for subtract in [false, true] {
                                for (a, b) in [(a, b), (b, a)] {
                                    let (a, b) = (Operand::Word(a), Operand::Word(b));
                                    let op = Op::Add {
                                        a,
                                        b,
                                        subtract,
                                        target: id(2),
                                    };
                                    Bench::new(&[width, other, target], 2, op).exhaust();
                                }
                            }
                        }
                        for (a, b) in [(a, b), (b, a)] {
                            let (a, b) = (Operand::Word(a), Operand::Word(b));
                            let op = Op::Less {
                                a,
                                b,
                                target: id(2),
                            };
                            Bench::new(&[width, other, 1], 2, op).exhaust();
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn constants_and_shared_registers_are_exact() {
    for a in readings(0, 5) {
        for constant in -20..20 {
            for (x, y) in [
                (Operand::Word(a), Operand::Constant(constant)),
                (Operand::Constant(constant), Operand::Word(a)),
            ] {
                for subtract in [false, true] {
                    let op = Op::Add {
                        a: x,
                        b: y,
                        subtract,
                        target: id(1),
                    };
                    Bench::new(&[5, 7], 1, op).exhaust();
                }
                let op = Op::Less {
                    a: x,
                    b: y,
                    target: id(1),
                };
                Bench::new(&[5, 1], 1, op).exhaust();
            }
        }
        for (offset, shift) in [(0, 0), (0, 1), (0, 2), (1, 0), (2, 3)] {
            let b = Word {
                offset,
                width: 5 - offset,
                shift,
                ..a
            };
            for subtract in [false, true] {
                let op = Op::Add {
                    a: Operand::Word(a),
                    b: Operand::Word(b),
                    subtract,
                    target: id(1),
                };
                Bench::new(&[5, 8], 1, op).exhaust();
                let op = Op::AddInto {
                    a: Operand::Word(b),
                    subtract,
                    when: When::If(flag(1)),
                    target: id(2),
                };
                Bench::new(&[5, 1, 6], 3, op).exhaust();
            }
        }
    }
}

#[test]
fn selections_and_negations_are_exact() {
    for inverted in [false, true] {
        let when = Bit {
            inverted,
            ..flag(2)
        };
        for a in readings(0, 3) {
            for b in readings(1, 4) {
                let b = Word { shift: 1, ..b };
                for (a, b) in [
                    (Operand::Word(a), Operand::Word(b)),
                    (Operand::Word(a), Operand::Constant(-5)),
                    (Operand::Constant(9), Operand::Word(b)),
                    (Operand::Constant(9), Operand::Constant(-5)),
                    (Operand::Word(b), Operand::Word(b)),
                ] {
                    let op = Op::Select {
                        when,
                        a,
                        b,
                        target: id(3),
                    };
                    Bench::new(&[3, 4, 1, 6], 3, op).exhaust();
                }
            }
            let op = Op::Negate {
                a,
                when,
                target: id(3),
            };
            Bench::new(&[3, 1, 1, 5], 3, op).exhaust();
        }
    }
    // By a bit of its own: the magnitude, and a selection by a bit of an operand.
    let sign = Bit {
        index: 4,
        ..flag(0)
    };
    let op = Op::Negate {
        a: all(0, 5, true),
        when: sign,
        target: id(1),
    };
    Bench::new(&[5, 5], 1, op).exhaust();
    for inverted in [false, true] {
        let op = Op::Select {
            when: Bit { inverted, ..sign },
            a: Operand::Word(all(0, 5, true)),
            b: Operand::Word(Word {
                shift: 1,
                ..all(0, 5, true)
            }),
            target: id(1),
        };
        Bench::new(&[5, 6], 1, op).exhaust();
    }
}

#[test]
fn bits_are_exact() {
    for i in [false, true] {
        for j in [false, true] {
            let a = Bit {
                inverted: i,
                ..flag(0)
            };
            let b = Bit {
                inverted: j,
                index: 1,
                ..flag(1)
            };
            let target = id(2);
            Bench::new(&[1, 2, 1], 2, Op::And { a, b, target }).exhaust();
            Bench::new(&[1, 2, 1], 2, Op::Xor { a, b, target }).exhaust();
            Bench::new(&[1, 2], 2, Op::Phase { bit: b }).exhaust();
        }
    }
    let columns: Arc<[u64]> = Arc::new([0b101, 0b010, 0b111, 0b100]);
    let op = Op::Parity {
        source: id(0),
        columns,
        parameter: None,
        target: id(1),
    };
    Bench::new(&[4, 3], 1, op).exhaust();
    let op = Op::Copy {
        a: Word {
            offset: 1,
            width: 3,
            ..all(0, 4, true)
        },
        target: id(1),
    };
    Bench::new(&[4, 6], 1, op).exhaust();
}

#[test]
fn products_are_exact() {
    for style in STYLES {
        for n in 1..=4 {
            for m in 1..=4 {
                for a in readings(0, n) {
                    for b in readings(1, m) {
                        for (shift, drop, width) in [
                            (0, 0, n + m),
                            (0, 2, n + m),
                            (1, 1, n + m),
                            (0, 3, 2),
                            (2, 0, 12),
                        ] {
                            let op = Op::Multiply {
                                a: Word { shift, ..a },
                                b,
                                drop,
                                style,
                                target: id(2),
                                scratch: id(3),
                            };
                            Bench::new(&[n, m, width, 0], 2, op).exhaust();
                        }
                    }
                }
            }
        }
        for n in 1..=6 {
            for a in readings(0, n) {
                for (shift, drop, width) in [(0, 0, 2 * n), (0, 2, 2 * n), (1, 1, 2 * n), (0, 3, 3)]
                {
                    let op = Op::Square {
                        a: Word { shift, ..a },
                        drop,
                        style,
                        target: id(1),
                        scratch: id(2),
                    };
                    Bench::new(&[n, width, 0], 1, op).exhaust();
                }
            }
        }
        for a in readings(0, 5) {
            for factor in (-40..=40).filter(|&factor| factor != 0) {
                for (shift, drop, width) in [(0, 0, 11), (1, 2, 9), (0, 4, 3)] {
                    let op = Op::Scale {
                        a: Word { shift, ..a },
                        factor,
                        drop,
                        style,
                        target: id(1),
                        scratch: id(2),
                    };
                    Bench::new(&[5, width, 0], 1, op).exhaust();
                }
            }
        }
    }
}

#[test]
fn quotients_and_roots_are_exact() {
    for style in STYLES {
        for n in 1..=6 {
            for m in 1..=5 {
                for width in 1..=5 {
                    for shift in [0, 3] {
                        let op = Op::Divide {
                            a: Word {
                                shift,
                                ..all(0, n, false)
                            },
                            b: all(1, m, false),
                            style,
                            quotient: id(2),
                            fits: id(3),
                            scratch: id(4),
                        };
                        Bench::new(&[n, m, width, 1, 0], 2, op).exhaust();
                    }
                }
            }
        }
        for n in 1..=10_u32 {
            for (shift, width) in [(0, n.div_ceil(2)), (3, n), (0, 2)] {
                let op = Op::SquareRoot {
                    a: Word {
                        shift,
                        ..all(0, n, false)
                    },
                    style,
                    target: id(1),
                    scratch: id(2),
                };
                Bench::new(&[n, width, 0], 1, op).exhaust();
            }
        }
    }
}

#[test]
fn tables_are_exact() {
    for bits in 1..=5_u32 {
        for low in 0..bits {
            let entries = |seed: i64| -> Box<[i64]> {
                (0..1_i64 << bits)
                    .map(|i| (i * i * 37 + seed * i + 11) % 61 - 30)
                    .collect()
            };
            let columns: Arc<[Box<[i64]>]> = Arc::new([entries(3), entries(8), entries(0)]);
            let address = (0..bits)
                .map(|index| Bit {
                    register: id(0),
                    index,
                    inverted: index == 1,
                })
                .collect();
            let op = Op::Table {
                address,
                columns,
                low,
                targets: [id(1), id(2), id(3)].into(),
                scratch: id(4),
            };
            let bench = Bench::new(&[bits, 6, 3, 9, 0], 1, op);
            bench.exhaust();
            if low == 0 {
                assert_eq!(bench.toffoli(), (1_u64 << bits) - u64::from(bits) - 1);
            }
        }
    }
}

#[test]
fn what_happens_in_place_is_exact() {
    for width in 1..=5 {
        for a in readings(0, 4) {
            for subtract in [false, true] {
                for inverted in [false, true] {
                    let bit = Bit {
                        inverted,
                        ..flag(1)
                    };
                    for when in [When::Always, When::If(bit), When::Reversed(bit)] {
                        for a in [
                            Operand::Word(a),
                            Operand::Constant(-3),
                            Operand::Constant(6),
                        ] {
                            let op = Op::AddInto {
                                a,
                                subtract,
                                when,
                                target: id(2),
                            };
                            Bench::new(&[4, 1, width], 3, op).exhaust();
                        }
                    }
                    for when in [None, Some(bit)] {
                        let op = Op::XorInto {
                            a: Operand::Word(a),
                            when,
                            target: id(2),
                        };
                        Bench::new(&[4, 1, width], 3, op).exhaust();
                        let op = Op::Swap {
                            a: id(0),
                            b: id(2),
                            when,
                        };
                        Bench::new(&[width, 1, width], 3, op).exhaust();
                    }
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn wide_operands_are_exact(
        n in 1..=32_u32, m in 1..=32_u32, signs in 0..4_u8, drop in 0..20_u32,
        factor in 1..=i64::from(u32::MAX), lean in any::<bool>(),
        seeds in proptest::collection::vec(any::<u64>(), 64),
    ) {
        let style = if lean { Style::Lean } else { Style::Wide };
        let a = all(0, n, signs & 1 == 1);
        let b = all(1, m, signs & 2 == 2);
        let target = id(2);
        let scratch = id(3);
        let (x, y) = (Operand::Word(a), Operand::Word(b));
        let wide = (n + m).min(62);
        let ops = [
            (Op::Multiply { a, b, drop, style, target, scratch }, wide),
            (Op::Square { a, drop, style, target, scratch }, (2 * n).min(62)),
            (Op::Scale { a, factor, drop, style, target, scratch }, 40),
            (Op::Scale { a, factor: -factor, drop, style, target, scratch }, 40),
            (Op::Add { a: x, b: y, subtract: lean, target }, 34),
            (Op::Less { a: x, b: y, target }, 1),
            (Op::Select { when: Bit { index: n - 1, ..flag(0) }, a: x, b: y, target }, 33),
            (Op::Negate { a, when: flag(1), target }, 33),
            (
                Op::SquareRoot {
                    a: Word { shift: drop, ..all(0, n, false) }, style, target, scratch,
                },
                (n + drop).div_ceil(2),
            ),
        ];
        for (op, width) in ops {
            Bench::new(&[n, m, width, 0], 2, op).sample(&seeds);
        }
        let op = Op::Divide {
            a: Word { shift: drop, ..all(0, n, false) },
            b: all(1, m, false),
            style,
            quotient: id(2),
            fits: id(3),
            scratch: id(4),
        };
        Bench::new(&[n, m, 18, 1, 0], 2, op).sample(&seeds);
        for when in [When::Always, When::If(flag(2)), When::Reversed(flag(2))] {
            let op = Op::AddInto { a: x, subtract: lean, when, target: id(1) };
            Bench::new(&[n, m, 1], 3, op).sample(&seeds);
        }
    }
}

/// Toffolis at or below the best that other tools produce (without measurement), for 8, 16, 24 and
/// 32 bits. Sources: Q#'s, Qiskit's and Qrisp's libraries, counted.
#[test]
fn lowerings_are_at_or_below_the_best_published_counts() {
    let table: &[(&str, [u64; 4], &dyn Fn(u32) -> (Vec<u32>, u32, Op))] = &[
        ("add", [14, 30, 46, 62], &|n| {
            let op = Op::AddInto {
                a: Operand::Word(all(0, n, false)),
                subtract: false,
                when: When::Always,
                target: id(1),
            };
            (vec![n, n], 2, op)
        }),
        ("add, out of place", [14, 30, 46, 62], &|n| {
            let op = Op::Add {
                a: Operand::Word(all(0, n, false)),
                b: Operand::Word(all(1, n, false)),
                subtract: false,
                target: id(2),
            };
            (vec![n, n, n], 2, op)
        }),
        ("add constant", [14, 30, 46, 62], &|n| {
            let op = Op::AddInto {
                a: Operand::Constant(0x5a5a_5a5b & ((1 << n) - 1)),
                subtract: false,
                when: When::Always,
                target: id(0),
            };
            (vec![n], 1, op)
        }),
        ("controlled add", [22, 46, 70, 94], &|n| {
            let op = Op::AddInto {
                a: Operand::Word(all(0, n, false)),
                subtract: false,
                when: When::If(flag(2)),
                target: id(1),
            };
            (vec![n, n, 1], 3, op)
        }),
        ("add or subtract", [14, 30, 46, 62], &|n| {
            let op = Op::AddInto {
                a: Operand::Word(all(0, n, false)),
                subtract: false,
                when: When::Reversed(flag(2)),
                target: id(1),
            };
            (vec![n, n, 1], 3, op)
        }),
        ("compare", [16, 32, 48, 64], &|n| {
            let op = Op::Less {
                a: Operand::Word(all(0, n, false)),
                b: Operand::Word(all(1, n, false)),
                target: id(2),
            };
            (vec![n, n, 1], 2, op)
        }),
        ("compare constant", [13, 29, 45, 61], &|n| {
            let op = Op::Less {
                a: Operand::Word(all(0, n, false)),
                b: Operand::Constant(0x5a5a_5a5b & ((1 << n) - 1)),
                target: id(1),
            };
            (vec![n, 1], 1, op)
        }),
        ("product", [208, 800, 1776, 3136], &|n| {
            let op = Op::Multiply {
                a: all(0, n, false),
                b: all(1, n, false),
                drop: 0,
                style: Style::Wide,
                target: id(2),
                scratch: id(3),
            };
            (vec![n, n, 2 * n, 0], 2, op)
        }),
        ("product, lean", [208, 800, 1776, 3136], &|n| {
            let op = Op::Multiply {
                a: all(0, n, false),
                b: all(1, n, false),
                drop: 0,
                style: Style::Lean,
                target: id(2),
                scratch: id(3),
            };
            (vec![n, n, 2 * n, 0], 2, op)
        }),
        ("fixed-point product", [588, 1964, 4108, 7020], &|n| {
            let op = Op::Multiply {
                a: all(0, n, false),
                b: all(1, n, false),
                drop: n,
                style: Style::Wide,
                target: id(2),
                scratch: id(3),
            };
            (vec![n, n, n, 0], 2, op)
        }),
        ("square", [208, 800, 1776, 3136], &|n| {
            let op = Op::Square {
                a: all(0, n, false),
                drop: 0,
                style: Style::Wide,
                target: id(1),
                scratch: id(2),
            };
            (vec![n, 2 * n, 0], 1, op)
        }),
        ("constant product", [90, 310, 705, 1260], &|n| {
            // As many digits as a factor can have.
            let op = Op::Scale {
                a: all(0, n, false),
                factor: 0x5555_5555 & ((1 << n) - 1),
                drop: 0,
                style: Style::Wide,
                target: id(1),
                scratch: id(2),
            };
            (vec![n, 2 * n, 0], 1, op)
        }),
        ("divide", [240, 992, 2256, 4032], &|n| {
            let op = Op::Divide {
                a: all(0, n, false),
                b: all(1, n, false),
                style: Style::Wide,
                quotient: id(2),
                fits: id(3),
                scratch: id(4),
            };
            (vec![n, n, n, 1, 0], 2, op)
        }),
        ("square root", [76, 212, 412, 676], &|n| {
            let op = Op::SquareRoot {
                a: all(0, n, false),
                style: Style::Wide,
                target: id(1),
                scratch: id(2),
            };
            (vec![n, n / 2, 0], 1, op)
        }),
        ("select", [8, 16, 24, 32], &|n| {
            let op = Op::Select {
                when: flag(2),
                a: Operand::Word(all(0, n, false)),
                b: Operand::Word(all(1, n, false)),
                target: id(3),
            };
            (vec![n, n, 1, n], 3, op)
        }),
        ("controlled swap", [8, 16, 24, 32], &|n| {
            let op = Op::Swap {
                a: id(0),
                b: id(1),
                when: Some(flag(2)),
            };
            (vec![n, n, 1], 3, op)
        }),
    ];
    println!(
        "{:22} {:>24} {:>24} {:>24}",
        "", "Toffoli", "ANDs, measured", "best published"
    );
    for (name, best, make) in table {
        let mut found = [[0; 2]; 4];
        for (n, (found, &best)) in [8, 16, 24, 32].into_iter().zip(found.iter_mut().zip(best)) {
            let (widths, inputs, op) = make(n);
            let bench = Bench::new(&widths, inputs, op);
            *found = [bench.toffoli(), bench.measured()];
            assert!(found[0] <= best, "{name} {n}: {} > {best}", found[0]);
        }
        println!(
            "{name:22} {:>24} {:>24} {:>24}",
            format!("{:?}", found.map(|f| f[0])),
            format!("{:?}", found.map(|f| f[1])),
            format!("{best:?}")
        );
    }
}
