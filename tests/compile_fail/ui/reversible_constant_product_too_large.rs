use qrt::prelude::*;

#[reversible]
fn count(a: &mut UInt<63>) {
    a += 4_000_000_000 * 4_000_000_000;
}

fn main() {}
