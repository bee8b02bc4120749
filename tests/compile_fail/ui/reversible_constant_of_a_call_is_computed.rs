use qrt::prelude::*;

#[reversible]
fn add<const W: u32>(a: &UInt<W>, b: &mut UInt<W>) {
    b += a;
}

#[reversible]
fn twice<const W: u32>(a: &UInt<8>, b: &mut UInt<8>) {
    add::<{ W + 1 }>(&a, &mut b);
    for i in 0..8 {
        add::<{ i }>(&a, &mut b);
    }
}

fn main() {}
