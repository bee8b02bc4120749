//! Tests of every operation, for all contents of small registers.

use super::super::super::{Bit, Multiples, Op, Operand, RegisterId, Style, When, Word};
use super::simulate::{Bench, check};
use crate::lower::cost;
use std::sync::Arc;

const R: [RegisterId; 6] = [
    RegisterId(0),
    RegisterId(1),
    RegisterId(2),
    RegisterId(3),
    RegisterId(4),
    RegisterId(5),
];
const STYLES: [Style; 2] = [Style::OutOfPlace, Style::InPlace];

fn word(register: usize, width: u32, signed: bool) -> Word {
    Word {
        register: R[register],
        offset: 0,
        width,
        signed,
        shift: 0,
    }
}

fn bit(register: usize, index: u32, inverted: bool) -> Bit {
    Bit {
        register: R[register],
        index,
        inverted,
    }
}

/// Returns words of a register of 4 bits: signed and unsigned, with offsets and shifts.
fn words(register: usize) -> Vec<Word> {
    let mut words = Vec::new();
    for signed in [false, true] {
        for (offset, width, shift) in [
            (0, 4, 0),
            (0, 4, 2),
            (1, 3, 0),
            (1, 2, 1),
            (3, 1, 1),
            (0, 1, 0),
        ] {
            words.push(Word {
                register: R[register],
                offset,
                width,
                signed,
                shift,
            });
        }
    }
    words
}

fn operands(register: usize) -> Vec<Operand> {
    let words = words(register).into_iter().map(Operand::Word);
    let constants = [0, 1, 5, 12, -1, -6].map(Operand::Constant);
    words.chain(constants).collect()
}

#[test]
fn sums() {
    for a in operands(0) {
        // From another register, and from the same.
        for b in operands(1).into_iter().chain(operands(0)) {
            for subtract in [false, true] {
                for width in [1, 3, 5, 9] {
                    let target = R[2];
                    let op = Op::Add {
                        a,
                        b,
                        subtract,
                        target,
                    };
                    check(&op, &[4, 4, width]);
                }
            }
        }
    }
}

#[test]
fn comparisons() {
    for a in operands(0) {
        for b in operands(1).into_iter().chain(operands(0)) {
            let target = R[2];
            check(&Op::Less { a, b, target }, &[4, 4, 1]);
        }
    }
}

#[test]
fn sums_in_place() {
    for a in operands(0) {
        for subtract in [false, true] {
            for width in [1, 2, 4, 6] {
                let mut whens = vec![When::Always];
                for register in [0, 1] {
                    for inverted in [false, true] {
                        let bit = bit(register, 3, inverted);
                        whens.extend([When::If(bit), When::Reversed(bit)]);
                    }
                }
                for when in whens {
                    let target = R[2];
                    let op = Op::AddInto {
                        a,
                        subtract,
                        when,
                        target,
                    };
                    check(&op, &[4, 4, width]);
                }
            }
        }
    }
}

#[test]
fn conditional_operations() {
    for inverted in [false, true] {
        for register in [0, 1] {
            let when = bit(register, 3, inverted);
            for width in [1, 4, 7] {
                for a in words(0) {
                    let target = R[2];
                    check(&Op::Negate { a, when, target }, &[4, 4, width]);
                    check(&Op::Copy { a, target }, &[4, 4, width]);
                }
                for a in operands(0) {
                    for b in operands(1).into_iter().chain(operands(0)) {
                        let target = R[2];
                        check(&Op::Select { when, a, b, target }, &[4, 4, width]);
                    }
                    let target = R[2];
                    let op = Op::XorInto {
                        a,
                        when: Some(when),
                        target,
                    };
                    check(&op, &[4, 4, width.min(5)]);
                    check(
                        &Op::XorInto {
                            a,
                            when: None,
                            target,
                        },
                        &[4, 4, width.min(5)],
                    );
                }
            }
            let [a, b] = [R[2], R[3]];
            let op = Op::Swap {
                a,
                b,
                when: Some(when),
            };
            check(&op, &[4, 4, 3, 3]);
            check(&Op::Swap { a, b, when: None }, &[4, 4, 3, 3]);
        }
    }
}

#[test]
fn bits() {
    let target = R[2];
    for a in [bit(0, 1, false), bit(0, 1, true), bit(1, 0, true)] {
        for b in [bit(0, 1, false), bit(0, 0, true), bit(1, 2, true)] {
            check(&Op::And { a, b, target }, &[4, 4, 1]);
            check(&Op::Xor { a, b, target }, &[4, 4, 1]);
        }
        check(&Op::Phase { bit: a }, &[4, 4]);
    }
    for parameter in [None, Some(1)] {
        let columns: Arc<[u64]> = Arc::new([0b1011, 0b110, 0, 0b10001]);
        let op = Op::Parity {
            source: R[0],
            columns,
            parameter,
            target: R[1],
        };
        check(&op, &[4, 5]);
    }
    check(
        &Op::Load {
            parameter: 1,
            target: R[0],
        },
        &[13],
    );
}

