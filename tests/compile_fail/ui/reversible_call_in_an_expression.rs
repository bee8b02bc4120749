use qrt::prelude::*;

#[reversible]
fn root(a: &UInt<8>, b: &mut UInt<8>) {
    b += sqrt(a);
}

fn main() {}
