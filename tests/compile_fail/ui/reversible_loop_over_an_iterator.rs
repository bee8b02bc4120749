use qrt::prelude::*;

#[reversible]
fn some(b: &mut UInt<4>) {
    for i in [1, 3] {
        b[i] ^= true;
    }
}

fn main() {}
