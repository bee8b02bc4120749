use qrt::prelude::*;

#[reversible]
fn add<const W: u32>(a: &UInt<W>, b: &mut UInt<W>) {
    b += a;
}

#[reversible]
fn twice<const W: u32>(a: &UInt<{ 2 * W }>, b: &mut UInt<{ 2 * W }>) {
    add(&a, &mut b);
    add(&a, &mut b);
}

fn main() {}
