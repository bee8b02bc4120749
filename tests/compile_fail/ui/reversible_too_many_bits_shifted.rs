use qrt::prelude::*;

#[reversible]
fn shift(a: &UInt<8>, b: &mut UInt<8>) {
    b += wrapping(a << 60);
}

fn main() {}
