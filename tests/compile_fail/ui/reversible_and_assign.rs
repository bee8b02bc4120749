use qrt::prelude::*;

#[reversible]
fn mask(a: &mut Bool, b: &Bool) {
    a &= b;
}

fn main() {}
