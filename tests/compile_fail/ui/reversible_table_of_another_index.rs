use qrt::prelude::*;

const SQUARES: [u32; 4] = [0, 1, 4, 9];

#[reversible]
fn square<const W: u32>(i: &Int<2>, w: &UInt<W>, k: &UInt<40>, c: &mut UInt<4>) {
    c += SQUARES[-1];
    c += SQUARES[i];
    c += SQUARES[w];
    c += SQUARES[k];
}

fn main() {}
