use qrt::prelude::*;

#[reversible]
fn later(a: &mut UInt<4>) {
    || a += 1;
}

fn main() {}
