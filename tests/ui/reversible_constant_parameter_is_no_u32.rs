use qrt::prelude::*;

#[reversible]
fn count<const W: usize>(a: &mut UInt<W>) {
    a += 1;
}

fn main() {}
