use qrt::prelude::*;

#[reversible]
const fn count(a: &mut UInt<4>) {
    a += 1;
}

fn main() {}
