use qrt::prelude::*;

#[reversible]
fn half(a: &UInt<4>, b: &mut UInt<4>) {
    within! { b += a; }
    b += 1;
}

fn main() {}
