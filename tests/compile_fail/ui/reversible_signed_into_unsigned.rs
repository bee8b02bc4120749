use qrt::prelude::*;

#[reversible]
fn sum(a: &Int<4>, out: &mut UInt<8>) {
    out += a;
}

fn main() {}
