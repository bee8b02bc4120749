use qrt::prelude::*;

#[reversible]
fn exchange(a: &mut UInt<4>, b: &mut UInt<4>) {
    swap(a[0], b[0]);
}

fn main() {}
