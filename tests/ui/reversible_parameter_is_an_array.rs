use qrt::prelude::*;

#[reversible]
fn count(a: &mut [UInt<4>; 2]) {
    a += 1;
}

fn main() {}
