use qrt::prelude::*;

#[reversible]
fn pick(a: &UInt<8>, i: &UInt<3>, b: &mut Bool) {
    b ^= a[i];
}

fn main() {}
