use qrt::prelude::*;

#[reversible]
fn flip(o: &mut Bool, a: &mut UInt<4>, b: &UInt<4>) {
    o = !o;
    a = !a;
    a = a + b;
    a = b - a;
}

fn main() {}
