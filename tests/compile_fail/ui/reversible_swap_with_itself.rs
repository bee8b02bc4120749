use qrt::prelude::*;

#[reversible]
fn nothing(a: &mut UInt<4>) {
    swap(a, a);
}

fn main() {}
