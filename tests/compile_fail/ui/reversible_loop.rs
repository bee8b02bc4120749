use qrt::prelude::*;

#[reversible]
fn forever(b: &mut UInt<4>) {
    loop {
        b += 1;
    }
}

fn main() {}
