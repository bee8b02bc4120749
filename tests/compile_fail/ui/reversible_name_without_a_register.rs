use qrt::prelude::*;

#[reversible]
fn count(a: &mut UInt<4>) {
    a += velocity;
}

fn main() {}
