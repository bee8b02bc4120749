use qrt::prelude::*;

#[reversible]
fn decide(a: &mut UInt<4>) {
    if true {
        a += 2;
    }
}

fn main() {}
