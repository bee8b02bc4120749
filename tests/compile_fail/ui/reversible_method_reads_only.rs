use qrt::prelude::*;

#[reversible]
trait Count {
    fn count(&mut self);
    fn add_to(&self, other: &mut Self);
}

#[reversible]
impl Count for UInt<4> {
    fn count(&mut self) {
        self += 1;
    }

    fn add_to(&self, other: &mut Self) {
        self.count();
        other += self;
    }
}

fn main() {}
