use qrt::prelude::*;

#[reversible]
fn count<const W: u32>(W: &mut UInt<4>) {
    W += 1;
}

fn main() {}
