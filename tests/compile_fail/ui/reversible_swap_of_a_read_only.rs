use qrt::prelude::*;

#[reversible]
fn exchange(a: &UInt<4>, b: &mut UInt<4>) {
    swap(a, b);
}

fn main() {}
