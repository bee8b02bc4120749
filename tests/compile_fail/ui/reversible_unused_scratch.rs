use qrt::prelude::*;

#[reversible]
fn waste(b: &mut UInt<4>) {
    let mut t: UInt<4> = 0;
    b += 1;
}

fn main() {}
