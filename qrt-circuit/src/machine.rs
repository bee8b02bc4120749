//! Machines that run reversible code.
//!
//! Code that the macros generate is a straight line of calls of a [`Machine`], one for each
//! [`super::Instruction`] of its program. On a [`super::Recorder`] the calls yield that program. On
//! a machine that holds numbers they compute with them: `rustc` compiles and inlines the calls, and
//! no list of operations is interpreted.

use super::{Bit, BlockId, Multiples, Op, Operand, RegisterId, Style, Tag, Type, When, Word};
use std::sync::Arc;

/// The declaration of a register in code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Declaration {
    /// The register's index in the program's list; `None` for a register that joins the list when
    /// it is computed.
    pub id: Option<RegisterId>,
    /// If this register is an operation's first target: the index of the operation's garbage register.
    /// `None` if that has no place in the program's list.
    pub scratch: Option<RegisterId>,
    /// The style of the operation whose first target this register is; `None` for the machine's.
    pub style: Option<Style>,
    /// The register's name.
    pub name: &'static str,
    /// The meaning of the register's bits.
    pub ty: Type,
    /// The tag by which the program's author finds the register again.
    pub tag: Tag,
    /// Number of qubits of the register.
    pub width: u32,
    /// The block whose operation computes the register.
    pub block: BlockId,
    /// The least and the greatest number that the register holds, in units of its lowest bit, if
    /// known.
    pub range: Option<[i64; 2]>,
}

impl Declaration {
    /// Declares a work register, without a place in the program's list.
    ///
    /// # Panics
    /// If it has more than 64 bits and is not garbage; in a constant, that is a compile error.
    pub const fn work(name: &'static str, ty: Type, width: u32) -> Self {
        let scratch = matches!(ty, Type::Scratch);
        assert!(width <= 64 || scratch, "a register has at most 64 bits");
        Self {
            id: None,
            scratch: None,
            style: None,
            name,
            ty,
            tag: Tag(0),
            width,
            block: BlockId::ROOT,
            range: None,
        }
    }

    /// Declares a register that has a place in the program's list.
    pub const fn at(id: u32, name: &'static str, ty: Type, tag: Tag, width: u32) -> Self {
        Self {
            id: Some(RegisterId(id)),
            tag,
            ..Self::work(name, ty, width)
        }
    }

    /// Returns the same declaration, computed by an operation of this block.
    pub const fn block(self, block: u32) -> Self {
        Self {
            block: BlockId(block),
            ..self
        }
    }

    /// Returns the same declaration, of a register that holds numbers from `low` to `high`, in
    /// units of its lowest bit.
    pub const fn range(self, low: i64, high: i64) -> Self {
        Self {
            range: Some([low, high]),
            ..self
        }
    }

    /// Returns the same declaration, as the first target of an operation whose garbage is in
    /// register number `scratch`.
    pub const fn scratch(self, scratch: u32) -> Self {
        Self {
            scratch: Some(RegisterId(scratch)),
            ..self
        }
    }

    /// Returns the same declaration, as the first target of an operation that is lowered in this style.
    pub const fn style(self, style: Style) -> Self {
        Self {
            style: Some(style),
            ..self
        }
    }

    /// True if the register's top bit is a sign.
    #[inline(always)]
    pub const fn signed(&self) -> bool {
        matches!(self.ty, Type::Int | Type::Fixed { .. })
    }
}

/// A call of reversible code to a [`Machine`].
#[derive(Debug)]
pub enum Call<'a, R> {
    /// An operation. The machine decides on its garbage and on its lowering: the register declared
    /// for the garbage is a placeholder.
    Compute(Op<&'a R, &'a Declaration>),
    /// The inverse of the operation that computed these registers, all of them and no others, in
    /// its order. If no operation computed them, nothing happens.
    Undo(&'a [R]),
    /// Charges the following calls to this block.
    Block(BlockId),
}

