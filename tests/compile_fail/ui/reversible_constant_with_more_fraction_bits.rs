use qrt::prelude::*;

#[reversible]
fn little(out: &mut Fixed<2, 6>) {
    out += 0.0078125;
}

fn main() {}
