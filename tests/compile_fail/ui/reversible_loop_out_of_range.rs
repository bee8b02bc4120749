use qrt::prelude::*;

#[reversible]
fn shift(a: &UInt<8>, b: &mut UInt<8>) {
    for i in 0..8 {
        b[i + 1] ^= a[i];
    }
}

fn main() {}
