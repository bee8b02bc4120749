//! Tests of every operation of up to 32 bits, at random, and of programs of several operations.

use super::super::super::{
    Bit, BlockId, Contents, Cores, Gate, GateCircuit, Instruction, Multiples, Op, Operand,
    RegisterId, Style, When, Word,
};
use super::super::{
    KnownFigures, Size, circuit, costs, depth, least_toffoli, most_qubits, scratch_width, size,
    tally,
};
use super::simulate::{Bench, by_templates, program};
use proptest::prelude::*;

fn style() -> impl Strategy<Value = Style> {
    prop_oneof![Just(Style::OutOfPlace), Just(Style::InPlace)]
}

/// A word of a register of 32 bits.
fn word(register: u32) -> impl Strategy<Value = Word> {
    (1_u32..=32, 0_u32..4, any::<bool>(), any::<u32>()).prop_map(
        move |(width, shift, signed, offset)| Word {
            register: RegisterId(register),
            offset: offset % (33 - width),
            width,
            signed,
            shift,
        },
    )
}

fn unsigned(register: u32) -> impl Strategy<Value = Word> {
    word(register).prop_map(|word| Word {
        signed: false,
        ..word
    })
}

fn operand(register: u32) -> impl Strategy<Value = Operand> {
    prop_oneof![
        4 => word(register).prop_map(Operand::Word),
        1 => any::<i32>().prop_map(|value| Operand::Constant(i64::from(value))),
    ]
}

fn bit(register: u32) -> impl Strategy<Value = Bit> {
    (0_u32..32, any::<bool>()).prop_map(move |(index, inverted)| Bit {
        register: RegisterId(register),
        index,
        inverted,
    })
}

/// Returns operations whose operands are of registers 0 and 1, of 32 bits, or both of register 0.
fn op() -> impl Strategy<Value = (Op, Vec<u32>)> {
    let [r2, r3, r4] = [2, 3, 4].map(RegisterId);
    prop_oneof![
        (
            operand(0),
            prop_oneof![operand(0), operand(1)],
            any::<bool>(),
            1_u32..40
        )
            .prop_map(move |(a, b, subtract, width)| {
                let op = Op::Add {
                    a,
                    b,
                    subtract,
                    target: r2,
                };
                (op, vec![32, 32, width])
            }),
        (operand(0), prop_oneof![operand(0), operand(1)])
            .prop_map(move |(a, b)| (Op::Less { a, b, target: r2 }, vec![32, 32, 1])),
        (
            operand(0),
            operand(1),
            prop_oneof![bit(0), bit(1)],
            1_u32..40
        )
            .prop_map(move |(a, b, when, width)| {
                let op = Op::Select {
                    when,
                    a,
                    b,
                    target: r2,
                };
                (op, vec![32, 32, width])
            }),
        (word(0), prop_oneof![bit(0), bit(1)], 1_u32..40).prop_map(move |(a, when, width)| {
            (
                Op::Negate {
                    a,
                    when,
                    target: r2,
                },
                vec![32, 32, width],
            )
        }),
        (
            operand(0),
            any::<bool>(),
            0_usize..3,
            prop_oneof![bit(0), bit(1)],
            1_u32..40
        )
            .prop_map(move |(a, subtract, when, bit, width)| {
                let when = [When::Always, When::If(bit), When::Reversed(bit)][when];
                let op = Op::AddInto {
                    a,
                    subtract,
                    when,
                    target: r2,
                };
                (op, vec![32, 32, width])
            }),
        (
            word(0),
            prop_oneof![word(0), word(1)],
            0_u32..70,
            style(),
            1_u32..50
        )
            .prop_map(move |(a, b, drop, style, width)| {
                let op = Op::Multiply {
                    a,
                    b,
                    drop,
                    style,
                    target: r2,
                    scratch: r3,
                };
                (op, vec![32, 32, width])
            }),
        (word(0), 0_u32..70, style(), 1_u32..50).prop_map(move |(a, drop, style, width)| {
            let op = Op::Square {
                a,
                drop,
                style,
                target: r2,
                scratch: r3,
            };
            (op, vec![32, 32, width])
        }),
        (word(0), any::<i32>(), 0_u32..40, style(), 1_u32..50).prop_map(
            move |(a, factor, drop, style, width)| {
                let factor = if factor == 0 { 1 } else { i64::from(factor) };
                let op = Op::Scale {
                    a,
                    factor,
                    drop,
                    style,
                    target: r2,
                    scratch: r3,
                };
                (op, vec![32, 32, width])
            }
        ),
        (
            word(0),
            [1_i64..1 << 20, 1_i64..1 << 39],
            [0_u32..40, 0_u32..60],
            1_u32..50
        )
            .prop_map(move |(a, factors, drops, width)| {
                let products = [(factors[0], drops[0]), (factors[1], drops[1])];
                let op = Op::Multiples {
                    a,
                    products: Multiples::new(&products).unwrap().into(),
                    targets: [r2, r3].into(),
                    scratch: r4,
                };
                (op, vec![32, 32, width, width])
            }),
        (
            unsigned(0),
            prop_oneof![unsigned(0), unsigned(1)],
            style(),
            1_u32..35
        )
            .prop_map(move |(a, b, style, width)| {
                let op = Op::Divide {
                    a,
                    b,
                    style,
                    quotient: r2,
                    fits: r3,
                    scratch: r4,
                };
                (op, vec![32, 32, width, 1])
            }),
        (unsigned(0), style(), 1_u32..20).prop_map(move |(a, style, width)| {
            let op = Op::SquareRoot {
                a,
                style,
                target: r2,
                scratch: r3,
            };
            (op, vec![32, 32, width])
        }),
    ]
}

