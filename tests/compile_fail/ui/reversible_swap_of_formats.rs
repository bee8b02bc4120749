use qrt::prelude::*;

#[reversible]
fn exchange(a: &mut UInt<4>, b: &mut Int<4>) {
    swap(a, b);
}

fn main() {}
