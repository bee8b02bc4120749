use qrt::prelude::*;

#[reversible]
fn call(a: &mut UInt<4>) {
    a.increment();
}

fn main() {}
