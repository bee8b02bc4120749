//! Operations: what they compute, as integers.

use super::{Bit, Operand, RegisterId, Word};
use std::sync::Arc;

/// An operation of a [`super::Program`].
///
/// Most compute into *targets* that are zero before: out of place. The inverse returns such a
/// target to zero, given the same operands; it is not asked what it makes of anything else. The
/// others, at the end of the list, change a register in place, and their inverses are exact for
/// every content.
///
/// Numbers are those of [`Word::read`]. Targets hold a result's lowest bits: `w` stands for the
/// target's width and "mod 2^w" for what fits. All operands, and all results before they are cut
/// to their target, lie within 63 bits, products within 126.
///
/// A target never overlaps an operand. `scratch` registers are computed beside the target and
/// returned to zero with it; their content is the lowering's own affair. Their width is
/// `lower::scratch_width`.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Op {
    /// `t = a mod 2^w`
    Copy {
        /// What is copied.
        a: Word,
        /// t
        target: RegisterId,
    },
    /// `t = parameter`: a classical word that the pixel decides.
    Load {
        /// Its place in the program's list.
        parameter: u32,
        /// t
        target: RegisterId,
    },
    /// `t = parameter ^ XOR_b source_b columns[b]`, over the bits b of `source`: a linear map over
    /// GF(2), shifted.
    Parity {
        /// The id register.
        source: RegisterId,
        /// By bit of the source: the bits of t that it flips.
        columns: Arc<[u64]>,
        /// The pixel's shift, if there is one: its place in the program's list.
        parameter: Option<u32>,
        /// t
        target: RegisterId,
    },
    /// `t = a and b`
    And {
        /// The one.
        a: Bit,
        /// The other.
        b: Bit,
        /// t: one bit.
        target: RegisterId,
    },
    /// `t = a xor b`
    Xor {
        /// The one.
        a: Bit,
        /// The other.
        b: Bit,
        /// t: one bit.
        target: RegisterId,
    },
    /// `t = a + b mod 2^w`, or `a - b mod 2^w`.
    Add {
        /// The first.
        a: Operand,
        /// The second.
        b: Operand,
        /// Is b subtracted?
        subtract: bool,
        /// t
        target: RegisterId,
    },
    /// `t = if when { -a } else { a } mod 2^w`
    Negate {
        /// The number.
        a: Word,
        /// The condition.
        when: Bit,
        /// t
        target: RegisterId,
    },
    /// `t = if when { a } else { b } mod 2^w`
    Select {
        /// The condition.
        when: Bit,
        /// Where it holds.
        a: Operand,
        /// Where it does not.
        b: Operand,
        /// t
        target: RegisterId,
    },
    /// `t = a < b`, leaving nothing behind.
    Less {
        /// The one.
        a: Operand,
        /// The other.
        b: Operand,
        /// t: one bit.
        target: RegisterId,
    },
    /// `t = floor(a b / 2^drop) mod 2^w`
    Multiply {
        /// The first factor: its bits choose the rows.
        a: Word,
        /// The second factor.
        b: Word,
        /// Bits dropped below.
        drop: u32,
        /// How it is lowered.
        style: Style,
        /// t
        target: RegisterId,
        /// What is left behind.
        scratch: RegisterId,
    },
    /// `t = floor(a^2 / 2^drop) mod 2^w`
    Square {
        /// The number.
        a: Word,
        /// Bits dropped below.
        drop: u32,
        /// How it is lowered.
        style: Style,
        /// t
        target: RegisterId,
        /// What is left behind.
        scratch: RegisterId,
    },
    /// `t = floor(factor a / 2^drop) mod 2^w`, for a constant factor other than 0.
    Scale {
        /// The number.
        a: Word,
        /// The factor.
        factor: i64,
        /// Bits dropped below.
        drop: u32,
        /// How it is lowered.
        style: Style,
        /// t
        target: RegisterId,
        /// What is left behind.
        scratch: RegisterId,
    },
    /// `f = a < b 2^n`, and `q = floor(a' / b)`, where n is q's width and `a'` is a where f holds
    /// and 0 where it does not; `q = 2^n - 1` where b is 0. Both operands are unsigned.
    Divide {
        /// The dividend.
        a: Word,
        /// The divisor.
        b: Word,
        /// How it is lowered.
        style: Style,
        /// q
        quotient: RegisterId,
        /// f: one bit.
        fits: RegisterId,
        /// What is left behind.
        scratch: RegisterId,
    },
    /// `t = floor(sqrt(a)) mod 2^w`, for an unsigned a.
    SquareRoot {
        /// The number.
        a: Word,
        /// How it is lowered.
        style: Style,
        /// t
        target: RegisterId,
        /// What is left behind.
        scratch: RegisterId,
    },
    /// `t_k = columns[k][address] mod 2^w_k`: a QROM of `columns[k].len()` entries, the same number
    /// for all k. An address beyond them reads what suits the lowering; it may not occur.
    Table {
        /// Bits of the address, the least significant first.
        address: Box<[Bit]>,
        /// Entries by column.
        columns: Arc<[Box<[i64]>]>,
        /// Of the address bits, how many of the lowest select among words read together, under
        /// [`Style::Wide`].
        low: u32,
        /// How it is lowered.
        style: Style,
        /// t_k
        targets: Box<[RegisterId]>,
        /// What is left behind.
        scratch: RegisterId,
    },

    /// `t ^= a mod 2^w`, where `when` holds. In place, and its own inverse.
    XorInto {
        /// What is added over GF(2).
        a: Operand,
        /// The condition, if there is one.
        when: Option<Bit>,
        /// t
        target: RegisterId,
    },
    /// `t += a mod 2^w` or `t -= a mod 2^w`. In place.
    AddInto {
        /// What is added.
        a: Operand,
        /// Is it subtracted?
        subtract: bool,
        /// The condition, if there is one.
        when: When,
        /// t
        target: RegisterId,
    },
    /// `(a, b) = (b, a)` where `when` holds; both of one width. In place, and its own inverse.
    Swap {
        /// The one.
        a: RegisterId,
        /// The other.
        b: RegisterId,
        /// The condition, if there is one.
        when: Option<Bit>,
    },
    /// The sign of a basis state's amplitude, where `bit` holds: a Z. Its own inverse.
    Phase {
        /// The condition.
        bit: Bit,
    },
}

