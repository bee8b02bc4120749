use qrt::prelude::*;

#[reversible]
fn count(a: &mut UInt<4>) {
    &a;
    a += 1;
}

fn main() {}
