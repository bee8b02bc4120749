use qrt::prelude::*;

#[reversible]
fn carry(a: &mut UInt<8>, b: &UInt<4>) {
    a[0..4] += b;
}

fn main() {}
