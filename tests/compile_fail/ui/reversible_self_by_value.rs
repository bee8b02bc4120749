use qrt::prelude::*;

#[reversible]
trait Count {
    fn count(&mut self);
}

#[reversible]
impl Count for UInt<4> {
    fn count(self) {
        self += 1;
    }
}

fn main() {}
