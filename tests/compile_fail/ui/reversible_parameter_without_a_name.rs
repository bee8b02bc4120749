use qrt::prelude::*;

#[reversible]
fn count(_: &UInt<4>, a: &mut UInt<4>) {
    a += 1;
}

fn main() {}
