use qrt::prelude::*;

#[reversible]
fn sum(all: &[UInt<4>; length], out: &mut UInt<4>) {
    out += all[0];
}

fn main() {}
