use qrt::prelude::*;

#[reversible]
struct Registers {
    a: UInt<4>,
}

fn main() {}