/// A machine that runs reversible code.
///
/// An implementation needs [`Machine::call`] alone. All other methods are provided: one for each
/// [`Op`], of the same name, whose documentation defines the result; `t` declares its target.
/// Operations return their targets, which belong to the caller until [`Machine::undo`] returns
/// them. A register can be read by reference any number of times, and be undone once.
///
/// Code that the macros generate is a straight line of calls of these methods. On a
/// [`super::Recorder`] it yields a program; on a machine that holds numbers it computes with them.
/// An operation's inverse must find its operands as the operation found them. Generated code
/// ensures that; `#[reversible]` checks code written by hand.
pub trait Machine {
    /// A register: a handle on a result that is not yet undone.
    type Register;

    /// Executes a call. Returns the registers that an out-of-place operation computes, in their
    /// order, and nothing else.
    fn call(&mut self, call: Call<'_, Self::Register>) -> Vec<Self::Register>;

    /// Returns the conjunction of a bit and the condition under which this machine's registers
    /// change. The caller undoes it. `None` if they change on every path. See
    /// [`super::controlled`].
    fn joined(&mut self, _when: Bit<&Self::Register>) -> Option<Self::Register> {
        None
    }
    /// Marks the beginning or the end of a part that the code after it undoes, and that therefore
    /// needs no condition. See [`super::unconditional`].
    fn unconditional(&mut self, _entered: bool) {}

    /// Charges the following calls to this block.
    fn block(&mut self, block: BlockId) {
        self.call(Call::Block(block));
    }
    /// Allocates a work register that holds 0. An operation without gates computes it, so that its
    /// qubits have an owner.
    fn zero(&mut self, t: &Declaration) -> Self::Register {
        self.add(t, Operand::Constant(0), Operand::Constant(0))
    }
    /// Frees a work register that holds 0 again.
    fn free(&mut self, register: Self::Register) {
        self.undo([register]);
    }
    /// Runs the inverse of the operation that computed these registers: see [`Call::Undo`].
    fn undo<const N: usize>(&mut self, computed: [Self::Register; N]) {
        self.call(Call::Undo(&computed));
    }

    /// [`Op::Copy`]
    fn copy(&mut self, t: &Declaration, a: Word<&Self::Register>) -> Self::Register {
        compute(self, Op::Copy { a, target: t })
    }
    /// [`Op::Load`]
    fn load(&mut self, t: &Declaration, parameter: u32) -> Self::Register {
        compute(
            self,
            Op::Load {
                parameter,
                target: t,
            },
        )
    }
    /// [`Op::Parity`]
    fn parity(
        &mut self,
        t: &Declaration,
        source: &Self::Register,
        columns: &[u64],
        parameter: Option<u32>,
    ) -> Self::Register {
        compute(
            self,
            Op::Parity {
                source,
                columns: columns.into(),
                parameter,
                target: t,
            },
        )
    }
    /// [`Op::And`]
    fn and(
        &mut self,
        t: &Declaration,
        a: Bit<&Self::Register>,
        b: Bit<&Self::Register>,
    ) -> Self::Register {
        compute(self, Op::And { a, b, target: t })
    }
    /// [`Op::Xor`]
    fn xor(
        &mut self,
        t: &Declaration,
        a: Bit<&Self::Register>,
        b: Bit<&Self::Register>,
    ) -> Self::Register {
        compute(self, Op::Xor { a, b, target: t })
    }
    /// [`Op::Add`], not subtracting.
    fn add(
        &mut self,
        t: &Declaration,
        a: Operand<&Self::Register>,
        b: Operand<&Self::Register>,
    ) -> Self::Register {
        compute(
            self,
            Op::Add {
                a,
                b,
                subtract: false,
                target: t,
            },
        )
    }
    /// [`Op::Add`], subtracting.
    fn subtract(
        &mut self,
        t: &Declaration,
        a: Operand<&Self::Register>,
        b: Operand<&Self::Register>,
    ) -> Self::Register {
        compute(
            self,
            Op::Add {
                a,
                b,
                subtract: true,
                target: t,
            },
        )
    }
    /// [`Op::Negate`]
    fn negate(
        &mut self,
        t: &Declaration,
        a: Word<&Self::Register>,
        when: Bit<&Self::Register>,
    ) -> Self::Register {
        compute(self, Op::Negate { a, when, target: t })
    }
    /// [`Op::Select`]
    fn select(
        &mut self,
        t: &Declaration,
        when: Bit<&Self::Register>,
        a: Operand<&Self::Register>,
        b: Operand<&Self::Register>,
    ) -> Self::Register {
        compute(
            self,
            Op::Select {
                when,
                a,
                b,
                target: t,
            },
        )
    }
    /// [`Op::Less`]
    fn less(
        &mut self,
        t: &Declaration,
        a: Operand<&Self::Register>,
        b: Operand<&Self::Register>,
    ) -> Self::Register {
        compute(self, Op::Less { a, b, target: t })
    }
    /// [`Op::Multiply`]
    fn multiply(
        &mut self,
        t: &Declaration,
        a: Word<&Self::Register>,
        b: Word<&Self::Register>,
        drop: u32,
    ) -> Self::Register {
        compute(
            self,
            Op::Multiply {
                a,
                b,
                drop,
                style: STYLE,
                target: t,
                scratch: &GARBAGE,
            },
        )
    }
    /// [`Op::Square`]
    fn square(&mut self, t: &Declaration, a: Word<&Self::Register>, drop: u32) -> Self::Register {
        compute(
            self,
            Op::Square {
                a,
                drop,
                style: STYLE,
                target: t,
                scratch: &GARBAGE,
            },
        )
    }
    /// [`Op::Scale`]
    fn scale(
        &mut self,
        t: &Declaration,
        a: Word<&Self::Register>,
        factor: i64,
        drop: u32,
    ) -> Self::Register {
        compute(
            self,
            Op::Scale {
                a,
                factor,
                drop,
                style: STYLE,
                target: t,
                scratch: &GARBAGE,
            },
        )
    }
    /// [`Op::Multiples`]
    fn multiples<const N: usize>(
        &mut self,
        targets: [&Declaration; N],
        a: Word<&Self::Register>,
        products: &Arc<Multiples>,
    ) -> [Self::Register; N] {
        compute_all(
            self,
            Op::Multiples {
                a,
                products: products.clone(),
                targets: targets.into(),
                scratch: &GARBAGE,
            },
        )
    }
    /// [`Op::Divide`]: the quotient, and whether it fits.
    fn divide(
        &mut self,
        quotient: &Declaration,
        fits: &Declaration,
        a: Word<&Self::Register>,
        b: Word<&Self::Register>,
    ) -> [Self::Register; 2] {
        compute_all(
            self,
            Op::Divide {
                a,
                b,
                style: STYLE,
                quotient,
                fits,
                scratch: &GARBAGE,
            },
        )
    }
    /// [`Op::SquareRoot`]
    fn square_root(&mut self, t: &Declaration, a: Word<&Self::Register>) -> Self::Register {
        compute(
            self,
            Op::SquareRoot {
                a,
                style: STYLE,
                target: t,
                scratch: &GARBAGE,
            },
        )
    }
    /// [`Op::Table`]. The `low` lowest address bits select among words read together, if there is
    /// garbage to hold these words. An address beyond the columns may not occur.
    fn table<const N: usize>(
        &mut self,
        targets: [&Declaration; N],
        address: &[Bit<&Self::Register>],
        columns: [&[i64]; N],
        low: u32,
    ) -> [Self::Register; N] {
        compute_all(
            self,
            Op::Table {
                address: address
                    .iter()
                    .map(|bit| bit.map_register(|register| register))
                    .collect(),
                columns: columns.iter().map(|&column| column.into()).collect(),
                low,
                style: STYLE,
                targets: targets.into(),
                scratch: &GARBAGE,
            },
        )
    }
    /// [`Op::Encode`]
    ///
    /// # Panics
    /// If there is not one entry for each bit, if the targets differ in width, or if the top bit of an entry
    /// is not the top bit of the targets.
    fn encode<const N: usize>(
        &mut self,
        targets: [&Declaration; N],
        bits: &[Bit<&Self::Register>],
        entries: &[u64],
    ) -> [Self::Register; N] {
        let width = targets.first().map_or(0, |target| target.width);
        let is_wide = |entry: &u64| 64 - entry.leading_zeros() == width;
        assert!(
            bits.len() == entries.len()
                && targets.iter().all(|target| target.width == width)
                && entries.iter().all(is_wide),
            "an encoder has one entry for each bit, with its top bit at the top of each target"
        );
        compute_all(
            self,
            Op::Encode {
                bits: bits
                    .iter()
                    .map(|bit| bit.map_register(|register| register))
                    .collect(),
                entries: entries.into(),
                targets: targets.into(),
                scratch: &GARBAGE,
            },
        )
    }

    /// [`Op::XorInto`]
    fn xor_into(
        &mut self,
        t: &mut Self::Register,
        a: Operand<&Self::Register>,
        when: Option<Bit<&Self::Register>>,
    ) {
        self.call(Call::Compute(Op::XorInto { a, when, target: t }));
    }
    /// [`Op::AddInto`], or its inverse.
    fn add_into(
        &mut self,
        t: &mut Self::Register,
        a: Operand<&Self::Register>,
        subtract: bool,
        when: When<&Self::Register>,
    ) {
        self.call(Call::Compute(Op::AddInto {
            a,
            subtract,
            when,
            target: t,
        }));
    }
    /// [`Op::Swap`]
    fn swap(
        &mut self,
        a: &mut Self::Register,
        b: &mut Self::Register,
        when: Option<Bit<&Self::Register>>,
    ) {
        self.call(Call::Compute(Op::Swap { a, b, when }));
    }
}

/// Placeholders for an operation's garbage and for its style, until a machine decides on them.
const GARBAGE: Declaration = Declaration::work("scratch", Type::Scratch, 0);
const STYLE: Style = Style::OutOfPlace;

fn compute<M: Machine + ?Sized>(
    machine: &mut M,
    op: Op<&M::Register, &Declaration>,
) -> M::Register {
    let [target] = compute_all(machine, op);
    target
}

fn compute_all<M: Machine + ?Sized, const N: usize>(
    machine: &mut M,
    op: Op<&M::Register, &Declaration>,
) -> [M::Register; N] {
    match machine.call(Call::Compute(op)).try_into() {
        Ok(targets) => targets,
        Err(_) => unreachable!("a machine returns an operation's targets, each once"),
    }
}

impl<R> Word<R> {
    /// Reads the bits `offset .. offset + width`, as an unsigned number.
    #[inline(always)]
    pub const fn unsigned(register: R, offset: u32, width: u32) -> Self {
        Self {
            register,
            offset,
            width,
            signed: false,
            shift: 0,
        }
    }

