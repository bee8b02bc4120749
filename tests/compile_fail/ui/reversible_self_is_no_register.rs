use qrt::prelude::*;

struct Counter;

#[reversible]
impl Counter {
    fn count(&mut self, a: &mut UInt<4>) {
        a += 1;
    }
}

fn main() {}
