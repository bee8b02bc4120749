mod check;
pub(crate) mod maker;

use super::*;
use maker::{Dice, KINDS, Maker, PARAMETERS, contents_of};
use proptest::prelude::*;
use qrt_circuit::{Bit, Op, Operand, RegisterId, Style};

#[test]
fn every_operation_is_right_on_all_small_contents() {
    for kind in 0..KINDS {
        for seed in 0..60 {
            // 5 bits of the path index and 4 of the other register: all of them, in one block.
            let mut maker = Maker::new(seed + u64::from(kind) * 1000, 5, 4);
            maker.op(kind);
            let all: Vec<u64> = (0..512).collect();
            let [low, high] = [|s: u64| s & 31, |s: u64| s >> 5];
            let low: Vec<u64> = all.iter().copied().map(low).collect();
            let high: Vec<u64> = all.iter().copied().map(high).collect();
            maker.check(&low, &high);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn every_operation_is_right_at_every_width(
        seed: u64, kind in 0..KINDS, widest in 1..=62_u32, lanes in 1..40_usize,
    ) {
        let mut maker = Maker::new(seed, widest, widest);
        for _ in 0..4 {
            maker.op(kind);
        }
        let ids = contents_of(&mut maker.dice, widest, lanes);
        let others = contents_of(&mut maker.dice, widest, lanes);
        maker.check(&ids, &others);
    }

    #[test]
    fn programs_are_right(seed: u64, widest in 1..=62_u32, id in 1..=20_u32, block in 0..8_u64) {
        let mut maker = Maker::new(seed, id, widest);
        for _ in 0..60 {
            let kind = maker.dice.below(KINDS);
            maker.op(kind);
        }
        let ids = 0..(1_u64 << id).min(LANES as u64);
        let first = (block * LANES as u64) & ((1 << id) - 1);
        let ids: Vec<u64> = ids.map(|lane| first + lane).collect();
        let others = contents_of(&mut maker.dice, widest, ids.len());
        maker.check(&ids, &others);
    }
}

#[test]
fn divisions_and_roots_are_exact_at_their_edges() {
    // Quotients next to an integer, and numbers next to a square, for every way of computing them.
    for bits in [4, 12, 15, 16, 23, 24, 25, 31, 32, 40, 51, 52, 53, 61, 62] {
        let mut maker = Maker::new(bits, bits as u32, bits as u32);
        let mut dice = Dice(bits);
        let word = |register: u32| Word {
            register: RegisterId(register),
            offset: 0,
            width: bits as u32,
            signed: false,
            shift: 0,
        };
        let quotient = maker.register(bits as u32, false);
        let fits = maker.truth();
        let root = maker.register((bits as u32).div_ceil(2), false);
        let scratch = maker.truth();
        let style = Style::OutOfPlace;
        let (a, b) = (word(0), word(1));
        maker.push(Op::Divide {
            a,
            b,
            style,
            quotient,
            fits,
            scratch,
        });
        // The same with zeros below the dividend, into a narrower quotient.
        let narrow = maker.register((bits as u32).div_ceil(2), false);
        let fits = maker.truth();
        let shift = (62 - bits as u32).min(16);
        maker.push(Op::Divide {
            a: Word { shift, ..a },
            b,
            style,
            quotient: narrow,
            fits,
            scratch,
        });
        maker.push(Op::SquareRoot {
            a,
            style,
            target: root,
            scratch,
        });
        let all = u64::MAX >> (64 - bits);
        let pairs = (0..LANES as u64).map(|lane| {
            let b = dice.word() >> dice.between(64 - bits as u32, 63);
            let b = b.clamp(1, all);
            let multiple = (dice.word() & all) / b * b;
            let k = (dice.word() & all).isqrt();
            let a = if lane % 2 == 0 { multiple } else { k * k };
            (a.saturating_sub(u64::from(lane / 2 % 2 == 0)), b)
        });
        let (ids, others): (Vec<u64>, Vec<u64>) = pairs.unzip();
        maker.check(&ids, &others);
    }
}

#[test]
fn bits_of_sums_are_right_without_the_sums() {
    for seed in 0..200 {
        let widest = 1 + (seed % 62) as u32;
        let mut maker = Maker::new(seed, widest, widest);
        maker.op(4);
        let sum = RegisterId(maker.program.registers.len() as u32 - 1);
        let bit = Bit {
            register: sum,
            index: maker.dice.below(maker.program.width(sum)),
            inverted: false,
        };
        let target = maker.truth();
        maker.push(Op::And {
            a: bit,
            b: bit,
            target,
        });
        let ids = contents_of(&mut maker.dice, widest, 50);
        let others = contents_of(&mut maker.dice, widest, 50);
        maker.check_only(&ids, &others, &[target]);
    }
}

#[test]
fn extremes_are_what_registers_held() {
    let mut maker = Maker::new(1, 4, 4);
    let (a, target) = (
        Word {
            register: RegisterId(0),
            offset: 0,
            width: 4,
            signed: true,
            shift: 0,
        },
        maker.register(6, true),
    );
    let a = Operand::Word(a);
    maker.push(Op::Add {
        a,
        b: a,
        subtract: false,
        target,
    });
    let program = maker.program;
    let mut extremes = Extremes::new(&program);
    for id in 0..16 {
        let held = extremes.record(&program, &[id, 0], &[0; PARAMETERS]);
        assert_eq!(
            held,
            contents_by_definition(&program, &[id, 0], &[0; PARAMETERS])
        );
    }
    assert_eq!(extremes.registers[0], [0, 15]);
    assert_eq!(extremes.registers[target.index()], [-16, 14]);
}