/// When an addition in place happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum When<R = RegisterId> {
    /// On every path.
    Always,
    /// Where the bit holds; nothing happens elsewhere.
    If(Bit<R>),
    /// Everywhere, but where the bit holds the sign is turned: an addition subtracts.
    Reversed(Bit<R>),
}

/// How the operations that leave something behind are lowered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Style {
    /// Partial sums out of place: fewest gates, most scratch.
    #[default]
    Wide,
    /// Partial sums in place: least scratch, up to twice the gates.
    Lean,
}

impl Op {
    /// Registers that are zero before it and hold its results after it, scratch included; none for
    /// an operation in place.
    pub fn fresh(&self) -> Vec<RegisterId> {
        let mut fresh = self.targets();
        fresh.extend(self.scratch());
        fresh
    }

    /// Registers that hold its results, out of place.
    pub fn targets(&self) -> Vec<RegisterId> {
        match self {
            Self::Copy { target, .. }
            | Self::Load { target, .. }
            | Self::Parity { target, .. }
            | Self::And { target, .. }
            | Self::Xor { target, .. }
            | Self::Add { target, .. }
            | Self::Negate { target, .. }
            | Self::Select { target, .. }
            | Self::Less { target, .. }
            | Self::Multiply { target, .. }
            | Self::Square { target, .. }
            | Self::Scale { target, .. }
            | Self::SquareRoot { target, .. } => vec![*target],
            Self::Divide { quotient, fits, .. } => vec![*quotient, *fits],
            Self::Table { targets, .. } => targets.to_vec(),
            Self::XorInto { .. }
            | Self::AddInto { .. }
            | Self::Swap { .. }
            | Self::Phase { .. } => Vec::new(),
        }
    }

    /// The register of what it leaves behind.
    pub fn scratch(&self) -> Option<RegisterId> {
        match self {
            Self::Multiply { scratch, .. }
            | Self::Square { scratch, .. }
            | Self::Scale { scratch, .. }
            | Self::Divide { scratch, .. }
            | Self::SquareRoot { scratch, .. }
            | Self::Table { scratch, .. } => Some(*scratch),
            _ => None,
        }
    }

