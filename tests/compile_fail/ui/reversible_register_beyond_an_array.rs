use qrt::prelude::*;

#[reversible]
fn sum(all: &[UInt<4>; 3], out: &mut UInt<4>) {
    for i in 0..4 {
        out += all[i];
    }
}

fn main() {}
