use qrt::prelude::*;

#[reversible]
fn sometimes(a: &mut UInt<4>) {
    a += value()?;
}

fn main() {}
