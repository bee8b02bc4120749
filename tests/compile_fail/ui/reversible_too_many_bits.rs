use qrt::prelude::*;

#[reversible]
fn squared(x: &UInt<4>, out: &mut UInt<6>) {
    out += x * x;
}

fn main() {}
