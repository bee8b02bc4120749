use qrt::prelude::*;

#[reversible]
fn double(a: &mut UInt<4>) {
    a += a;
}

fn main() {}
