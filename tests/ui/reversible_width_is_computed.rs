use qrt::prelude::*;

#[reversible]
fn square<const W: u32>(a: &UInt<W>, out: &mut UInt<{ 2 * W }>) {
    out += a * a;
}

fn main() {}
