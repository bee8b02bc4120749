use qrt::prelude::*;

#[reversible]
fn take(a: UInt<4>, b: &mut UInt<4>) {
    b += a;
}

fn main() {}
