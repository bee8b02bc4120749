use qrt::prelude::*;

const SQUARES: [u32; 4] = [0, 1, 4, 9];

#[reversible]
fn longer(k: &UInt<3>, c: &mut UInt<4>) {
    c += SQUARES[k];
}

#[reversible]
fn shorter(k: &Bool, c: &mut UInt<4>) {
    c ^= SQUARES[k];
    c += SQUARES[4];
}

const DIFFERENCES: [i32; 4] = [1, -1, 1, -1];

#[reversible]
fn negative(k: &UInt<2>, c: &mut UInt<4>) {
    c += DIFFERENCES[k];
}

fn main() {}
