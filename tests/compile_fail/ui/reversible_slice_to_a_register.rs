use qrt::prelude::*;

#[reversible]
fn copy(a: &UInt<4>, n: &UInt<2>, b: &mut UInt<4>) {
    b += a[n..4];
    b += a[0..n];
}

fn main() {}
