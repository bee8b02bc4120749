//! Tests of counts against the best published ones.

use super::super::super::{Bit, Op, Operand, RegisterId, Style, When, Word};
use super::super::{Cost, best_low, cost};
use super::simulate::program;
use std::sync::Arc;

fn word(register: u32, width: u32, signed: bool) -> Word {
    Word {
        register: RegisterId(register),
        offset: 0,
        width,
        signed,
        shift: 0,
    }
}

fn counted(op: &Op, widths: &[u32]) -> [Cost; 2] {
    let program = program(op, widths, false);
    [false, true].map(|inverse| cost(op, inverse, |id| program.width(id)))
}

/// A name, an operation, the widths of its registers other than scratch, and the most Toffolis.
type Bar = (String, Op, Vec<u32>, u64);

fn in_place(bars: &mut Vec<Bar>, n: u32, place: usize) {
    let (a, target) = (Operand::Word(word(0, n, true)), RegisterId(1));
    let when = Bit {
        register: RegisterId(2),
        index: 0,
        inverted: false,
    };
    let ladder = [14, 30, 46, 62][place];
    for (name, a, when, most) in [
        ("add into", a, When::Always, ladder),
        ("add or subtract", a, When::Reversed(when), ladder),
        ("add into if", a, When::If(when), [22, 46, 70, 94][place]),
        (
            "add constant",
            Operand::Constant(0x5555_5555),
            When::Always,
            ladder,
        ),
    ] {
        let subtract = false;
        let op = Op::AddInto {
            a,
            subtract,
            when,
            target,
        };
        bars.push((name.to_owned(), op, vec![n, n, 1], most));
    }
}

fn out_of_place(bars: &mut Vec<Bar>, n: u32) {
    let target = RegisterId(2);
    let [a, b] = [0, 1].map(|register| Operand::Word(word(register, n, false)));
    let subtract = false;
    let op = Op::Add {
        a,
        b,
        subtract,
        target,
    };
    bars.push(("add".to_owned(), op, vec![n, n, n], u64::from(n - 1)));
    let op = Op::Less { a, b, target };
    bars.push(("less".to_owned(), op, vec![n, n, 1], u64::from(2 * n)));
    let b = Operand::Constant((1 << (n - 1)) + 5);
    let op = Op::Less { a, b, target };
    let most = u64::from(2 * n - 3);
    bars.push(("less than constant".to_owned(), op, vec![n, n, 1], most));
}

fn products(bars: &mut Vec<Bar>, n: u32, place: usize, style: Style) {
    let [target, scratch] = [RegisterId(2), RegisterId(3)];
    for (name, signed, drop, width, most) in [
        ("multiply", true, 0, 2 * n, [208, 800, 1776, 3136][place]),
        (
            "multiply unsigned",
            false,
            0,
            2 * n,
            [208, 800, 1776, 3136][place],
        ),
        (
            "multiply fixed",
            true,
            n - 2,
            n,
            [588, 1964, 4108, 7020][place],
        ),
    ] {
        let [a, b] = [0, 1].map(|register| word(register, n, signed));
        let op = Op::Multiply {
            a,
            b,
            drop,
            style,
            target,
            scratch,
        };
        bars.push((format!("{name} {style:?}"), op, vec![n, n, width], most));
    }
    let [target, scratch] = [RegisterId(1), RegisterId(2)];
    for signed in [true, false] {
        let op = Op::Square {
            a: word(0, n, signed),
            drop: 0,
            style,
            target,
            scratch,
        };
        let name = if signed { "square" } else { "square unsigned" };
        let most = [208, 800, 1776, 3136][place];
        bars.push((format!("{name} {style:?}"), op, vec![n, 2 * n], most));
    }
    let factors = [0xd3, 0xb529, 0x9e_3779, 0xb529_7a4d];
    let most_digits = 0x5555_5555 & ((1 << n) - 1);
    for (name, factor) in [
        ("scale", factors[place]),
        ("scale negative", -factors[place]),
        ("scale, most digits", most_digits),
    ] {
        let op = Op::Scale {
            a: word(0, n, false),
            factor,
            drop: 0,
            style,
            target,
            scratch,
        };
        let most = [90, 310, 705, 1260][place];
        bars.push((format!("{name} {style:?}"), op, vec![n, 2 * n + 1], most));
    }
    let op = Op::SquareRoot {
        a: word(0, n, false),
        style,
        target,
        scratch,
    };
    let most = [76, 212, 412, 676][place];
    bars.push((format!("square root {style:?}"), op, vec![n, n / 2], most));
    for (name, bits) in [("divide", 2 * n), ("divide narrow", n)] {
        let op = Op::Divide {
            a: word(0, bits, false),
            b: word(1, n, false),
            style,
            quotient: RegisterId(2),
            fits: RegisterId(3),
            scratch: RegisterId(4),
        };
        let most = [240, 992, 2256, 4032][place];
        bars.push((format!("{name} {style:?}"), op, vec![bits, n, n, 1], most));
    }
}

#[test]
fn lowerings_are_at_or_below_the_best_published_counts() {
    for (place, n) in [8, 16, 24, 32].into_iter().enumerate() {
        let mut bars = Vec::new();
        out_of_place(&mut bars, n);
        in_place(&mut bars, n, place);
        for style in [Style::OutOfPlace, Style::InPlace] {
            products(&mut bars, n, place, style);
        }
        println!("n = {n}: Toffolis, at most; measured, measured inverse; scratch");
        for (name, op, widths, most) in bars {
            let [forth, back] = counted(&op, &widths);
            let scratch = super::super::scratch_width(&op, |id| widths[id.index()]);
            println!(
                "{name:26} {:5} {most:5}; {:5} {:5}; {scratch:5}",
                forth.toffoli, forth.and_measured, back.and_measured
            );
            assert!(forth.toffoli <= most, "{name}");
            assert_eq!(forth.toffoli, back.toffoli);
            assert!(forth.and_measured <= forth.toffoli && back.and_measured <= back.toffoli);
        }
    }
}

#[test]
fn tables_are_read_by_few_toffolis() {
    let mut random = 7_u64;
    let mut column = |bits: u32| -> Arc<[i64]> {
        let mut next = || {
            random = random
                .wrapping_mul(0x5851_f42d_4c95_7f2d)
                .wrapping_add(0x1405_7b7e_f767_814f);
            (random >> 40) as i64 & 0xff
        };
        (0..1 << bits).map(|_| next()).collect()
    };
    for bits in [4, 8, 10] {
        let columns: Arc<[Arc<[i64]>]> = Arc::new([column(bits)]);
        let low = best_low(bits, &columns);
        let toffoli = |low| {
            let address = (0..bits).map(|index| Bit {
                register: RegisterId(0),
                index,
                inverted: false,
            });
            let op = Op::Table {
                style: Style::OutOfPlace,
                address: address.collect(),
                columns: columns.clone(),
                low,
                targets: Box::new([RegisterId(1)]),
                scratch: RegisterId(2),
            };
            counted(&op, &[bits, 8])[0].toffoli
        };
        assert_eq!(toffoli(0), (1 << bits) - u64::from(bits) - 1);
        assert!((0..=bits).all(|other| toffoli(low) <= toffoli(other)));
        println!("{bits} bits: {} with {low} low", toffoli(low));
    }
}
