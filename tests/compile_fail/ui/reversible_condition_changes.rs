use qrt::prelude::*;

#[reversible]
fn decide(a: &mut UInt<4>) {
    if a[0] {
        a += 2;
    }
}

fn main() {}
