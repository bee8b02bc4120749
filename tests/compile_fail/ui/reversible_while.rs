use qrt::prelude::*;

#[reversible]
fn until(a: &UInt<4>, b: &mut UInt<4>) {
    while b < a {
        b += 1;
    }
}

fn main() {}
