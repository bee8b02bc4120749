use qrt::prelude::*;

#[reversible]
fn count<const W: u32>(a: &mut UInt<4>, b: &mut UInt<{ W + 1 }>) {
    a[0..2].increment();
    (&mut b).increment();
}

fn main() {}
