use qrt::prelude::*;

#[reversible]
fn add<T>(a: &T, b: &mut UInt<4>) {
    b += 1;
}

fn main() {}
