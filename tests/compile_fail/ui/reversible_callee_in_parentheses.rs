use qrt::prelude::*;

#[reversible]
fn add(a: &UInt<4>, b: &mut UInt<4>) {
    b += a;
}

#[reversible]
fn twice(a: &UInt<4>, b: &mut UInt<4>) {
    (add)(&a, &mut b);
}

fn main() {}
