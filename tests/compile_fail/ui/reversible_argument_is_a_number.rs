use qrt::prelude::*;

#[reversible]
fn add(a: &UInt<4>, b: &mut UInt<4>) {
    b += a;
}

#[reversible]
fn count(b: &mut UInt<4>) {
    add(1, &mut b);
}

fn main() {}
