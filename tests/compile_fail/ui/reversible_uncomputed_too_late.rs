use qrt::prelude::*;

#[reversible]
fn late(x: &mut UInt<4>, out: &mut UInt<8>) {
    let mut square: UInt<8> = 0;
    square += x * x;
    out += square;
    x += 1;
    square -= x * x;
}

fn main() {}
