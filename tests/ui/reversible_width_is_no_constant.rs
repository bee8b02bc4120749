use qrt::prelude::*;

const WIDTH: u32 = 4;

#[reversible]
fn count(a: &mut UInt<WIDTH>) {
    a += 1;
}

fn main() {}
