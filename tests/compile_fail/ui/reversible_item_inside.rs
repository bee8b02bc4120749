use qrt::prelude::*;

#[reversible]
fn count(a: &mut UInt<4>) {
    const ONE: u32 = 1;
    a += 1;
}

fn main() {}
