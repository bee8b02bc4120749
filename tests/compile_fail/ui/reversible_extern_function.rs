use qrt::prelude::*;

#[reversible]
extern "C" fn count(a: &mut UInt<4>) {
    a += 1;
}

fn main() {}
