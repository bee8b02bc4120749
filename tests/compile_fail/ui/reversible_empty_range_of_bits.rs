use qrt::prelude::*;

#[reversible]
fn copy(a: &UInt<4>, b: &mut UInt<4>) {
    b += a[2..2];
}

fn main() {}
