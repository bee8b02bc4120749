use qrt::prelude::*;

#[reversible]
fn sum(a: &UInt<4>, b: &mut UInt<4>) {
    a + b;
}

fn main() {}
