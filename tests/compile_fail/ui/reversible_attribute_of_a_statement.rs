use qrt::prelude::*;

#[reversible]
fn exchange(a: &mut UInt<4>, b: &mut UInt<4>) {
    #[cfg(debug_assertions)]
    swap(a, b);
}

fn main() {}
