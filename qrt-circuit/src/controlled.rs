//! Code under a condition.
//!
//! Only operations that change a register in place read the condition. The results of out-of-place
//! operations are undone within the same code, whether the condition holds or not.

use super::machine::{Call, Declaration, Machine};
use super::{Bit, Op, Type, When};

/// A machine whose registers change only where a bit holds; made by [`controlled`].
#[derive(Debug)]
pub struct Controlled<'a, M: Machine> {
    machine: &'a mut M,
    when: Bit<&'a M::Register>,
    /// Number of entered parts that need no condition, because the code after them undoes them.
    unconditional: u32,
}

/// Runs `branch` where `when` holds.
///
/// Within another branch, the two conditions are ANDed once for all of this branch.
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

/// Runs `part` without a condition, because the code after it undoes it.
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

    fn call(&mut self, call: Call<'_, M::Register>) -> Vec<M::Register> {
        let Call::Compute(op) = call else {
            return self.machine.call(call);
        };
        match op {
            Op::XorInto { a, when, target } => self.under(when, |machine, when| {
                machine.call(Call::Compute(Op::XorInto { a, when, target }));
            }),
            Op::AddInto {
                a,
                subtract,
                when,
                target,
            } => {
                let mut add = |when, subtract| {
                    self.under(when, |machine, when| {
                        let when = when.map_or(When::Always, When::If);
                        machine.call(Call::Compute(Op::AddInto {
                            a,
                            subtract,
                            when,
                            target,
                        }));
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
            Op::Swap { a, b, when } => self.under(when, |machine, when| {
                machine.call(Call::Compute(Op::Swap { a, b, when }));
            }),
            Op::Phase { bit } => self.under(Some(bit), |machine, when| {
                let bit = when.unwrap_or(bit);
                machine.call(Call::Compute(Op::Phase { bit }));
            }),
            out_of_place => return self.machine.call(Call::Compute(out_of_place)),
        }
        Vec::new()
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
}

#[cfg(test)]
mod tests {
    use super::super::format::{Bool, Reg, UInt};
    use super::super::{Contents, Operand, Recorded, Recorder, Style};
    use super::*;

    type Number = Reg<Recorded, UInt<3>>;

    /// Runs a program of two conditions and a number, and returns the number `b` after it, for all
    /// contents of the three.
    fn all(code: impl Fn(&mut Recorder, [Bit<&Recorded>; 2], &mut Number)) -> Vec<u64> {
        let mut m = Recorder::new(Style::InPlace);
        let [p, q]: [Reg<_, Bool>; 2] = ["p", "q"].map(|name| Reg::input(&mut m, name));
        let mut b = Reg::input(&mut m, "b");
        code(
            &mut m,
            [&p, &q].map(|flag| Bit::at(flag.register(), 0)),
            &mut b,
        );
        let program = m.finish();
        let after = (0..32_u64).map(|state| {
            let inputs = [state & 1, state >> 1 & 1, state >> 2];
            let mut contents = Contents::new(&program, &inputs, &[]);
            for instruction in &program.instructions {
                contents.follow(&program, *instruction).unwrap();
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
        let mut m = Recorder::new(Style::InPlace);
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
