use qrt::prelude::*;

#[reversible]
fn negated(a: &UInt<4>, c: &mut UInt<4>) {
    c += !a;
}

fn main() {}
