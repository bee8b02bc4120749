use qrt::prelude::*;

#[reversible]
trait Count {
    fn count(#[cfg(debug_assertions)] &mut self);
}

#[reversible]
impl Count for UInt<4> {
    fn count(#[cfg(debug_assertions)] &mut self) {
        self += 1;
    }
}

fn main() {}
