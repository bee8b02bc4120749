use qrt::prelude::*;

#[reversible]
fn half(a: &mut UInt<4>) {
    a /= 2;
}

fn main() {}
