use qrt::prelude::*;

struct Adder<const W: u32>;

#[reversible]
impl<const W: u32> Adder<W> {
    const SUM: u32 = W + 1;

    fn add(a: &UInt<W>, b: &mut UInt<{ Self::SUM + 1 }>) {
        b += a;
    }
}

fn main() {}
