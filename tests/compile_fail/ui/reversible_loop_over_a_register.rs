use qrt::prelude::*;

#[reversible]
fn often(a: &UInt<4>, b: &mut UInt<4>) {
    for _ in 0..a {
        b += 1;
    }
}

fn main() {}
