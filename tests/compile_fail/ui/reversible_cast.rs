use qrt::prelude::*;

#[reversible]
fn widen(a: &UInt<4>, b: &mut UInt<8>) {
    b += a as UInt<8>;
}

fn main() {}