    /// Reads the bits `offset .. offset + width`, of which the top one is the sign.
    #[inline(always)]
    pub const fn signed(register: R, offset: u32, width: u32) -> Self {
        Self {
            register,
            offset,
            width,
            signed: true,
            shift: 0,
        }
    }

    /// Returns the same bits with `shift` zeros below: the number times `2^shift`.
    #[inline(always)]
    pub fn shifted(self, shift: u32) -> Self {
        Self { shift, ..self }
    }
}

impl<R> Bit<R> {
    /// Reads bit number `index`; 0 is the least significant.
    #[inline(always)]
    pub const fn at(register: R, index: u32) -> Self {
        Self {
            register,
            index,
            inverted: false,
        }
    }

    /// Returns the negation of the bit.
    #[inline(always)]
    pub fn inverted(self) -> Self {
        Self {
            inverted: !self.inverted,
            ..self
        }
    }
}

impl<R> Operand<R> {
    /// [`Word::unsigned`]
    #[inline(always)]
    pub const fn unsigned(register: R, offset: u32, width: u32) -> Self {
        Self::Word(Word::unsigned(register, offset, width))
    }

    /// [`Word::signed`]
    #[inline(always)]
    pub const fn signed(register: R, offset: u32, width: u32) -> Self {
        Self::Word(Word::signed(register, offset, width))
    }
}

impl<R> From<Word<R>> for Operand<R> {
    #[inline(always)]
    fn from(word: Word<R>) -> Self {
        Self::Word(word)
    }
}
