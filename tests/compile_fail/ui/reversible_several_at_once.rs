use qrt::prelude::*;

#[reversible]
fn wrong(a: &UInt<4>, b: &mut UInt<4>) {
    b = a;
    b *= 2;
    a += 1;
}

#[reversible]
fn caller(a: &UInt<4>, b: &mut UInt<4>) {
    wrong(&a, &mut b);
}

fn main() {}
