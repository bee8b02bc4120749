use qrt::prelude::*;

#[reversible]
fn moving(x: &mut UInt<4>, out: &mut UInt<8>) {
    let mut square: UInt<8> = 0;
    within! { square += x * x; }
    apply! {
        out += square;
        x += 1;
    }
}

fn main() {}
