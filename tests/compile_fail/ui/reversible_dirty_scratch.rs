use qrt::prelude::*;

#[reversible]
fn squared(x: &UInt<4>, out: &mut UInt<8>) {
    let mut square: UInt<8> = 0;
    square += x * x;
    out += square;
}

fn main() {}
