use qrt::prelude::*;

#[reversible]
fn decide(a: &UInt<4>, b: &mut UInt<4>) {
    if a {
        b += 1;
    }
}

fn main() {}
