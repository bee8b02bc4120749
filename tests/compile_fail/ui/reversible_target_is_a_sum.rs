use qrt::prelude::*;

#[reversible]
fn add(a: &mut UInt<4>, b: &mut UInt<4>) {
    a + b += 1;
}

fn main() {}
