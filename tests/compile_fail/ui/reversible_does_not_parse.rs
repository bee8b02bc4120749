use qrt::prelude::*;

#[reversible]
fn count(a: &mut UInt<4>) {
    match a {
        0
    }
}

fn main() {}
