use qrt::prelude::*;

trait Count {
    fn count(&mut self);
}

impl Count for UInt<4> {
    #[reversible]
    fn count(&mut self) {
        self += 1;
    }
}

fn main() {}
