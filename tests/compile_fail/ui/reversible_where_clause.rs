use qrt::prelude::*;

#[reversible]
fn count<const W: u32>(a: &mut UInt<W>)
where
    u32: Copy,
{
    a += 1;
}

fn main() {}
