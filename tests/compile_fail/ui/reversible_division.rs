use qrt::prelude::*;

#[reversible]
fn third(a: &UInt<8>, b: &mut UInt<8>) {
    b += a / 3;
}

fn main() {}