#[test]
fn products() {
    for style in STYLES {
        for n in 1..=5_u32 {
            for m in 1..=5_u32 {
                for signs in 0..4 {
                    let a = word(0, n, signs & 1 == 1);
                    let b = word(1, m, signs & 2 == 2);
                    for (drop, width) in [
                        (0, n + m),
                        (0, n + m + 2),
                        (0, m),
                        (0, 1),
                        (2, m),
                        (n, m),
                        (n - 1, m + 3),
                        (n + m - 1, 1),
                        (n + m + 1, 2),
                    ] {
                        let [target, scratch] = [R[2], R[3]];
                        let op = Op::Multiply {
                            a,
                            b,
                            drop,
                            style,
                            target,
                            scratch,
                        };
                        check(&op, &[n, m, width]);
                    }
                }
            }
        }
        for a in words(0) {
            for b in words(1).into_iter().chain(words(0)) {
                for (drop, width) in [(0, 12), (3, 5), (1, 4)] {
                    let [target, scratch] = [R[2], R[3]];
                    let op = Op::Multiply {
                        a,
                        b,
                        drop,
                        style,
                        target,
                        scratch,
                    };
                    check(&op, &[4, 4, width]);
                }
            }
        }
    }
}

#[test]
fn squares() {
    for style in STYLES {
        for n in 1..=7_u32 {
            for signed in [false, true] {
                for shift in [0, 1] {
                    for (drop, width) in
                        (0..=2 * n + 2).flat_map(|drop| [(drop, 1), (drop, n), (drop, 2 * n + 2)])
                    {
                        let a = Word {
                            shift,
                            ..word(0, n, signed)
                        };
                        let [target, scratch] = [R[1], R[2]];
                        let op = Op::Square {
                            a,
                            drop,
                            style,
                            target,
                            scratch,
                        };
                        check(&op, &[n, width]);
                    }
                }
            }
        }
    }
}

#[test]
fn multiples() {
    for style in STYLES {
        for n in [1, 2, 3, 5_u32] {
            for signed in [false, true] {
                for factor in (-40..=40).chain([105, -105, 171, -171, 1 << 20, i64::MIN >> 30]) {
                    for (drop, width) in
                        [(0, n + 7), (0, 2), (3, n), (2, n + 9), (n + 6, 3), (60, 2)]
                    {
                        let a = Word {
                            shift: 1,
                            ..word(0, n, signed)
                        };
                        if factor == 0 {
                            continue;
                        }
                        let [target, scratch] = [R[1], R[2]];
                        let op = Op::Scale {
                            a,
                            factor,
                            drop,
                            style,
                            target,
                            scratch,
                        };
                        check(&op, &[n, width]);
                    }
                }
            }
        }
    }
}

#[test]
fn products_with_several_constants() {
    for n in [1, 2, 3, 5_u32] {
        for signed in [false, true] {
            for constants in [&[3][..], &[1, 6, 45], &[45, 361, 90], &[683, 1365, 171]] {
                for (drop, width) in [(0, n + 7), (0, 2), (3, n), (2, n + 12), (n + 6, 3), (60, 2)]
                {
                    let a = Word {
                        shift: 1,
                        ..word(0, n, signed)
                    };
                    let products: Vec<_> = constants.iter().map(|&c| (c, drop)).collect();
                    let targets = R[1..=products.len()].into();
                    let op = Op::Multiples {
                        a,
                        products: Multiples::new(&products).unwrap().into(),
                        targets,
                        scratch: R[1 + products.len()],
                    };
                    let mut widths = vec![n];
                    widths.resize(1 + products.len(), width);
                    check(&op, &widths);
                }
            }
        }
    }
}

#[test]
fn quotients() {
    for style in STYLES {
        for a_bits in 1..=6_u32 {
            for b_bits in 1..=4_u32 {
                for n in [1, 2, 3, 5, 7] {
                    for (shift_a, shift_b) in [(0, 0), (2, 0), (0, 1)] {
                        let a = Word {
                            shift: shift_a,
                            ..word(0, a_bits, false)
                        };
                        let b = Word {
                            shift: shift_b,
                            ..word(1, b_bits, false)
                        };
                        let [quotient, fits, scratch] = [R[2], R[3], R[4]];
                        let op = Op::Divide {
                            a,
                            b,
                            style,
                            quotient,
                            fits,
                            scratch,
                        };
                        check(&op, &[a_bits, b_bits, n, 1]);
                    }
                }
            }
        }
        for a in words(0).into_iter().filter(|word| !word.signed) {
            for b in words(0).into_iter().filter(|word| !word.signed) {
                for n in [1, 3, 6] {
                    let [quotient, fits, scratch] = [R[1], R[2], R[3]];
                    let op = Op::Divide {
                        a,
                        b,
                        style,
                        quotient,
                        fits,
                        scratch,
                    };
                    check(&op, &[4, n, 1]);
                }
            }
        }
    }
}

