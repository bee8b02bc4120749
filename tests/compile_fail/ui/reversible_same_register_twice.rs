use qrt::prelude::*;

#[reversible]
fn add(a: &UInt<4>, b: &mut UInt<4>) {
    b += a;
}

#[reversible]
fn double(a: &mut UInt<4>) {
    add(&a, &mut a);
}

fn main() {}
