use qrt::prelude::*;

#[reversible]
fn count(a: &mut UInt<4>) {
    let mut t: UInt<4>;
    a += 1;
}

fn main() {}
