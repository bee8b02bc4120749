use qrt::prelude::*;

#[reversible]
fn add(a: &UInt<4>, b: &mut UInt<4>) {
    b += a;
}

#[reversible]
fn more(a: &UInt<4>, b: &mut UInt<4>) {
    add(&(a + 1), &mut b);
}

fn main() {}
