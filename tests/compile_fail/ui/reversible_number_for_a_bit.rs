use qrt::prelude::*;

#[reversible]
fn flag(a: &UInt<4>, b: &mut Bool) {
    b ^= a;
}

fn main() {}
