use qrt::prelude::*;

#[reversible]
fn masked(a: &UInt<4>, c: &mut UInt<4>) {
    c ^= a & 16;
}

fn main() {}
