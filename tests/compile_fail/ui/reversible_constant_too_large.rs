use qrt::prelude::*;

#[reversible]
fn much(out: &mut UInt<4>) {
    out += 16;
}

fn main() {}
