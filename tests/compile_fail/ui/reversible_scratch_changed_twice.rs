use qrt::prelude::*;

#[reversible]
fn add(a: &UInt<4>, b: &mut UInt<8>) {
    let mut t: UInt<8> = 0;
    t += a;
    t += 1;
    b += t;
}

fn main() {}
