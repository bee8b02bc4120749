use qrt::prelude::*;

#[reversible]
fn count(mut a: &mut UInt<4>) {
    a += 1;
}

fn main() {}
