use qrt::prelude::*;

#[reversible]
unsafe fn danger(a: &mut UInt<4>) {
    a += 1;
}

fn main() {}
