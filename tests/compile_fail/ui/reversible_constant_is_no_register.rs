use qrt::prelude::*;

#[reversible]
fn width<const W: u32>(out: &mut UInt<W>) {
    W += out;
}

fn main() {}
