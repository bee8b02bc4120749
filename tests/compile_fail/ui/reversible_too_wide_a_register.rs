use qrt::prelude::*;

#[reversible]
fn wide(a: &UInt<64>, b: &mut UInt<8>) {
    b += a[0..8];
}

fn main() {}
