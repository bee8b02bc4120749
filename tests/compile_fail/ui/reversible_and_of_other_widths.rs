use qrt::prelude::*;

#[reversible]
fn masked(a: &UInt<6>, b: &UInt<2>, c: &mut UInt<4>) {
    c ^= a & b;
}

fn main() {}
