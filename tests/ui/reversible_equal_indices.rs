use qrt::prelude::*;

#[reversible]
fn clear(a: &mut UInt<4>) {
    for i in 0..4 {
        a[i] ^= a[i];
    }
}

fn main() {}
