use qrt::prelude::*;

#[reversible]
fn sum(angle: &UInt<4>, out: &mut UInt<8>) {
    out += angel;
}

fn main() {}
