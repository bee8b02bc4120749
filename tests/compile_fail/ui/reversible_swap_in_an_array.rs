use qrt::prelude::*;

#[reversible]
fn swaps(all: &mut [UInt<4>; 3]) {
    for i in 0..3 {
        swap(all[i], all[2 - i]);
    }
}

fn main() {}
