use qrt::prelude::*;

#[reversible]
fn count(a: &'static mut UInt<4>) {
    a += 1;
}

fn main() {}
