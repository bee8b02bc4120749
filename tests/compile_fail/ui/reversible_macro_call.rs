use qrt::prelude::*;

#[reversible]
fn show(a: &mut UInt<4>) {
    println!("{a}");
}

fn main() {}
