use qrt::prelude::*;

#[reversible]
fn masked<const W: u32>(a: &UInt<W>, c: &mut UInt<W>) {
    c ^= a & 1;
}

fn main() {}