#[test]
fn roots() {
    for style in STYLES {
        for n in 1..=10_u32 {
            for shift in 0..4 {
                for width in [1, n.div_ceil(2), n + 3] {
                    let a = Word {
                        shift,
                        ..word(0, n, false)
                    };
                    let [target, scratch] = [R[1], R[2]];
                    check(
                        &Op::SquareRoot {
                            a,
                            style,
                            target,
                            scratch,
                        },
                        &[n, width],
                    );
                }
            }
        }
    }
}

#[test]
fn tables() {
    let mut random = 1_u64;
    let mut next = || {
        random = random
            .wrapping_mul(0x5851_f42d_4c95_7f2d)
            .wrapping_add(0x1405_7b7e_f767_814f);
        (random >> 33) as i64
    };
    for address_bits in 1..=6_u32 {
        for length in [1, 2, 3, 5, 11, 31, 32, 33, 64_usize] {
            let length = length.min(1 << address_bits);
            let noise: Arc<[i64]> = (0..length).map(|_| next() & 0xff).collect();
            let line: Arc<[i64]> = (0..length as i64).map(|place| 3 * place - 7).collect();
            let few: Arc<[i64]> = (0..length).map(|place| i64::from(place % 3 == 0)).collect();
            let columns: Arc<[Arc<[i64]>]> = Arc::new([noise, line, few]);
            let wide = (0..=address_bits).map(|low| (low, Style::OutOfPlace));
            for (low, style) in wide.chain([(0, Style::InPlace)]) {
                let address: Box<[Bit]> = (0..address_bits)
                    .map(|index| bit(0, index, index % 3 == 1))
                    .collect();
                let bits = address.clone();
                let op = Op::Table {
                    address,
                    columns: columns.clone(),
                    low,
                    style,
                    targets: Box::new([R[1], R[2], R[3]]),
                    scratch: R[4],
                };
                Bench::new(&op, &[address_bits, 8, 6, 2]).check_all(|contents| {
                    let place = bits.iter().enumerate().fold(0, |sum, (place, bit)| {
                        sum | usize::from(bit.read(contents[0])) << place
                    });
                    place < length
                });
            }
        }
    }
}

#[test]
fn an_encoder_whose_entries_count_upwards_takes_four_cnots_for_a_bit_and_target() {
    let (count, targets) = (64, 3);
    let op = Op::Encode {
        bits: (0..count).map(|index| bit(0, index, false)).collect(),
        entries: (0..u64::from(count)).map(|place| 64 + place).collect(),
        targets: (1..=targets).map(|number| R[number]).collect(),
        scratch: R[targets + 1],
    };
    let widths: Vec<u32> = [count].into_iter().chain(vec![7; targets]).collect();
    let widths = |register: RegisterId| widths.get(register.index()).copied().unwrap_or(0);
    let cnots = cost(&op, false, widths).cnot;
    let pairs = u64::from(count) * targets as u64;
    assert!(cnots <= 4 * pairs, "{cnots} CNOTs for {pairs} pairs");
}

#[test]
fn a_priority_encoder_finds_the_first_bits_that_hold() {
    for count in 1..7_u32 {
        for targets in 1..4 {
            let bits: Box<[Bit]> = (0..count).map(|index| bit(0, index, index == 2)).collect();
            let entries: Vec<u64> = (0..count)
                .map(|place| 8 + (5 * u64::from(place)) % 8)
                .collect();
            let op = Op::Encode {
                bits,
                entries: entries.clone().into(),
                targets: (1..=targets).map(|number| R[number]).collect(),
                scratch: R[targets + 1],
            };
            let widths: Vec<u32> = [count].into_iter().chain(vec![4; targets]).collect();
            Bench::new(&op, &widths).check_all(|_| true);
            // One AND for each bit and each earlier bit whose target it may have to pass.
            let passes: u64 = (0..u64::from(count))
                .map(|bit| bit.min(targets as u64))
                .sum();
            let widths = |register: RegisterId| widths.get(register.index()).copied().unwrap_or(0);
            assert_eq!(cost(&op, false, widths).toffoli, passes);
        }
    }
}
