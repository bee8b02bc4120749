use qrt::prelude::*;

#[reversible]
fn skip(a: &UInt<4>, b: &mut UInt<4>) {
    for i in 0..4 {
        if a[i] {
            continue;
        }
        b += 1;
    }
}

fn main() {}
