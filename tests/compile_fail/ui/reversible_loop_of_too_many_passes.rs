use qrt::prelude::*;

#[reversible]
fn twice(a: &UInt<4>, out: &mut UInt<8>) {
    for i in 0..20_000 {
        for j in 0..5_000 {
            out += a;
        }
    }
}

fn main() {
    twice_program(Style::InPlace);
}
