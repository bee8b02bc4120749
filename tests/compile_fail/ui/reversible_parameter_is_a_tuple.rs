use qrt::prelude::*;

#[reversible]
fn both(all: &(UInt<4>, UInt<4>), out: &mut UInt<4>) {
    out += 1;
}

fn main() {}
