use qrt::prelude::*;

#[reversible]
fn until(a: &UInt<4>, b: &mut UInt<4>) {
    for i in 0..4 {
        if a[i] {
            break;
        }
        b += 1;
    }
}

fn main() {}
