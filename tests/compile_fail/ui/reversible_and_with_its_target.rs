use qrt::prelude::*;

#[reversible]
fn mask(a: &mut UInt<4>, b: &UInt<4>) {
    a ^= a & b;
}

fn main() {}
