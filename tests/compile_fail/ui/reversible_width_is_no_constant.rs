use qrt::prelude::*;

#[reversible]
fn count(a: &mut UInt<width>) {
    a += 1;
}

fn main() {}
