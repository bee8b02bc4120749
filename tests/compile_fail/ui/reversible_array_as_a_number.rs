use qrt::prelude::*;

#[reversible]
fn sum(all: &[UInt<4>; 3], out: &mut UInt<4>) {
    out += all;
}

fn main() {}
