use qrt::prelude::*;

#[reversible(fast)]
fn add(a: &UInt<4>, b: &mut UInt<4>) {
    b += a;
}

fn main() {}
