use qrt::prelude::*;

#[reversible]
fn count(a: &mut UInt<4>) {
    a += "3";
}

fn main() {}
