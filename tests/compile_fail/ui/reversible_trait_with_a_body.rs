use qrt::prelude::*;

#[reversible]
trait Count {
    fn count(&mut self) {
        self += 1;
    }
}

fn main() {}
