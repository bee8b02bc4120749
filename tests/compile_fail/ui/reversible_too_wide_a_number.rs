use qrt::prelude::*;

#[reversible]
fn wide(a: &UInt<40>, b: &mut Bool) {
    b ^= a * a < 7;
}

fn main() {}
