use qrt::prelude::*;

#[reversible]
fn copy<const W: u32>(a: &UInt<W>, b: &mut Bool) {
    b ^= a[W];
}

fn main() {}
