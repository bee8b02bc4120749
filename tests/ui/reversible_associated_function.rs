use qrt::prelude::*;

struct Adder;

impl Adder {
    #[reversible]
    fn add(a: &UInt<4>, b: &mut UInt<4>) {
        b += a;
    }
}

#[reversible]
fn outer(a: &UInt<4>, b: &mut UInt<4>) {
    Adder::add(&a, &mut b);
}

fn main() {}
