//! Steps of operations in place, and of operations that are like them.

use super::arith::{Arg, Arith, Wrap};
use super::compile::{CUT, Compiler, kind_of, with_kind};
use super::lane::Kind;
use super::steps::{Step, StepLane};
use qrt_circuit::{Bit, Op, Operand, RegisterId, When, Word};

/// The operation of a step with two operands.
#[derive(Clone, Copy)]
pub(super) enum Pair {
    Add,
    Sub,
    Xor,
}

impl Compiler<'_> {
    /// Adds the steps of an operation in place, or of its inverse.
    pub(super) fn in_place(&mut self, op: &Op, inverse: bool) {
        match op {
            Op::XorInto { a, when, target } => {
                let (kind, old) = self.register(*target);
                with_kind!(kind, K => {
                    let a = self.operand::<K>(*a, kind);
                    self.pair(Pair::Xor, *target, Arg::Row(old), a);
                });
                self.only(*when, *target, old);
            }
            Op::AddInto {
                a,
                subtract,
                when,
                target,
            } => {
                let (kind, old) = self.register(*target);
                let pair = if *subtract == inverse {
                    Pair::Add
                } else {
                    Pair::Sub
                };
                with_kind!(kind, K => {
                    let a = match when {
                        When::Reversed(bit) => Arg::Row(self.negated::<K>(*a, *bit, kind, *target)),
                        When::Always | When::If(_) => self.operand::<K>(*a, kind),
                    };
                    self.pair(pair, *target, Arg::Row(old), a);
                });
                if let When::If(bit) = when {
                    self.only(Some(*bit), *target, old);
                }
            }
            Op::Swap { a, b, when } => {
                let [from_a, from_b] = [(*a, *b), (*b, *a)].map(|(from, to)| {
                    let (width, signed) = self.shape(to);
                    let word = Word {
                        register: from,
                        offset: 0,
                        width,
                        signed,
                        shift: 0,
                    };
                    self.word(word, kind_of(width, signed))
                });
                let [old_a, old_b] = [*a, *b].map(|register| self.register(register));
                self.registers[a.index()] = Some((old_a.0, from_b));
                self.registers[b.index()] = Some((old_b.0, from_a));
                self.only(*when, *a, old_a.1);
                self.only(*when, *b, old_b.1);
            }
            Op::Phase { bit } => {
                let turned = self.bit(*bit);
                let flip = bit.inverted;
                let old = self.sign.unwrap_or_else(|| self.constant(Kind::Truth, 0));
                let sign = self.step(|t| Step::Xor {
                    a: old,
                    b: turned,
                    flip,
                    t,
                });
                self.sign = Some(sign);
            }
            _ => {}
        }
    }

    /// Keeps the register's new value only where `when` is true; elsewhere the register gets `old`
    /// back.
    fn only(&mut self, when: Option<Bit>, register: RegisterId, old: u32) {
        let Some(when) = when else { return };
        let (kind, new) = self.register(register);
        let t = with_kind!(kind, K => {
            self.selected::<K>(when, Arg::Row(new), Arg::Row(old), register)
        });
        self.set(register, (kind, t), CUT);
    }

    /// Adds a step with two operands, whose lanes are of the target's kind.
    pub(super) fn pair<K: StepLane>(
        &mut self,
        pair: Pair,
        target: RegisterId,
        a: Arg<K>,
        b: Arg<K>,
    ) {
        let (width, signed) = self.shape(target);
        let wrap = Wrap::new(width, signed);
        let t = self.step(|t| {
            K::step(match pair {
                Pair::Add => Arith::Add { a, b, wrap, t },
                Pair::Sub => Arith::Sub { a, b, wrap, t },
                Pair::Xor => Arith::Xor { a, b, wrap, t },
            })
        });
        self.set(target, (kind_of(width, signed), t), CUT);
    }

    pub(super) fn selected<K: StepLane>(
        &mut self,
        bit: Bit,
        a: Arg<K>,
        b: Arg<K>,
        target: RegisterId,
    ) -> u32 {
        let when = self.bit(bit);
        let (a, b) = if bit.inverted { (b, a) } else { (a, b) };
        let (width, signed) = self.shape(target);
        let wrap = Wrap::new(width, signed);
        self.step(|t| {
            K::step(Arith::Select {
                when,
                a,
                b,
                wrap,
                t,
            })
        })
    }

    /// `if bit { -a } else { a }`, cut to the target.
    pub(super) fn negated<K: StepLane>(
        &mut self,
        a: Operand,
        bit: Bit,
        kind: Kind,
        target: RegisterId,
    ) -> u32 {
        match self.operand::<K>(a, kind) {
            Arg::Splat(a) => {
                let minus = K::cut(0).sub(a);
                self.selected(bit, Arg::Splat(minus), Arg::Splat(a), target)
            }
            Arg::Row(a) => {
                let when = self.bit(bit);
                let (width, signed) = self.shape(target);
                let wrap = Wrap::new(width, signed);
                self.step(|t| {
                    K::step(Arith::Negate {
                        when,
                        inverted: bit.inverted,
                        a,
                        wrap,
                        t,
                    })
                })
            }
        }
    }
}
