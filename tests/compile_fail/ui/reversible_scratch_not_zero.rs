use qrt::prelude::*;

#[reversible]
fn scratch(b: &mut UInt<4>) {
    let mut t: UInt<4> = 1;
    b += t;
}

fn main() {}
