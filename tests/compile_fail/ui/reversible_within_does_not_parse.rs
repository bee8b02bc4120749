use qrt::prelude::*;

#[reversible]
fn count(a: &mut UInt<4>, b: &mut UInt<4>) {
    within! {
        a += 1 2;
    }
    apply! {
        b += a;
    }
}

fn main() {}
