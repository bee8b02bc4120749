use qrt::prelude::*;

#[reversible]
fn count(a: &mut UInt<4>) {
    a += 3u32;
}

fn main() {}
