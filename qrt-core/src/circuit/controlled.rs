//! Code under a condition.
//!
//! Only what changes a register in place needs to look at the condition. What is computed out of
//! place is undone within the same code, whether the condition holds or not.

use super::machine::{Declaration, Machine};
use super::{Bit, BlockId, Operand, Type, When, Word};

/// A machine whose registers change only where a bit holds; made by [`controlled`].
#[derive(Debug)]
pub struct Controlled<'a, M: Machine> {
    machine: &'a mut M,
    when: Bit<&'a M::Register>,
    /// Parts entered that are undone again by what follows, and need no condition.
    unconditional: u32,
}

/// Runs `branch` where `when` holds.
///
/// Within another branch the two conditions are ANDed once, for all of this one.
pub fn controlled<M: Machine>(
    machine: &mut M,
    when: Bit<&M::Register>,
    branch: impl FnOnce(&mut Controlled<'_, M>),
) {
    if let Some(both) = machine.joined(when) {
        machine.unconditional(true);
        branch(&mut Controlled {
            machine: &mut *machine,
            when: Bit::at(&both, 0),
            unconditional: 0,
        });
        machine.unconditional(false);
        machine.undo([both]);
    } else {
        branch(&mut Controlled {
            machine,
            when,
            unconditional: 0,
        });
    }
}

/// Runs a part that is undone again by what follows, so that no condition needs to be looked at.
pub fn unconditional<M: Machine>(machine: &mut M, part: impl FnOnce(&mut M)) {
    machine.unconditional(true);
    part(machine);
    machine.unconditional(false);
}

/// The conjunction of two conditions.
fn both() -> Declaration {
    Declaration::work("both", Type::Bool, 1)
}

impl<M: Machine> Controlled<'_, M> {
    /// Runs `update` with the conjunction of this machine's condition and another.
    fn under(
        &mut self,
        when: Option<Bit<&M::Register>>,
        update: impl FnOnce(&mut M, Option<Bit<&M::Register>>),
    ) {
        match when {
            _ if self.unconditional > 0 => update(self.machine, when),
            None => update(self.machine, Some(self.when)),
            Some(when) => {
                let both = self.machine.and(&both(), self.when, when);
                update(self.machine, Some(Bit::at(&both, 0)));
                self.machine.undo([both]);
            }
        }
    }
}

impl<M: Machine> Machine for Controlled<'_, M> {
    type Register = M::Register;

    fn zero(&mut self, t: &Declaration) -> M::Register {
        self.machine.zero(t)
    }

    fn free(&mut self, register: M::Register) {
        self.machine.free(register);
    }

    fn block(&mut self, block: BlockId) {
        self.machine.block(block);
    }

    fn joined(&mut self, when: Bit<&M::Register>) -> Option<M::Register> {
        (self.unconditional == 0).then(|| self.machine.and(&both(), self.when, when))
    }

    fn unconditional(&mut self, entered: bool) {
        if entered {
            self.unconditional += 1;
        } else {
            self.unconditional -= 1;
        }
    }

    fn copy(&mut self, t: &Declaration, a: Word<&M::Register>) -> M::Register {
        self.machine.copy(t, a)
    }

    fn load(&mut self, t: &Declaration, parameter: u32) -> M::Register {
        self.machine.load(t, parameter)
    }

    fn parity(
        &mut self,
        t: &Declaration,
        source: &M::Register,
        columns: &[u64],
        parameter: Option<u32>,
    ) -> M::Register {
        self.machine.parity(t, source, columns, parameter)
    }

    fn and(&mut self, t: &Declaration, a: Bit<&M::Register>, b: Bit<&M::Register>) -> M::Register {
        self.machine.and(t, a, b)
    }

    fn xor(&mut self, t: &Declaration, a: Bit<&M::Register>, b: Bit<&M::Register>) -> M::Register {
        self.machine.xor(t, a, b)
    }

    fn add(
        &mut self,
        t: &Declaration,
        a: Operand<&M::Register>,
        b: Operand<&M::Register>,
    ) -> M::Register {
        self.machine.add(t, a, b)
    }

    fn subtract(
        &mut self,
        t: &Declaration,
        a: Operand<&M::Register>,
        b: Operand<&M::Register>,
    ) -> M::Register {
        self.machine.subtract(t, a, b)
    }

    fn negate(
        &mut self,
        t: &Declaration,
        a: Word<&M::Register>,
        when: Bit<&M::Register>,
    ) -> M::Register {
        self.machine.negate(t, a, when)
    }

    fn select(
        &mut self,
        t: &Declaration,
        when: Bit<&M::Register>,
        a: Operand<&M::Register>,
        b: Operand<&M::Register>,
    ) -> M::Register {
        self.machine.select(t, when, a, b)
    }

    fn less(
        &mut self,
        t: &Declaration,
        a: Operand<&M::Register>,
        b: Operand<&M::Register>,
    ) -> M::Register {
        self.machine.less(t, a, b)
    }

    fn multiply(
        &mut self,
        t: &Declaration,
        a: Word<&M::Register>,
        b: Word<&M::Register>,
        drop: u32,
    ) -> M::Register {
        self.machine.multiply(t, a, b, drop)
    }

    fn square(&mut self, t: &Declaration, a: Word<&M::Register>, drop: u32) -> M::Register {
        self.machine.square(t, a, drop)
    }

    fn scale(
        &mut self,
        t: &Declaration,
        a: Word<&M::Register>,
        factor: i64,
        drop: u32,
    ) -> M::Register {
        self.machine.scale(t, a, factor, drop)
    }

    fn divide(
        &mut self,
        quotient: &Declaration,
        fits: &Declaration,
        a: Word<&M::Register>,
        b: Word<&M::Register>,
    ) -> [M::Register; 2] {
        self.machine.divide(quotient, fits, a, b)
    }

    fn square_root(&mut self, t: &Declaration, a: Word<&M::Register>) -> M::Register {
        self.machine.square_root(t, a)
    }

    fn table<const N: usize>(
        &mut self,
        targets: [&Declaration; N],
        address: &[Bit<&M::Register>],
        columns: [&[i64]; N],
        low: u32,
    ) -> [M::Register; N] {
        self.machine.table(targets, address, columns, low)
    }

    fn undo<const N: usize>(&mut self, computed: [M::Register; N]) {
        self.machine.undo(computed);
    }

    fn xor_into(
        &mut self,
        t: &mut M::Register,
        a: Operand<&M::Register>,
        when: Option<Bit<&M::Register>>,
    ) {
        self.under(when, |machine, when| machine.xor_into(t, a, when));
    }

    fn add_into(
        &mut self,
        t: &mut M::Register,
        a: Operand<&M::Register>,
        subtract: bool,
        when: When<&M::Register>,
    ) {
        let mut add = |when, subtract| {
            self.under(when, |machine, when| {
                let when = when.map_or(When::Always, When::If);
                machine.add_into(t, a, subtract, when);
            });
        };
        match when {
            When::Always => add(None, subtract),
            When::If(bit) => add(Some(bit), subtract),
            When::Reversed(bit) => {
                add(Some(bit.inverted()), subtract);
                add(Some(bit), !subtract);
            }
        }
    }

    fn swap(&mut self, a: &mut M::Register, b: &mut M::Register, when: Option<Bit<&M::Register>>) {
        self.under(when, |machine, when| machine.swap(a, b, when));
    }
}
