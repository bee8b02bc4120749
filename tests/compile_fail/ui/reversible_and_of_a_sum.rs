use qrt::prelude::*;

#[reversible]
fn masked(a: &UInt<4>, b: &UInt<4>, c: &mut UInt<4>) {
    c ^= a & (b + 1);
}

fn main() {}
