use qrt::prelude::*;

#[reversible]
fn mix(a: &mut UInt<4>) {
    for i in 0..4 {
        for j in 0..4 {
            a[i] ^= a[j];
        }
    }
}

fn main() {}
