use qrt::prelude::*;

#[reversible]
fn add(n: &u32, out: &mut UInt<4>) {
    out += n;
}

fn main() {}
