use qrt::prelude::*;

#[reversible]
fn copy(a: &UInt<4>, out: &mut UInt<4>) {
    *out ^= a;
    out ^= *a;
}

fn main() {}
