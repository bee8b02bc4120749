use qrt::prelude::*;

#[reversible]
fn exchange(a: &mut UInt<4>) {
    swap(a);
}

fn main() {}
