//! Two functions that call each other: no program of them ends, and none is built.

use qrt::prelude::*;

#[reversible]
fn question(a: &UInt<2>, b: &mut UInt<2>) {
    answer(&a, &mut b);
}

#[reversible]
fn answer(a: &UInt<2>, b: &mut UInt<2>) {
    question(&a, &mut b);
}

fn main() {
    question_program(Style::InPlace);
}
