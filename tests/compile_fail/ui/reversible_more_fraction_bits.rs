use qrt::prelude::*;

#[reversible]
fn sum(a: &Fixed<2, 8>, out: &mut Fixed<4, 4>) {
    out += a;
}

fn main() {}
