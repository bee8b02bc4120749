use qrt::prelude::*;

#[reversible]
fn change(a: &UInt<4>) {
    a += 1;
}

fn main() {}
