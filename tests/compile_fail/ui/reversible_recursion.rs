use qrt::prelude::*;

#[reversible]
fn again(a: &mut UInt<4>) {
    a += 1;
    again(&mut a);
}

fn main() {}
