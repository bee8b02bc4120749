use qrt::prelude::*;

#[reversible]
fn any(a: &mut UInt<4>, _: ...) {
    a += 1;
}

fn main() {}
