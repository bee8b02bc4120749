use qrt::prelude::*;

#[reversible]
fn reduce(a: &mut UInt<4>) {
    if a > 3 {
        a -= 3
    }
}

fn main() {}
