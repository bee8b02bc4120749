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

#[cfg(test)]
mod tests {
    use super::super::format::{Bool, Reg, UInt};
    use super::super::{Contents, Recorded, Recorder, Style};
    use super::*;

    type Number = Reg<Recorded, UInt<3>>;

    /// What `b` is after a program of two conditions and two numbers, of all contents of these.
    fn all(code: impl Fn(&mut Recorder, [Bit<&Recorded>; 2], &mut Number)) -> Vec<u64> {
        let mut m = Recorder::new(Style::Lean);
        let [p, q]: [Reg<_, Bool>; 2] = ["p", "q"].map(|name| Reg::input(&mut m, name));
        let mut b = Reg::input(&mut m, "b");
        code(
            &mut m,
            [&p, &q].map(|flag| Bit::at(flag.register(), 0)),
            &mut b,
        );
        let program = m.finish();
        let after = (0..32_u64).map(|state| {
            let mut contents = Contents {
                registers: vec![0; program.registers.len()],
                parameters: Vec::new(),
                widths: program.registers.iter().map(|r| r.width).collect(),
                negative: false,
            };
            let [p, q, b] = [state & 1, state >> 1 & 1, state >> 2];
            contents.registers[..3].copy_from_slice(&[p, q, b]);
            for instruction in &program.instructions {
                let op = &program.ops[instruction.op as usize];
                if instruction.inverse {
                    contents.uncompute(op);
                } else {
                    contents.compute(op);
                }
            }
            assert!(contents.registers[3..].iter().all(|bits| *bits == 0));
            contents.registers[2]
        });
        after.collect()
    }

    fn expected(change: impl Fn(bool, bool, u64) -> u64) -> Vec<u64> {
        let of = |state: u64| change(state & 1 == 1, state >> 1 & 1 == 1, state >> 2) % 8;
        (0..32).map(of).collect()
    }

    #[test]
    fn every_kind_of_addition_is_under_the_condition() {
        let three = Operand::Constant(3);
        let plain = all(|m, [p, q], b| {
            controlled(m, p, |m| {
                m.add_into(b.register_mut(), three, false, When::If(q.inverted()));
            });
        });
        assert_eq!(plain, expected(|p, q, b| b + if p && !q { 3 } else { 0 }));
        let turned = all(|m, [p, q], b| {
            controlled(m, p, |m| {
                m.add_into(b.register_mut(), three, false, When::Reversed(q));
            });
        });
        let by = |p, q| if p { if q { 5 } else { 3 } } else { 0 };
        assert_eq!(turned, expected(|p, q, b| b + by(p, q)));
    }

    #[test]
    fn conditions_within_conditions_are_joined_once() {
        let flips = all(|m, [p, q], b| {
            controlled(m, p, |m| {
                controlled(m, q.inverted(), |m| {
                    m.xor_into(b.register_mut(), Operand::Constant(1), None);
                    m.add_into(b.register_mut(), Operand::Constant(2), true, When::Always);
                });
                m.xor_into(b.register_mut(), Operand::Constant(4), None);
            });
        });
        let inner = |b: u64| (b ^ 1) + 6;
        assert_eq!(
            flips,
            expected(|p, q, b| match (p, q) {
                (false, _) => b,
                (true, true) => b ^ 4,
                (true, false) => (inner(b) % 8) ^ 4,
            })
        );
        let mut m = Recorder::new(Style::Lean);
        let [p, q]: [Reg<_, Bool>; 2] = ["p", "q"].map(|name| Reg::input(&mut m, name));
        let mut b: Reg<_, UInt<3>> = Reg::input(&mut m, "b");
        let [p, q] = [&p, &q].map(|flag| Bit::at(flag.register(), 0));
        controlled(&mut m, p, |m| {
            controlled(m, q, |m| {
                for _ in 0..5 {
                    m.xor_into(b.register_mut(), Operand::Constant(1), None);
                }
            });
        });
        let instructions = m.finish().instructions;
        let ands = instructions
            .iter()
            .filter(|instruction| instruction.op == 0);
        assert_eq!(ands.count(), 2, "computed once and undone once");
    }

    #[test]
    fn what_is_undone_needs_no_condition() {
        let unconditioned = all(|m, [p, _], b| {
            controlled(m, p, |m| {
                unconditional(m, |m| {
                    m.xor_into(b.register_mut(), Operand::Constant(1), None);
                });
            });
        });
        assert_eq!(unconditioned, expected(|_, _, b| b ^ 1));
    }
}
