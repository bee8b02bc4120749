use qrt::prelude::*;

#[reversible]
trait Count {
    fn count(&mut self);
}

#[reversible]
impl Count for UInt<4> {
    fn count(&mut self) -> Self {
        self += 1;
    }
}

fn main() {}
