use qrt::prelude::*;

#[reversible]
fn copy(a: &UInt<8>, b: &mut Bool) {
    b ^= a[0..4][1];
}

fn main() {}
