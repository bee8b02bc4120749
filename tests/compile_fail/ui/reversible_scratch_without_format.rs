use qrt::prelude::*;

#[reversible]
fn scratch(b: &mut UInt<4>) {
    let mut t = 0;
    b += 1;
}

fn main() {}
