use qrt::prelude::*;

#[reversible]
fn count(a: &mut UInt<4>) {
    for a in 0..4 {
        a += 1;
    }
}

fn main() {}
