use qrt::prelude::*;

#[reversible]
fn nothing(a: &UInt<4>, b: &mut UInt<4>) {
    b += a >> 4;
}

fn main() {}
