use qrt::prelude::*;

#[reversible]
fn choose(a: &UInt<2>, b: &mut UInt<4>) {
    match a {
        _ => b += 1,
    }
}

fn main() {}
