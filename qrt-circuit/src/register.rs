//! Registers, and the operands that operations read from them.

/// The index of a register in the list of a [`super::Program`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct RegisterId(pub u32);

impl RegisterId {
    /// The index in the program's list.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The meaning of a register's bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Type {
    /// One bit: a truth value.
    Bool,
    /// An unsigned integer.
    UInt,
    /// An integer in two's complement.
    Int,
    /// An unsigned number in units of `2^-fraction`.
    UFixed {
        /// Number of the register's bits after the point.
        fraction: u32,
    },
    /// A number in two's complement, in units of `2^-fraction`.
    Fixed {
        /// Number of the register's bits after the point.
        fraction: u32,
    },
    /// Garbage, which no other operation reads: carries, remainders, partial sums.
    Scratch,
}

impl Type {
    /// Returns the type as it is written for a register of `width` bits: `UInt<8>`, `Fixed<2, 14>`.
    pub fn name(self, width: u32) -> String {
        match self {
            Self::Bool => "Bool".to_owned(),
            Self::UInt => format!("UInt<{width}>"),
            Self::Int => format!("Int<{width}>"),
            Self::UFixed { fraction } => {
                format!(
                    "UFixed<{}, {fraction}>",
                    i64::from(width) - i64::from(fraction)
                )
            }
            Self::Fixed { fraction } => {
                format!(
                    "Fixed<{}, {fraction}>",
                    i64::from(width) - i64::from(fraction)
                )
            }
            Self::Scratch => format!("Scratch<{width}>"),
        }
    }
}

/// A number by which the author of a program finds a register or a block again. This crate never
/// reads it: it travels with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct Tag(pub u64);

/// A named, typed array of qubits. Bit 0 is the least significant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Register {
    /// The name that the author gave the register.
    pub name: String,
    /// The meaning of the register's bits.
    pub ty: Type,
    /// The tag by which the program's author finds the register again: a role, say.
    pub tag: Tag,
    /// Number of qubits of the register.
    pub width: u32,
    /// The block whose operation computes the register.
    pub block: BlockId,
    /// The least and the greatest number that the register holds, in units of its lowest bit, if
    /// proven.
    pub range: Option<[i64; 2]>,
}

impl Register {
    /// A register of the root block, without a tag or a known range.
    pub fn new(name: impl Into<String>, ty: Type, width: u32) -> Self {
        Self {
            name: name.into(),
            ty,
            tag: Tag(0),
            width,
            block: BlockId::ROOT,
            range: None,
        }
    }
}

/// The index of a block in the list of a [`super::Program`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BlockId(pub u32);

impl BlockId {
    /// The root block: the whole program.
    pub const ROOT: Self = Self(0);

    /// The index in the program's list.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A part of the program that has a name. Blocks form a tree; each instruction is charged to one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Block {
    /// The block around it; `None` for the root.
    pub parent: Option<BlockId>,
    /// The name that the author gave it.
    pub name: String,
    /// The tag by which the program's author finds the block again.
    pub tag: Tag,
}

/// Some bits of a register, read as an integer: the bits `offset .. offset + width`, extended by
/// zeros (or, if `signed`, by copies of the top one), times `2^shift`.
///
/// Shifts, truncation by floor, and sign extension are wiring, and cost nothing.
///
/// A program names its registers by `RegisterId`; code on a [`super::Machine`] borrows them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Word<R = RegisterId> {
    /// The register that is read.
    pub register: R,
    /// The first bit read, 0 the least significant.
    pub offset: u32,
    /// Number of bits read; above 0.
    pub width: u32,
    /// True if the top bit read is a sign.
    pub signed: bool,
    /// Number of zeros that follow below the bits read.
    pub shift: u32,
}

impl<R> Word<R> {
    /// Returns the same bits of a renamed register.
    #[inline(always)]
    pub fn map_register<S>(self, rename: impl FnOnce(R) -> S) -> Word<S> {
        Word {
            register: rename(self.register),
            offset: self.offset,
            width: self.width,
            signed: self.signed,
            shift: self.shift,
        }
    }

    /// Number of bits of the number, its sign and the zeros below included.
    pub fn bits(&self) -> u32 {
        self.width + self.shift
    }

    /// Returns the number that the word stands for, if `register` is the register's content.
    #[inline]
    pub fn read(&self, register: u64) -> i64 {
        let unused = 64 - self.width;
        let bits = (register >> self.offset) << unused;
        let value = if self.signed {
            bits.cast_signed() >> unused
        } else {
            (bits >> unused).cast_signed()
        };
        value << self.shift
    }

    /// Returns the least and the greatest number that the word can stand for.
    pub fn range(&self) -> [i64; 2] {
        let (low, high) = if self.signed {
            let half = 1_i64 << (self.width - 1);
            (-half, half - 1)
        } else {
            (0, i64::MAX >> (63 - self.width))
        };
        [low << self.shift, high << self.shift]
    }
}

/// One bit of a register, or its negation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Bit<R = RegisterId> {
    /// The register that is read.
    pub register: R,
    /// The bit that is read; 0 is the least significant.
    pub index: u32,
    /// True if the negation of the bit is read.
    pub inverted: bool,
}

impl<R> Bit<R> {
    /// Returns the same bit with a reference to its register.
    pub(crate) fn borrowed(&self) -> Bit<&R> {
        Bit {
            register: &self.register,
            index: self.index,
            inverted: self.inverted,
        }
    }

    /// Returns the same bit of a renamed register.
    #[inline(always)]
    pub fn map_register<S>(self, rename: impl FnOnce(R) -> S) -> Bit<S> {
        Bit {
            register: rename(self.register),
            index: self.index,
            inverted: self.inverted,
        }
    }

    /// Returns the truth value of the bit, if `register` is the register's content.
    #[inline]
    pub fn read(&self, register: u64) -> bool {
        (register >> self.index & 1 == 1) != self.inverted
    }
}

/// A number that an operation reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operand<R = RegisterId> {
    /// A number read from a register.
    Word(Word<R>),
    /// A constant, the same on every path.
    Constant(i64),
}

impl<R> Operand<R> {
    /// Returns the same number of a renamed register.
    #[inline(always)]
    pub fn map_register<S>(self, rename: impl FnOnce(R) -> S) -> Operand<S> {
        match self {
            Self::Word(word) => Operand::Word(word.map_register(rename)),
            Self::Constant(value) => Operand::Constant(value),
        }
    }
}
