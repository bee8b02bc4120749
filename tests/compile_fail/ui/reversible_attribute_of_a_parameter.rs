use qrt::prelude::*;

#[reversible]
fn add(a: &UInt<4>, #[cfg(debug_assertions)] b: &UInt<4>, c: &mut UInt<4>) {
    c += a;
    c += b;
}

fn main() {}
