use qrt::prelude::*;

#[reversible]
fn half(a: &UInt<4>, b: &mut UInt<4>) {
    apply! { b += a; }
}

fn main() {}