/// Contents of a register: at random, and with long runs of zeros or ones.
fn content() -> impl Strategy<Value = u64> {
    let run = (0_u32..=32).prop_map(|bits| (1_u64 << bits) - 1);
    prop_oneof![
        2 => any::<u32>().prop_map(u64::from),
        1 => run.clone(),
        1 => run.prop_map(|ones| ones ^ 0xffff_ffff),
        1 => (0_u32..32).prop_map(|bit| 1 << bit),
    ]
}

fn size_of(circuit: &GateCircuit) -> Size {
    Size {
        qubits: circuit.qubits,
        in_use: circuit.in_use.clone(),
        depth: depth(circuit),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn operations(
        (op, widths) in op(),
        contents in prop::collection::vec((content(), content(), any::<u64>()), 64),
    ) {
        let bench = Bench::new(&op, &widths);
        let inputs = bench.program.inputs.clone();
        let lanes: Vec<Vec<u64>> = contents
            .iter()
            .map(|(first, second, third)| {
                let contents = [first, second, third];
                let content = |id: &RegisterId| {
                    let width = bench.program.width(*id);
                    contents[id.index()] & (u64::MAX >> (64 - width))
                };
                inputs.iter().map(content).collect()
            })
            .collect();
        bench.check(&lanes);
        let program = &bench.program;
        let lowered = circuit(program);
        prop_assert_eq!(most_qubits(program), lowered.qubits);
        prop_assert_eq!(size(program), size_of(&lowered));
        let figures = KnownFigures::default().figures(&op, |id| program.width(id));
        prop_assert_eq!(figures.costs, costs(&op, |id| program.width(id)));
        prop_assert_eq!(figures.scratch, scratch_width(&op, |id| program.width(id)));
    }
}

/// The lower bound, found without gates, on the Toffolis of products with a constant is nearly all
/// of them. Figures found on all cores equal those found one by one.
#[test]
fn products_with_constants_are_nearly_counted_without_their_gates() {
    let width = |register: RegisterId| [12, 31, 0][register.index()];
    let scale = |factor| Op::Scale {
        a: Word::unsigned(RegisterId(0), 0, 12),
        factor,
        drop: 4,
        style: Style::OutOfPlace,
        target: RegisterId(1),
        scratch: RegisterId(2),
    };
    let ops: Vec<Op> = (1_i64..2000).map(|step| scale(step * 521 + 1)).collect();
    let toffoli: u64 = ops.iter().map(|op| costs(op, width)[0].toffoli).sum();
    let least: u64 = ops.iter().map(|op| least_toffoli(op, width)).sum();
    assert!(10 * least > 9 * toffoli, "{least} of {toffoli}");
    let ops: Vec<&Op> = ops.iter().collect();
    let mut known = KnownFigures::default();
    let each: Vec<_> = ops.iter().map(|op| known.figures(op, width)).collect();
    let [all, again] = [KnownFigures::default(), known].map(|mut known| {
        let all = known.all(&ops, width, Cores::All);
        assert_eq!(known.len(), ops.len());
        all
    });
    assert_eq!(each, all);
    assert_eq!(each, again);
}

/// A chain of products, each of which reads the one before: computed, undone and computed again.
#[test]
fn registers_take_qubits_that_others_have_left() {
    let word = |register, width| Word {
        register: RegisterId(register),
        offset: 0,
        width,
        signed: false,
        shift: 0,
    };
    let square = |from: u32| Op::Square {
        a: word(from, 6),
        drop: 3,
        style: Style::OutOfPlace,
        target: RegisterId(2 * from + 1),
        scratch: RegisterId(2 * from + 2),
    };
    let first = program(&square(0), &[6, 6], false);
    let mut all = first.clone();
    let registers = all.registers.clone();
    all.registers.extend_from_slice(&registers[1..]);
    let negate = Op::AddInto {
        a: Operand::Word(word(1, 6)),
        subtract: true,
        when: When::Always,
        target: RegisterId(3),
    };
    all.ops = vec![
        square(0),
        Op::Square {
            a: word(1, 6),
            drop: 3,
            style: Style::OutOfPlace,
            target: RegisterId(3),
            scratch: RegisterId(4),
        },
        negate,
    ];
    let instruction = |(op, inverse)| Instruction {
        op,
        inverse,
        block: BlockId::ROOT,
    };
    let order = [
        (0, false),
        (1, false),
        (1, true),
        (1, false),
        (0, true),
        (0, false),
        (2, false),
        (0, true),
        (0, false),
        (2, true),
    ];
    all.instructions = order.map(instruction).to_vec();
    let lowered = circuit(&all);
    assert_eq!(lowered, circuit(&all), "deterministic");
    assert_eq!(size(&all), size_of(&lowered));
    // The two squares are alike, and the sum differs; each is computed and undone. Without room, a
    // template is still there if it is requested again at once.
    for (room, times) in [(1 << 20, 4), (0, 9)] {
        let (gates, lowered_times) = by_templates(&all, room);
        assert_eq!(lowered_times, times);
        assert!(gates == lowered.gates, "{room}");
    }
    let both = tally(&all);
    for (cost, range) in both.iter().zip(&lowered.ranges) {
        let gates = &lowered.gates[range.clone()];
        let toffoli = gates.iter().filter(|gate| matches!(gate, Gate::Ccx(..)));
        assert_eq!(toffoli.count() as u64, cost.toffoli);
    }
    let total: u64 = both.iter().map(|cost| cost.toffoli).sum();
    assert!(depth(&lowered) <= total && depth(&lowered) > 0);
    assert_eq!(lowered.in_use.iter().max(), Some(&lowered.qubits));
    assert_eq!(most_qubits(&all), lowered.qubits);
    let fresh: u32 = all.registers.iter().map(|register| register.width).sum();
    assert!(lowered.qubits <= fresh + 6, "no qubit is left to nobody");
    for number in 0..64_u64 {
        let mut qubits = vec![false; lowered.qubits as usize];
        for (place, qubit) in lowered.inputs[0].1.iter().enumerate() {
            qubits[*qubit as usize] = number >> place & 1 == 1;
        }
        for gate in &lowered.gates {
            match *gate {
                Gate::X(t) => qubits[t as usize] ^= true,
                Gate::Cx(a, t) => qubits[t as usize] ^= qubits[a as usize],
                Gate::Ccx(a, b, t) => qubits[t as usize] ^= qubits[a as usize] & qubits[b as usize],
                Gate::Load { .. } | Gate::Z(_) => {}
            }
        }
        let mut contents = Contents {
            registers: vec![number, 0, 0, 0, 0],
            parameters: Vec::new(),
            widths: all
                .registers
                .iter()
                .map(|register| register.width)
                .collect(),
            negative: false,
        };
        for (op, inverse) in order {
            if inverse {
                contents.uncompute(&all.ops[op as usize]);
            } else {
                contents.compute(&all.ops[op as usize]);
            }
        }
        for (id, place) in &lowered.outputs {
            if id.index() % 2 == 0 && id.index() > 0 {
                continue;
            }
            let bits = place.iter().enumerate();
            let found = bits.fold(0, |sum, (bit, qubit)| {
                sum | u64::from(qubits[*qubit as usize]) << bit
            });
            assert_eq!(found, contents.registers[id.index()], "{id:?} of {number}");
        }
    }
}
