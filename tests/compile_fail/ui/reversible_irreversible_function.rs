use qrt::prelude::*;

#[reversible]
fn outer(a: &mut UInt<4>) {
    plain(&mut a);
}

fn plain(_: &mut u32) {}

fn main() {}
