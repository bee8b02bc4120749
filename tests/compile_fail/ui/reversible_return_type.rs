use qrt::prelude::*;

#[reversible]
fn sum(a: &UInt<4>, b: &UInt<4>) -> UInt<5> {
    a + b
}

fn main() {}
