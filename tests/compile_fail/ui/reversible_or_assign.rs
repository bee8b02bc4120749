use qrt::prelude::*;

#[reversible]
fn set(o: &mut UInt<4>) {
    o |= 3;
}

fn main() {}
