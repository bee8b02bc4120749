use qrt::prelude::*;

#[reversible]
fn compare<const F: u32, const G: u32>(a: &UFixed<1, F>, b: &UFixed<1, G>, c: &mut Bool) {
    c ^= a < b;
}

fn main() {}
