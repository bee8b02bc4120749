//! Tests that the routines of `examples/textbook.rs` are correct on all contents of their registers, on all
//! machines, and leave no garbage.

use super::reversible::{all, check, run_all};
use qrt::circuit::{Gate, lower};
use qrt::prelude::*;

#[allow(dead_code, reason = "its `main` is the example's")]
#[path = "../../examples/textbook.rs"]
mod routines;

use routines::*;

/// Returns the inverse of a program.
macro_rules! undone {
    ($program:expr) => {
        |style| $program(style).inverse()
    };
}

#[test]
fn sums_swaps_and_comparisons() {
    let programs = [add_program::<5>, undone!(add_program::<5>)];
    check(programs, &all(&[5, 5]), |s| vec![s[0], (s[0] + s[1]) % 32]);
    let programs = [swap_if_program::<4>, undone!(swap_if_program::<4>)];
    check(programs, &all(&[1, 4, 4]), |s| match s[0] {
        0 => s.to_vec(),
        _ => vec![1, s[2], s[1]],
    });
    let programs = [compare_program::<5>, undone!(compare_program::<5>)];
    check(programs, &all(&[5, 5, 1]), |s| {
        vec![s[0], s[1], s[2] ^ u64::from(s[0] < s[1])]
    });
}

#[test]
fn an_increment_that_goes_around() {
    let programs = [increment_modulo_program, undone!(increment_modulo_program)];
    check(programs, &all(&[4]), |s| {
        // The exchange of 11 and 0 decides the result for x of 11 or more.
        vec![match (s[0] + 1) % 16 {
            0 => 11,
            11 => 0,
            next => next,
        }]
    });
}

#[test]
fn a_root_digit_by_digit() {
    fn is_root(program: fn(Style) -> Program, bits: u32) {
        let states: Vec<Vec<u64>> = (0..1 << bits).map(|x| vec![x, 0]).collect();
        for style in [Style::InPlace, Style::OutOfPlace] {
            for (state, end) in states.iter().zip(run_all(&program(style), &states)) {
                let root = state[0].isqrt();
                assert_eq!(end, [state[0] - root * root, root], "of {}", state[0]);
            }
        }
    }
    is_root(square_root_program::<1, 3>, 2);
    is_root(square_root_program::<3, 7>, 6);
    is_root(square_root_program::<5, 11>, 10);
}

#[test]
fn ones_are_counted() {
    let programs = [popcount_program, undone!(popcount_program)];
    check(programs, &all(&[8, 4]), |s| {
        vec![s[0], s[1] ^ u64::from(s[0].count_ones())]
    });
}

#[test]
fn four_numbers_are_sorted() {
    let states: Vec<Vec<u64>> = all(&[2, 2, 2, 2])
        .into_iter()
        .map(|mut state| {
            state.extend([0; 5]);
            state
        })
        .collect();
    for style in [Style::InPlace, Style::OutOfPlace] {
        let program = sort_four_program::<2>(style);
        for (state, end) in states.iter().zip(run_all(&program, &states)) {
            let mut sorted = state[..4].to_vec();
            sorted.sort_unstable();
            assert_eq!(end[..4], sorted, "of {state:?}");
        }
    }
}

#[test]
fn products_are_added() {
    let signed = |bits: u64, width: u32| (bits << (64 - width)).cast_signed() >> (64 - width);
    let programs = [
        multiply_add_program::<3>,
        undone!(multiply_add_program::<3>),
    ];
    let states: Vec<_> = all(&[5, 5])
        .into_iter()
        .map(|s| vec![s[0], s[1], 77])
        .collect();
    check(programs, &states, |s| {
        let product = (signed(s[0], 5) * signed(s[1], 5)) >> 3;
        vec![s[0], s[1], (77 + product).cast_unsigned() % 128]
    });
}

#[test]
fn the_book_shows_what_they_cost() {
    let book = std::fs::read_to_string("book/src/macros.md").unwrap();
    for (name, program, published, _) in routines::rows() {
        let cost: lower::Cost = lower::tally(&program).into_iter().sum();
        let (toffoli, measured) = (cost.toffoli, cost.and_measured);
        let row = format!("| {name} | {toffoli} | {measured} | {published} |");
        assert!(book.contains(&row), "{row}");
        // Each count equals the number of gates.
        let gates = lower::circuit(&program).gates;
        let counted = gates
            .iter()
            .filter(|gate| matches!(gate, Gate::Ccx(..)))
            .count();
        assert_eq!(counted as u64, toffoli, "{name}");
    }
}
