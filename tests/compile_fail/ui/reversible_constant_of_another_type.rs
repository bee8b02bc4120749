use qrt::prelude::*;

#[reversible]
fn add<const W: usize>(b: &mut UInt<4>) {
    b += 1;
}

fn main() {}
