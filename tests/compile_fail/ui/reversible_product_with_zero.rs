use qrt::prelude::*;

#[reversible]
fn multiply(a: &UInt<4>, b: &mut UInt<8>) {
    b += 0 * a;
}

fn main() {}
