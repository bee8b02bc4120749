use qrt::prelude::*;

#[reversible]
fn count(a: &mut UInt<4>) {
    for (i, j) in 0..4 {
        a += 1;
    }
}

fn main() {}
