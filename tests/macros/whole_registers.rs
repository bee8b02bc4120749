//! Tests of what a statement does to whole registers: `&`, `|` and `!` of all bits, look-up tables, and
//! claims that a register is zero.

use super::reversible::{all, check, run_all};
use qrt::prelude::*;

/// Every operator, on whole registers and on bits of one.
#[reversible]
fn combined(a: &UInt<3>, b: &UInt<4>, out: &mut UInt<3>) {
    out ^= a & b[1..4] | !b[..3] ^ 5;
    out[0..2] ^= !a[1..3];
}

#[reversible]
fn combined_back(a: &UInt<3>, b: &UInt<4>, out: &mut UInt<3>) {
    combined_inverse(&a, &b, &mut out);
}

/// Scratch of any width, computed and uncomputed by such statements.
#[reversible]
fn masked_sum<const W: u32>(a: &UInt<W>, b: &UInt<W>, out: &mut UInt<W>) {
    let mut both: UInt<W> = 0;
    both ^= a & b;
    out += both;
    both ^= a & b;
    within! { both ^= a | !b; }
    apply! { out ^= both; }
}

#[reversible]
fn masked_sum_back(a: &UInt<3>, b: &UInt<3>, out: &mut UInt<3>) {
    masked_sum_inverse::<3>(&a, &b, &mut out);
}

#[test]
fn whole_registers_are_combined_bit_by_bit() {
    let programs = [combined_program, combined_back_program];
    check(programs, &all(&[3, 4, 3]), |s| {
        let (a, b) = (s[0], s[1]);
        let low = !(a >> 1) & 3;
        // In Rust, too, `&` binds before `^`, and `^` before `|`.
        vec![a, b, s[2] ^ ((a & b >> 1 | (!b & 7) ^ 5) & 7) ^ low]
    });
    let programs = [masked_sum_program::<3>, masked_sum_back_program];
    check(programs, &all(&[3, 3, 3]), |s| {
        let (a, b) = (s[0], s[1]);
        vec![a, b, ((s[2] + (a & b)) % 8) ^ ((a | !b) & 7)]
    });
}

mod numbers {
    /// Squares of three bits.
    pub(super) const SQUARES: [u64; 8] = [0, 1, 4, 9, 16, 25, 36, 49];
}
/// Primes, as another type of number.
const PRIMES: &[i16] = &[2, 3, 5, 7];

/// Entries at numbers, at bits of a number, and at the passes of a loop.
#[reversible]
fn look_up(k: &UInt<3>, flag: &Bool, out: &mut UInt<8>) {
    out += numbers::SQUARES[k];
    out ^= PRIMES[k[1..3]];
    if numbers::SQUARES[k] > 20 && flag {
        out -= 3 * PRIMES[k[0..2]];
    }
    for i in 0..4 {
        out += PRIMES[i];
    }
}

#[reversible]
fn look_up_back(k: &UInt<3>, flag: &Bool, out: &mut UInt<8>) {
    look_up_inverse(&k, &flag, &mut out);
}

/// An entry in a scratch register, which the same entry uncomputes.
#[reversible]
fn by_scratch(k: &UInt<3>, out: &mut UInt<7>) {
    let mut square: UInt<6> = 0;
    square += numbers::SQUARES[k];
    out += square;
    square -= numbers::SQUARES[k];
}

#[reversible]
fn by_scratch_back(k: &UInt<3>, out: &mut UInt<7>) {
    by_scratch_inverse(&k, &mut out);
}

#[test]
fn a_table_is_looked_up() {
    let programs = [look_up_program, look_up_back_program];
    check(programs, &all(&[3, 1, 8]), |s| {
        let k = s[0];
        let prime = |at: u64| -> u64 { PRIMES[at as usize].cast_unsigned().into() };
        let mut out: u64 = (s[2] + k * k) ^ prime(k >> 1);
        // The exclusive or keeps the carry of the addition out of the register.
        out %= 256;
        if k * k > 20 && s[1] == 1 {
            out += 256 - 3 * prime(k & 3);
        }
        vec![k, s[1], (out + 17) % 256]
    });
    let programs = [by_scratch_program, by_scratch_back_program];
    check(programs, &all(&[3, 7]), |s| {
        vec![s[0], (s[1] + s[0] * s[0]) % 128]
    });
}

const MODULUS: u32 = 11;

/// b = (a + b) mod 11, for numbers below 11.
///
/// The result tells a reduced sum: it is less than `a`.
#[reversible]
fn add_modulo(a: &UInt<4>, b: &mut UInt<5>) {
    let mut below: Bool = false;
    b += a;
    below ^= b < MODULUS;
    if !below {
        b -= MODULUS;
    }
    below ^= b >= a;
    assert_zero!(below);
}

#[reversible]
fn subtract_modulo(a: &UInt<4>, b: &mut UInt<5>) {
    add_modulo_inverse(&a, &mut b);
}

#[test]
fn a_sum_is_reduced_in_place() {
    let below = |s: &Vec<u64>| s.iter().all(|number| *number < 11);
    let states: Vec<Vec<u64>> = all(&[4, 4]).into_iter().filter(below).collect();
    let programs = [add_modulo_program, subtract_modulo_program];
    check(programs, &states, |s| vec![s[0], (s[0] + s[1]) % 11]);
    // The claim does not hold for other numbers, and every machine says so.
    for program in [
        add_modulo_program(Style::InPlace),
        subtract_modulo_program(Style::InPlace),
    ] {
        let state = [[15, 20]];
        let dirty =
            |result: Result<_, run::RunError>| matches!(result, Err(run::RunError::Dirty { .. }));
        assert!(dirty(run::on_definition(&program, &state)));
        assert!(dirty(run::on_fixed(&program, &state)));
        assert!(dirty(run::on_gates(&program, &state)));
    }
}

/// A claim in the middle: the register is 0 there, and computed into again.
#[reversible]
fn claimed_twice(a: &UInt<3>, out: &mut UInt<3>) {
    for _ in 0..2 {
        let mut less: Bool = false;
        less ^= a < 4;
        less ^= !a[2];
        assert_zero!(less);
        less ^= a[0];
        if less {
            out += 1;
        }
        less ^= a[0];
    }
}

#[test]
fn a_register_is_used_after_a_claim() {
    let states = all(&[3, 3]);
    let ends = run_all(&claimed_twice_program(Style::InPlace), &states);
    for (s, end) in states.iter().zip(&ends) {
        assert_eq!(*end, [s[0], (s[1] + 2 * (s[0] & 1)) % 8]);
    }
}
