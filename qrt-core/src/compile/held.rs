//! Values in registers of their own, in the format that the caller specifies.

use super::value::{BoolValue, Index, RealValue};
use super::{Builder, Op, Operand, RegisterId, StageName, Type, Word};
use qrt_tracer::Segment;

impl<'a> Builder<'a> {
    /// The ray after `depth` bounces and its hit; none if no path has this ray.
    pub(crate) fn segment(&self, depth: usize) -> Option<Segment<Builder<'a>>> {
        self.segments.get(depth).copied()
    }

    /// Opens a block of the stage `name`. [`qrt_tracer::Arith::leave`] closes the block.
    pub(crate) fn enter_stage(&mut self, name: StageName) {
        self.begin(name, None);
    }

    /// Copies `a 2^shift`, in units in the last place and rounded down, to a register of its own.
    /// The register keeps the lowest `width` bits; the caller makes sure that the number fits.
    pub(crate) fn number_in(
        &mut self,
        a: RealValue,
        (ty, width): (Type, u32),
        shift: i32,
    ) -> RegisterId {
        let (operand, _) = self.operand(a);
        let operand = match operand {
            Operand::Constant(value) if shift < 0 => Operand::Constant(value >> (-shift).min(63)),
            Operand::Constant(value) => Operand::Constant(value << shift.min(62)),
            Operand::Word(word) => shifted(word, shift),
        };
        self.own(operand, (ty, width))
    }

    /// Copies the truth value to a register of its own.
    pub(crate) fn truth_in(&mut self, a: BoolValue) -> RegisterId {
        let target = (Type::Bool, 1);
        let BoolValue::Node { .. } = a else {
            let value = i64::from(a == BoolValue::Constant(true));
            return self.own(Operand::Constant(value), target);
        };
        let when = self.bit(a);
        let [a, b] = [1, 0].map(Operand::Constant);
        self.emit_anew(Op::Select { when, a, b, target })[0]
    }

    /// Copies the integer to a register of its own, of `width` bits.
    pub(crate) fn index_in(&mut self, a: Index, width: u32) -> RegisterId {
        let operand = self.choice_operand(a);
        self.own(operand, (Type::UInt, width))
    }

    /// Copies `operand` to a register that is not shared: two names never refer to one register.
    fn own(&mut self, operand: Operand, target: (Type, u32)) -> RegisterId {
        self.emit_anew(match operand {
            Operand::Word(a) => Op::Copy { a, target },
            constant @ Operand::Constant(_) => Op::Add {
                a: constant,
                b: Operand::Constant(0),
                subtract: false,
                target,
            },
        })[0]
    }
}

/// The number that `word` reads, times `2^by` and rounded down.
fn shifted(word: Word, by: i32) -> Operand {
    let shift = i64::from(word.shift) + i64::from(by);
    if let Ok(shift) = u32::try_from(shift) {
        return Operand::Word(Word { shift, ..word });
    }
    let dropped = u32::try_from(-shift).unwrap_or(u32::MAX);
    if dropped >= word.width && !word.signed {
        return Operand::Constant(0);
    }
    // A signed number keeps at least its sign bit.
    let dropped = dropped.min(word.width - 1);
    Operand::Word(Word {
        offset: word.offset + dropped,
        width: word.width - dropped,
        shift: 0,
        ..word
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_shifted_and_rounded_down() {
        for signed in [false, true] {
            for by in -12..12 {
                for shift in 0..3 {
                    let word = Word {
                        signed,
                        shift,
                        ..Word::unsigned(RegisterId(0), 2, 5)
                    };
                    for bits in 0..128_u64 {
                        let value = word.read(bits) as f64 * f64::from(by).exp2();
                        let read = match shifted(word, by) {
                            Operand::Word(word) => word.read(bits),
                            Operand::Constant(value) => value,
                        };
                        assert_eq!(read as f64, value.floor(), "{word:?} {by} {bits}");
                    }
                }
            }
        }
    }
}
