use qrt::prelude::*;

#[reversible]
fn shift(a: &UFixed<0, 14>, b: &mut UFixed<0, 14>) {
    b += a >> 20;
}

fn main() {}