    /// What it is called.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Copy { .. } => "copy",
            Self::Load { .. } => "load",
            Self::Parity { .. } => "parity",
            Self::And { .. } => "and",
            Self::Xor { .. } => "xor",
            Self::Add { .. } => "add",
            Self::Negate { .. } => "negate",
            Self::Select { .. } => "select",
            Self::Less { .. } => "less",
            Self::Multiply { .. } => "multiply",
            Self::Square { .. } => "square",
            Self::Scale { .. } => "scale",
            Self::Divide { .. } => "divide",
            Self::SquareRoot { .. } => "square_root",
            Self::Table { .. } => "table",
            Self::XorInto { .. } => "xor_into",
            Self::AddInto { .. } => "add_into",
            Self::Swap { .. } => "swap",
            Self::Phase { .. } => "phase",
        }
    }

    /// Calls `rename` on every register that the operation reads or changes in place (`false`) or
    /// computes (`true`).
    pub fn rename(&mut self, mut rename: impl FnMut(&mut RegisterId, bool)) {
        match self {
            Self::Copy { a, target } => {
                rename(&mut a.register, false);
                rename(target, true);
            }
            Self::Load { target, .. } => rename(target, true),
            Self::Parity { source, target, .. } => {
                rename(source, false);
                rename(target, true);
            }
            Self::And { a, b, target } | Self::Xor { a, b, target } => {
                rename(&mut a.register, false);
                rename(&mut b.register, false);
                rename(target, true);
            }
            Self::Add { a, b, target, .. } | Self::Less { a, b, target } => {
                rename_operand(a, &mut rename);
                rename_operand(b, &mut rename);
                rename(target, true);
            }
            Self::Negate { a, when, target } => {
                rename(&mut a.register, false);
                rename(&mut when.register, false);
                rename(target, true);
            }
            Self::Select { when, a, b, target } => {
                rename(&mut when.register, false);
                rename_operand(a, &mut rename);
                rename_operand(b, &mut rename);
                rename(target, true);
            }
            Self::Multiply {
                a,
                b,
                target,
                scratch,
                ..
            } => {
                rename(&mut a.register, false);
                rename(&mut b.register, false);
                rename(target, true);
                rename(scratch, true);
            }
            Self::Square {
                a, target, scratch, ..
            }
            | Self::Scale {
                a, target, scratch, ..
            }
            | Self::SquareRoot {
                a, target, scratch, ..
            } => {
                rename(&mut a.register, false);
                rename(target, true);
                rename(scratch, true);
            }
            Self::Divide {
                a,
                b,
                quotient,
                fits,
                scratch,
                ..
            } => {
                rename(&mut a.register, false);
                rename(&mut b.register, false);
                rename(quotient, true);
                rename(fits, true);
                rename(scratch, true);
            }
            Self::Table {
                address,
                targets,
                scratch,
                ..
            } => {
                for bit in address {
                    rename(&mut bit.register, false);
                }
                for target in targets {
                    rename(target, true);
                }
                rename(scratch, true);
            }
            Self::XorInto { a, when, target } => {
                rename_operand(a, &mut rename);
                if let Some(bit) = when {
                    rename(&mut bit.register, false);
                }
                rename(target, false);
            }
            Self::AddInto {
                a, when, target, ..
            } => {
                rename_operand(a, &mut rename);
                if let When::If(bit) | When::Reversed(bit) = when {
                    rename(&mut bit.register, false);
                }
                rename(target, false);
            }
            Self::Swap { a, b, when } => {
                rename(a, false);
                rename(b, false);
                if let Some(bit) = when {
                    rename(&mut bit.register, false);
                }
            }
            Self::Phase { bit } => rename(&mut bit.register, false),
        }
    }

    /// Registers that it reads or changes in place.
    pub fn reads(&self) -> Vec<RegisterId> {
        let mut reads = Vec::new();
        self.clone().rename(|register, computed| {
            if !computed {
                reads.push(*register);
            }
        });
        reads
    }
}

fn rename_operand(operand: &mut Operand, rename: &mut impl FnMut(&mut RegisterId, bool)) {
    if let Operand::Word(word) = operand {
        rename(&mut word.register, false);
    }
}
