use qrt::prelude::*;

#[reversible]
fn add<#[allow(unused)] const W: u32>(
    /// A number.
    a: &UInt<W>,
    #[allow(unused)] b: &mut UInt<W>,
) {
    #![allow(unused)]
    #[allow(unused)]
    within! {}
    #[allow(unused)]
    apply! {
        b += #[allow(unused)] a;
    }
}

fn main() {}
