use qrt::prelude::*;

#[reversible]
fn count(a: &mut UInt<4>) {
    a += 2 * -3;
}

fn main() {}
