use qrt::prelude::*;

struct Squares<const W: u32>;

impl<const W: u32> Squares<W> {
    const TABLE: [u32; 4] = [0, 1, 4, 9];
}

impl Squares<4> {
    #[reversible]
    fn square(k: &UInt<2>, out: &mut UInt<4>) {
        out += Self::TABLE[k];
    }
}

#[reversible]
fn square<const W: u32>(k: &UInt<2>, out: &mut UInt<W>) {
    out += Squares::<W>::TABLE[k];
}

fn main() {}
