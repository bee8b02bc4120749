use qrt::prelude::*;

#[reversible]
fn twice(a: &mut UInt<4>) {
    by_hand(&mut a);
}

/// What nobody knows how to undo.
fn by_hand<M: Machine>(machine: &mut M, a: &mut Reg<M::Register, UInt<4>>) {
    machine.xor_into(a.register_mut(), Operand::Constant(1), None);
}

fn main() {}
