use qrt::prelude::*;

#[reversible]
fn take(a: &u32, b: &mut UInt<4>) {
    b += a;
}

fn main() {}
