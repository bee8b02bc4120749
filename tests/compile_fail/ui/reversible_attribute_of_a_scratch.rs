use qrt::prelude::*;

#[reversible]
fn square(a: &UInt<4>, b: &mut UInt<8>) {
    #[allow(unused)]
    let mut t: UInt<8> = 0;
    within! {
        t += a * a;
    }
    apply! {
        b += t;
    }
}

fn main() {}
