use qrt::prelude::*;

#[reversible]
fn add<const W: u32>(a: &UInt<W>, b: &mut UInt<W>) {
    b += a;
}

#[reversible]
fn wrong(a: &UInt<4>, b: &mut UInt<8>) {
    add(&a, &mut b);
}

fn main() {}
