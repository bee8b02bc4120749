use qrt::prelude::*;

#[reversible]
fn tenth(out: &mut Fixed<2, 6>) {
    out += 0.1;
}

fn main() {}
