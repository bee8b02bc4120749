use qrt::prelude::*;

#[reversible]
fn flip(a: &mut UInt<4>) {
    a[4] ^= true;
}

fn main() {}
