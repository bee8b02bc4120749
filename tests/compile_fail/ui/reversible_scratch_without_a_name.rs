use qrt::prelude::*;

#[reversible]
fn count(a: &mut UInt<4>) {
    let _: UInt<4> = 0;
    a += 1;
}

fn main() {}
