use qrt::prelude::*;

#[reversible]
fn add(a: &UInt<4>, b: &mut UInt<4>) {
    b += a;
}

#[reversible]
fn wrong(b: &mut UInt<4>) {
    add(&mut b);
}

fn main() {}
