use qrt::prelude::*;

#[reversible]
fn multiply(a: &UInt<8>, b: &UInt<8>, c: &mut UInt<8>) {
    c += wrapping((a << 60) * b);
    c += wrapping(a * (b << 60));
}

fn main() {}
