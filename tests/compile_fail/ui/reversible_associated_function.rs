use qrt::prelude::*;

struct Adder;

impl Adder {
    #[reversible]
    fn twice(a: &UInt<4>, b: &mut UInt<4>) {
        Self::add(&a, &mut b);
        Adder::add(&a, &mut b);
    }

    fn add(a: u32, b: &mut u32) {
        *b += a;
    }
}

fn main() {}
