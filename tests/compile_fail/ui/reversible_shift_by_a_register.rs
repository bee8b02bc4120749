use qrt::prelude::*;

#[reversible]
fn shift(a: &UInt<4>, n: &UInt<2>, b: &mut UInt<8>) {
    b += a << n;
    b += a >> n;
}

fn main() {}
