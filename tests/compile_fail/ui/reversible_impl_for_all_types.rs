use qrt::prelude::*;

#[reversible]
trait Count {
    fn count(&mut self);
}

#[reversible]
impl<F: Format> Count for F {
    fn count(&mut self) {
        self ^= 1;
    }
}

fn main() {}
