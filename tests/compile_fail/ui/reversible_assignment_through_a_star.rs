use qrt::prelude::*;

#[reversible]
fn mark(a: &UInt<4>, out: &mut UInt<4>) {
    *out = *a;
}

fn main() {
    mark_program(Style::InPlace);
}
