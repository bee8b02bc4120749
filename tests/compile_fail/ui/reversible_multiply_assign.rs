use qrt::prelude::*;

#[reversible]
fn triple(a: &mut UInt<4>) {
    a *= 3;
}

fn main() {}
