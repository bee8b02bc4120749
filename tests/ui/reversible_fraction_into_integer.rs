use qrt::prelude::*;

#[reversible]
fn product(a: &Fixed<2, 6>, out: &mut Int<16>) {
    out += a * a;
}

fn main() {}
