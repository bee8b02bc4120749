use qrt::prelude::*;

#[reversible]
fn add(n: u32, out: &mut UInt<4>) {
    out += 1;
}

fn main() {
    add_program(Style::InPlace);
}
