use qrt::prelude::*;

#[reversible]
fn again(a: &UInt<4>, b: &mut UInt<4>) {
    let mut a: UInt<4> = 0;
    within! { a += 1; }
    apply! { b += a; }
}

fn main() {}
