use qrt::prelude::*;

#[reversible]
fn add<const I: u32, const F: u32>(x: &Fixed<I, F>, y: &mut Fixed<I, F>) {
    y += x;
}

#[reversible]
fn add_twice(x: &Fixed<3, 2>, y: &mut Fixed<3, 2>) {
    add(&x, &mut y);
    add(&x, &mut y);
}

fn main() {}
