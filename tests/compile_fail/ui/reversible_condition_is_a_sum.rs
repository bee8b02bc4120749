use qrt::prelude::*;

#[reversible]
fn count(a: &UInt<4>, b: &mut UInt<4>) {
    if a + 1 {
        b += 1;
    }
}

fn main() {}
