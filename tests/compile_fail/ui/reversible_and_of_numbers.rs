use qrt::prelude::*;

#[reversible]
fn mask(a: &UInt<4>, b: &mut UInt<4>) {
    b += a & 3;
}

fn main() {}
