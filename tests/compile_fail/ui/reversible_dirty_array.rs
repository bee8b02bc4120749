use qrt::prelude::*;

#[reversible]
fn count(a: &UInt<4>, out: &mut Bool) {
    let mut bits: [Bool; 4] = [false; 4];
    for i in 0..4 {
        bits[i] ^= a[i] & a[0];
    }
    out ^= bits[3];
    for i in 0..3 {
        bits[i] ^= a[i] & a[0];
    }
}

fn main() {}
