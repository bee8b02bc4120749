use qrt::prelude::*;

#[reversible]
fn product<const W: u32, const V: u32>(a: &UInt<W>, out: &mut UInt<{ W * V }>) {
    out += a;
}

fn main() {}
