use qrt::prelude::*;

#[reversible]
fn twice(a: &UInt<4>, b: &mut UInt<8>) {
    b += (a, a);
}

fn main() {}
