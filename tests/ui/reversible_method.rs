use qrt::prelude::*;

struct Counter;

impl Counter {
    #[reversible]
    fn count(&mut self, a: &mut UInt<4>) {
        a += 1;
    }
}

fn main() {}
