use qrt::prelude::*;

#[reversible]
fn wrap(a: &UInt<4>, c: &mut UInt<4>) {
    let mut less: Bool = false;
    less ^= c < a;
    assert_zero!(less);
    less ^= c < 3;
}

fn main() {}
