use qrt::prelude::*;

#[reversible]
fn mark(a: &UInt<4>, out: &mut UInt<4>) {
    let mut t: UInt<4> = 0;
    t ^= a;
    out += t;
}

fn main() {
    mark_program(Style::InPlace);
}
