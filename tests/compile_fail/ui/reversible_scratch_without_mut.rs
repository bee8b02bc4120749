use qrt::prelude::*;

#[reversible]
fn count(a: &mut UInt<4>) {
    let t: UInt<4> = 0;
    a += 1;
}

fn main() {}
