use qrt::prelude::*;

#[reversible]
fn add(a: &UInt<4>, b: &mut UInt<4>) {
    b += a;
}

#[reversible]
fn back(a: &UInt<4>, b: &UInt<4>) {
    add(&b, &mut a);
}

fn main() {}
