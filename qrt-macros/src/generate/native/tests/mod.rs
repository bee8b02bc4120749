//! Tests of the code of random programs: it is evaluated, and compared with their definition.

#![allow(clippy::unwrap_used)]

mod evaluate;
#[allow(dead_code, reason = "compute has no operations in place")]
#[path = "../../../../../qrt-machines/src/fixed/tests/maker.rs"]
mod maker;

use super::*;
use maker::{Dice, Maker, PARAMETERS, contents_of};
use qrt_circuit::Contents;
use qrt_core::oracle::{Channel, Options};
use std::sync::OnceLock;

/// Number of out-of-place operations.
const KINDS: u32 = 14;

const SCENE: &str = "
name: dark
camera: { perspective: { eye: [0, 1, 2], target: [0, 0, 0], vfov: 45 } }
film: { width: 4, height: 4 }
materials: { black: { lambertian: { albedo: [0, 0, 0] } } }
geometry: [{ quad: { vertices: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], material: black } }]
sampling: { path_bits: BITS, depths: [{ bits: [1, 1] }] }
comparator: { bits: 4 }
";

/// Returns the oracle of an id of `id` bits, which is made once.
fn dark(id: u32) -> &'static Oracle {
    static MADE: [OnceLock<Oracle>; 41] = [const { OnceLock::new() }; 41];
    MADE[id as usize].get_or_init(|| {
        let text = SCENE.replace("BITS", &id.to_string());
        let scene = qrt_scene::front::parse(&text, "dark.yaml", &[], "".as_ref());
        let scene = scene.unwrap_or_else(|report| panic!("{report}")).valid;
        Oracle::rgb(&scene, Options::default()).unwrap()
    })
}

/// Returns an oracle that computes `program`, whose first register is the id of `id` bits, and
/// whose outputs are the six registers `read`.
fn oracle(program: &Program, id: u32, read: [RegisterId; 6]) -> Oracle {
    let whole = |register: RegisterId| {
        let width = program.width(register);
        let signed = signed(program.registers[register.index()].ty);
        let word = Word::unsigned(register, 0, width);
        Operand::Word(Word { signed, ..word })
    };
    let channels = (0..3).map(|number| Channel {
        number,
        count: whole(read[number]),
        colour: whole(read[number + 3]),
        scale: 1.0,
    });
    Oracle {
        program: program.clone(),
        channels: channels.collect(),
        id: RegisterId(0),
        ..dark(id).clone()
    }
}

/// Evaluates the code of a program for some ids, and checks six of its registers.
fn check(mut maker: Maker, id: u32) {
    let dice = &mut maker.dice;
    let registers = maker.program.registers.len() as u32;
    let last = |back: u32| RegisterId(registers - 1 - back.min(registers - 1));
    let any: [RegisterId; 3] = std::array::from_fn(|_| last(dice.below(registers)));
    let read = [last(0), last(1), last(2), any[0], any[1], any[2]];
    let oracle = oracle(&maker.program, id, read);
    let text = code(&oracle, &Names::new(&oracle));
    let code = syn::parse_str(&text).unwrap_or_else(|error| panic!("{error}:\n{text}"));
    for path in contents_of(dice, id, 12) {
        let bits = 64 - dice.below(64);
        let words: [u64; PARAMETERS] = std::array::from_fn(|_| dice.word() >> (64 - bits));
        let program = &oracle.program;
        let mut contents = Contents {
            registers: vec![0; program.registers.len()],
            parameters: words.to_vec(),
            widths: program.registers.iter().map(|r| r.width).collect(),
            negative: false,
        };
        contents.registers[0] = path;
        for op in &program.ops {
            contents.compute(op);
        }
        let found = evaluate::outputs(&code, &words, path);
        for (register, found) in read.into_iter().zip(found) {
            let width = program.width(register);
            let signed = signed(program.registers[register.index()].ty);
            let word = Word::unsigned((), 0, width);
            let expected = Word { signed, ..word }.read(contents.registers[register.index()]);
            assert_eq!(
                found, expected,
                "{register:?} on path {path} with {words:?}: {:?}\n{text}",
                program.ops
            );
        }
    }
}

#[test]
fn every_operation_is_right_at_every_width() {
    for kind in 0..KINDS {
        for widest in 1..=62 {
            for seed in 0..3 {
                let id = widest.min(40);
                let seed = seed + 10 * u64::from(widest) + 1000 * u64::from(kind);
                let mut maker = Maker::new(seed, id, widest);
                for _ in 0..3 {
                    maker.op(kind);
                }
                check(maker, id);
            }
        }
    }
}

#[test]
fn programs_are_right() {
    let mut dice = Dice(1);
    for seed in 0..300 {
        let id = dice.between(1, 40);
        let mut maker = Maker::new(seed, id, dice.between(1, 62));
        for _ in 0..40 {
            let kind = dice.below(KINDS);
            maker.op(kind);
        }
        check(maker, id);
    }
}

#[test]
fn quotients_are_right_next_to_integers() {
    let mut dice = Dice(2);
    for bits in 2..=62_u32 {
        let id = bits.min(40);
        for seed in 0..20 {
            let mut maker = Maker::new(seed, id, bits);
            let word = |register: u32, width: u32, shift: u32| Word {
                shift,
                ..Word::unsigned(RegisterId(register), 0, width)
            };
            let b = maker.register(dice.between(1, id), false);
            let width = maker.program.width(b);
            maker.push(Op::Copy {
                a: Word::unsigned(RegisterId(0), 0, width),
                target: b,
            });
            let quotient = maker.register(dice.between(1, bits), false);
            let (fits, scratch) = (maker.truth(), maker.truth());
            let room = 62 - id;
            let up = [dice.below(room + 1), dice.below(62 - width + 1).min(8)];
            maker.push(Op::Divide {
                a: word(0, id, up[0]),
                b: word(b.0, width, up[1]),
                style: qrt_circuit::Style::OutOfPlace,
                quotient,
                fits,
                scratch,
            });
            check(maker, id);
        }
    }
}
