use qrt::prelude::*;

#[reversible]
fn sometimes(flag: &Bool, a: &mut UInt<4>) {
    if flag {
        return;
    }
    a += 1;
}

fn main() {}
