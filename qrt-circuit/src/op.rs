//! Operations: each is declared once, with its operands, its results and its lowering's choices.
//!
//! A program, a recorder, a machine and the lowering take an operation's shape from the list below:
//! names, targets, garbage and renamings follow from it. [`super::Contents`] defines an operation's
//! result on integers; [`super::lower`] defines its gates.

use super::{Bit, Multiples, Operand, RegisterId, Word};
use std::fmt::Debug;
use std::sync::Arc;

/// A field that an operation reads, on registers of the type `R`.
trait Reads<R> {
    /// The same field on registers of the type `S`.
    type Of<S>;
    fn renamed<S>(self, rename: &mut impl FnMut(R) -> S) -> Self::Of<S>;
    fn each<'a>(&'a self, see: &mut dyn FnMut(&'a R));
    fn argument(&self) -> Argument<'_, R>;
}

/// A field of an operation, as an argument of the method of [`super::Machine`] that computes it.
#[derive(Clone, Copy, Debug)]
pub enum Argument<'a, R = RegisterId> {
    /// A whole register.
    Register(&'a R),
    /// A number read from a register.
    Word(&'a Word<R>),
    /// A bit of a register.
    Bit(&'a Bit<R>),
    /// Some bits, the least significant first.
    Bits(&'a [Bit<R>]),
    /// A number from a register, or a constant.
    Operand(&'a Operand<R>),
    /// The condition of a change in place.
    Condition(When<&'a R>),
    /// A constant, whose debug form is Rust code.
    Constant(&'a dyn Debug),
}

/// The condition of an addition in place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum When<R = RegisterId> {
    /// The change happens on every path.
    Always,
    /// The change happens where the bit holds; nothing happens elsewhere.
    If(Bit<R>),
    /// The change happens everywhere, but reversed where the bit holds: an addition subtracts.
    Reversed(Bit<R>),
}

/// The lowering of the operations that have garbage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Style {
    /// Partial sums out of place: fewest gates, most garbage.
    #[default]
    OutOfPlace,
    /// Partial sums in place: least garbage, up to twice the gates.
    InPlace,
}

impl<R> Reads<R> for Word<R> {
    type Of<S> = Word<S>;
    fn renamed<S>(self, rename: &mut impl FnMut(R) -> S) -> Word<S> {
        self.map_register(rename)
    }
    fn each<'a>(&'a self, see: &mut dyn FnMut(&'a R)) {
        see(&self.register);
    }
    fn argument(&self) -> Argument<'_, R> {
        Argument::Word(self)
    }
}

impl<R> Reads<R> for Bit<R> {
    type Of<S> = Bit<S>;
    fn renamed<S>(self, rename: &mut impl FnMut(R) -> S) -> Bit<S> {
        self.map_register(rename)
    }
    fn each<'a>(&'a self, see: &mut dyn FnMut(&'a R)) {
        see(&self.register);
    }
    fn argument(&self) -> Argument<'_, R> {
        Argument::Bit(self)
    }
}

impl<R> Reads<R> for Box<[Bit<R>]> {
    type Of<S> = Box<[Bit<S>]>;
    fn renamed<S>(self, rename: &mut impl FnMut(R) -> S) -> Box<[Bit<S>]> {
        self.into_iter()
            .map(|bit| bit.map_register(&mut *rename))
            .collect()
    }
    fn each<'a>(&'a self, see: &mut dyn FnMut(&'a R)) {
        for bit in self {
            see(&bit.register);
        }
    }
    fn argument(&self) -> Argument<'_, R> {
        Argument::Bits(self)
    }
}

impl<R> Reads<R> for Operand<R> {
    type Of<S> = Operand<S>;
    fn renamed<S>(self, rename: &mut impl FnMut(R) -> S) -> Operand<S> {
        self.map_register(rename)
    }
    fn each<'a>(&'a self, see: &mut dyn FnMut(&'a R)) {
        if let Self::Word(word) = self {
            see(&word.register);
        }
    }
    fn argument(&self) -> Argument<'_, R> {
        Argument::Operand(self)
    }
}

impl<R> Reads<R> for Option<Bit<R>> {
    type Of<S> = Option<Bit<S>>;
    fn renamed<S>(self, rename: &mut impl FnMut(R) -> S) -> Option<Bit<S>> {
        self.map(|bit| bit.map_register(rename))
    }
    fn each<'a>(&'a self, see: &mut dyn FnMut(&'a R)) {
        if let Some(bit) = self {
            see(&bit.register);
        }
    }
    fn argument(&self) -> Argument<'_, R> {
        Argument::Condition(match self {
            None => When::Always,
            Some(bit) => When::If(bit.borrowed()),
        })
    }
}

impl<R> Reads<R> for When<R> {
    type Of<S> = When<S>;
    fn renamed<S>(self, rename: &mut impl FnMut(R) -> S) -> When<S> {
        match self {
            Self::Always => When::Always,
            Self::If(bit) => When::If(bit.map_register(rename)),
            Self::Reversed(bit) => When::Reversed(bit.map_register(rename)),
        }
    }
    fn each<'a>(&'a self, see: &mut dyn FnMut(&'a R)) {
        if let Self::If(bit) | Self::Reversed(bit) = self {
            see(&bit.register);
        }
    }
    fn argument(&self) -> Argument<'_, R> {
        Argument::Condition(match self {
            Self::Always => When::Always,
            Self::If(bit) => When::If(bit.borrowed()),
            Self::Reversed(bit) => When::Reversed(bit.borrowed()),
        })
    }
}

/// Generates the code for a field, by its kind:
///
/// * `reads`: a number, a bit or a condition from registers; `register`: a whole register that is
///   read or changed in place;
/// * `target`, `targets`: zero before the operation; `garbage`: its intermediate results;
/// * `constant`: the same on all paths; `style`: how the operation is lowered.
macro_rules! field {
    (map reads $field:ident, $read:ident, $write:ident) => {
        $field.renamed(&mut $read)
    };
    (map register $field:ident, $read:ident, $write:ident) => {
        $read($field)
    };
    (map target $field:ident, $read:ident, $write:ident) => {
        $write($field)
    };
    (map garbage $field:ident, $read:ident, $write:ident) => {
        $write($field)
    };
    (map targets $field:ident, $read:ident, $write:ident) => {
        $field.into_iter().map(&mut $write).collect()
    };
    (map $constant:ident $field:ident, $read:ident, $write:ident) => {
        $field
    };

    (each reads $field:ident, $see:ident) => {
        $field.each($see)
    };
    (each register $field:ident, $see:ident) => {
        $see($field)
    };
    (each $other:ident $field:ident, $see:ident) => {
        let _ = $field;
    };

    (each_target target $field:ident, $see:ident) => {
        $see(*$field)
    };
    (each_target targets $field:ident, $see:ident) => {
        for target in $field {
            $see(*target);
        }
    };
    (each_target $other:ident $field:ident, $see:ident) => {
        let _ = $field;
    };

    (garbage garbage $field:ident, $found:ident) => {
        $found = Some($field)
    };
    (garbage $other:ident $field:ident, $found:ident) => {
        let _ = $field;
    };

    (style style $field:ident, $found:ident) => {
        $found = Some($field)
    };
    (style $other:ident $field:ident, $found:ident) => {
        let _ = $field;
    };

    (argument reads $field:ident, $all:ident) => {
        $all.push($field.argument())
    };
    (argument register $field:ident, $all:ident) => {
        $all.push(Argument::Register($field))
    };
    (argument constant $field:ident, $all:ident) => {
        $all.push(Argument::Constant($field))
    };
    (argument $other:ident $field:ident, $all:ident) => {
        let _ = $field;
    };
}

macro_rules! operations {
    (
        $(#[$op_doc:meta])*
        $( { $(#[$doc:meta])* $name:ident = $word:literal
            $( $(#[$field_doc:meta])* $kind:ident $field:ident: $ty:ty, )*
        } )*
    ) => {
        $(#[$op_doc])*
        #[derive(Clone, Debug, PartialEq, Eq, Hash)]
        pub enum Op<R = RegisterId, T = R> {
            $( $(#[$doc])* $name { $( $(#[$field_doc])* $field: $ty, )* }, )*
        }

        impl<R, T> Op<R, T> {
            /// Returns the operation's name, which is also the name of the method of
            /// [`super::Machine`] that computes it.
            pub fn name(&self) -> &'static str {
                match self { $( Self::$name { .. } => $word, )* }
            }

            /// Returns the same operation on other registers: `read` maps those that it reads or
            /// changes in place, then `write` maps those that it computes, garbage last.
            pub fn map<S, U>(
                self,
                mut read: impl FnMut(R) -> S,
                mut write: impl FnMut(T) -> U,
            ) -> Op<S, U> {
                // Some operations use only one of the two.
                let (_, _) = (&mut read, &mut write);
                match self {
                    $( Self::$name { $($field),* } => Op::$name {
                        $( $field: field!(map $kind $field, read, write), )*
                    }, )*
                }
            }

            /// Calls `see` with each register that the operation reads or changes in place.
            pub fn each_read<'a>(&'a self, see: &mut dyn FnMut(&'a R)) {
                match self {
                    $( Self::$name { $($field),* } => { $( field!(each $kind $field, see); )* } )*
                }
            }

            /// Returns the register of the operation's garbage. `None` if it has none.
            pub fn scratch(&self) -> Option<T>
            where
                T: Copy,
            {
                #[allow(unused_assignments, unused_mut, reason = "most leave nothing")]
                match self {
                    $( Self::$name { $($field),* } => {
                        let mut found: Option<&T> = None;
                        $( field!(garbage $kind $field, found); )*
                        found.copied()
                    } )*
                }
            }

            fn scratch_mut(&mut self) -> Option<&mut T> {
                #[allow(unused_assignments, unused_mut, reason = "most leave nothing")]
                match self {
                    $( Self::$name { $($field),* } => {
                        let mut found = None;
                        $( field!(garbage $kind $field, found); )*
                        found
                    } )*
                }
            }

            /// Returns the style of the lowering, if there is a choice.
            pub fn style(&self) -> Option<Style> {
                #[allow(unused_assignments, unused_mut, reason = "most are lowered in one way")]
                match self {
                    $( Self::$name { $($field),* } => {
                        let mut found: Option<&Style> = None;
                        $( field!(style $kind $field, found); )*
                        found.copied()
                    } )*
                }
            }

            fn style_mut(&mut self) -> Option<&mut Style> {
                #[allow(unused_assignments, unused_mut, reason = "most are lowered in one way")]
                match self {
                    $( Self::$name { $($field),* } => {
                        let mut found = None;
                        $( field!(style $kind $field, found); )*
                        found
                    } )*
                }
            }

            /// Returns its operands and its constants, in the order of the arguments of the method
            /// of [`super::Machine`] that computes it.
            pub fn arguments(&self) -> Vec<Argument<'_, R>> {
                let mut all = Vec::new();
                match self {
                    $( Self::$name { $($field),* } => {
                        $( field!(argument $kind $field, all); )*
                    } )*
                }
                all
            }
        }

        impl<R, T: Copy> Op<R, T> {
            /// Returns the registers of the results of an out-of-place operation.
            pub fn targets(&self) -> Vec<T> {
                let mut all = Vec::new();
                self.each_target(|target| all.push(target));
                all
            }

            /// Calls `see` with each of [`Op::targets`], without a list of them.
            #[inline]
            pub fn each_target(&self, mut see: impl FnMut(T)) {
                let _ = &mut see;
                match self {
                    $( Self::$name { $($field),* } => {
                        $( field!(each_target $kind $field, see); )*
                    } )*
                }
            }
        }
    };
}

operations! {
    /// An operation of a [`super::Program`].
    ///
    /// Most operations compute out of place, into *targets* that are zero before. The inverse
    /// returns a target to zero, given the same operands; its effect on any other content is
    /// unspecified. The others, at the end of the list, change a register in place, and their
    /// inverses are exact for every content.
    ///
    /// Numbers are those of [`Word::read`]. Targets hold a result's lowest bits: `w` is the
    /// target's width, and "mod 2^w" keeps the bits that fit. All operands, and all results before
    /// they are cut to their target, lie within 63 bits, products within 126.
    ///
    /// A target never overlaps an operand. `scratch` registers are computed together with the
    /// target and returned to zero with it. Their content is internal to the lowering. Their width
    /// is `lower::scratch_width`.
    {
        /// `t = a mod 2^w`
        Copy = "copy"
        /// The number that is copied.
        reads a: Word<R>,
        /// The target `t`.
        target target: T,
    }
    {
        /// `t = parameter`: a classical parameter that the pixel decides.
        Load = "load"
        /// The parameter's index in the program's list.
        constant parameter: u32,
        /// The target `t`.
        target target: T,
    }
    {
        /// `t = parameter ^ XOR_b source_b columns[b]`, over the bits b of `source`: a linear map over
        /// GF(2), shifted.
        Parity = "parity"
        /// The register of the path index.
        register source: R,
        /// The bits of t that each bit of the source flips.
        constant columns: Arc<[u64]>,
        /// The index of the pixel's shift in the program's list of parameters; `None` if there is
        /// no shift.
        constant parameter: Option<u32>,
        /// The target `t`.
        target target: T,
    }
    {
        /// `t = a and b`
        And = "and"
        /// The first operand.
        reads a: Bit<R>,
        /// The second operand.
        reads b: Bit<R>,
        /// The target `t`: one bit.
        target target: T,
    }
    {
        /// `t = a xor b`
        Xor = "xor"
        /// The first operand.
        reads a: Bit<R>,
        /// The second operand.
        reads b: Bit<R>,
        /// The target `t`: one bit.
        target target: T,
    }
    {
        /// `t = a + b mod 2^w`, or `a - b mod 2^w`.
        Add = "add"
        /// The first operand.
        reads a: Operand<R>,
        /// The second operand.
        reads b: Operand<R>,
        /// True if b is subtracted.
        constant subtract: bool,
        /// The target `t`.
        target target: T,
    }
    {
        /// `t = if when { -a } else { a } mod 2^w`
        Negate = "negate"
        /// The number `a` that is read.
        reads a: Word<R>,
        /// The condition.
        reads when: Bit<R>,
        /// The target `t`.
        target target: T,
    }
    {
        /// `t = if when { a } else { b } mod 2^w`
        Select = "select"
        /// The condition.
        reads when: Bit<R>,
        /// The number where the condition holds.
        reads a: Operand<R>,
        /// The number where the condition does not hold.
        reads b: Operand<R>,
        /// The target `t`.
        target target: T,
    }
    {
        /// `t = a < b`, without garbage.
        Less = "less"
        /// The first operand.
        reads a: Operand<R>,
        /// The second operand.
        reads b: Operand<R>,
        /// The target `t`: one bit.
        target target: T,
    }
    {
        /// `t = floor(a b / 2^drop) mod 2^w`
        Multiply = "multiply"
        /// The first factor: its bits choose the rows.
        reads a: Word<R>,
        /// The second factor.
        reads b: Word<R>,
        /// Number of the result's lowest bits that are dropped.
        constant drop: u32,
        /// The style of the lowering.
        style style: Style,
        /// The target `t`.
        target target: T,
        /// The register of the garbage.
        garbage scratch: T,
    }
    {
        /// `t = floor(a^2 / 2^drop) mod 2^w`
        Square = "square"
        /// The number `a` that is read.
        reads a: Word<R>,
        /// Number of the result's lowest bits that are dropped.
        constant drop: u32,
        /// The style of the lowering.
        style style: Style,
        /// The target `t`.
        target target: T,
        /// The register of the garbage.
        garbage scratch: T,
    }
    {
        /// `t = floor(factor a / 2^drop) mod 2^w`, for a constant factor other than 0.
        Scale = "scale"
        /// The number `a` that is read.
        reads a: Word<R>,
        /// The factor.
        constant factor: i64,
        /// Number of the result's lowest bits that are dropped.
        constant drop: u32,
        /// The style of the lowering.
        style style: Style,
        /// The target `t`.
        target target: T,
        /// The register of the garbage.
        garbage scratch: T,
    }
    {
        /// `t_k = floor(factor_k a / 2^drop_k) mod 2^w_k`, for constant factors above 0, by sums that
        /// the products share.
        Multiples = "multiples"
        /// The number `a` that is read.
        reads a: Word<R>,
        /// The factors, the numbers of dropped bits, and the sums.
        constant products: Arc<Multiples>,
        /// The targets.
        targets targets: Box<[T]>,
        /// The register of the garbage.
        garbage scratch: T,
    }
    {
        /// `f = a < b 2^n`, and `q = floor(a' / b)`, where n is q's width and `a'` is a where f holds
        /// and 0 where it does not; `q = 2^n - 1` where b is 0. Both operands are unsigned.
        Divide = "divide"
        /// The dividend.
        reads a: Word<R>,
        /// The divisor.
        reads b: Word<R>,
        /// The style of the lowering.
        style style: Style,
        /// The quotient.
        target quotient: T,
        /// The bit that is 1 if the quotient fits.
        target fits: T,
        /// The register of the garbage.
        garbage scratch: T,
    }
    {
        /// `t = floor(sqrt(a)) mod 2^w`, for an unsigned a.
        SquareRoot = "square_root"
        /// The number `a` that is read.
        reads a: Word<R>,
        /// The style of the lowering.
        style style: Style,
        /// The target `t`.
        target target: T,
        /// The register of the garbage.
        garbage scratch: T,
    }
    {
        /// `t_k = columns[k][address] mod 2^w_k`: a QROM of `columns[k].len()` entries, the same
        /// number for all k. An address beyond them may not occur, and its result depends on the
        /// lowering.
        Table = "table"
        /// Bits of the address, the least significant first.
        reads address: Box<[Bit<R>]>,
        /// The entries of each column, by address. Tables may share columns.
        constant columns: Arc<[Arc<[i64]>]>,
        /// Number of the lowest address bits that select among words read together, under
        /// [`Style::OutOfPlace`].
        constant low: u32,
        /// The style of the lowering.
        style style: Style,
        /// The targets.
        targets targets: Box<[T]>,
        /// The register of the garbage.
        garbage scratch: T,
    }
    {
        /// `t_k = entries[i_k] mod 2^w_k`, where `i_k` is the place of the k-th of `bits` that holds; 0
        /// if fewer hold. A priority encoder with several outputs. The top bit of each target is 1 in
        /// all entries, so it tells whether a bit was found. A bit that holds after the last target is
        /// taken is passed over.
        Encode = "encode"
        /// The bits, in the order in which they are found.
        reads bits: Box<[Bit<R>]>,
        /// The entry of each bit.
        constant entries: Arc<[u64]>,
        /// The targets, all of one width.
        targets targets: Box<[T]>,
        /// The register of the garbage.
        garbage scratch: T,
    }
    {
        /// `t ^= a mod 2^w`, where `when` holds. In place, and its own inverse.
        XorInto = "xor_into"
        /// The number that is added over GF(2).
        reads a: Operand<R>,
        /// The condition; `None` if the change is on every path.
        reads when: Option<Bit<R>>,
        /// The register `t`, which is changed in place.
        register target: R,
    }
    {
        /// `t += a mod 2^w` or `t -= a mod 2^w`. In place.
        AddInto = "add_into"
        /// The number that is added or subtracted.
        reads a: Operand<R>,
        /// True if the number is subtracted.
        constant subtract: bool,
        /// The condition.
        reads when: When<R>,
        /// The register `t`, which is changed in place.
        register target: R,
    }
    {
        /// `(a, b) = (b, a)` where `when` holds; both of one width. In place, and its own inverse.
        Swap = "swap"
        /// The first operand.
        register a: R,
        /// The second operand.
        register b: R,
        /// The condition; `None` if the change is on every path.
        reads when: Option<Bit<R>>,
    }
    {
        /// Flips the phase of a basis state where `bit` holds: a Z. Its own inverse.
        Phase = "phase"
        /// The condition.
        reads bit: Bit<R>,
    }
}

impl Op {
    /// Returns the registers that are zero before the operation and hold its results after it,
    /// garbage included; empty for an operation in place.
    pub fn fresh(&self) -> Vec<RegisterId> {
        let mut fresh = self.targets();
        fresh.extend(self.scratch());
        fresh
    }

    /// Returns the registers that the operation reads or changes in place.
    pub fn reads(&self) -> Vec<RegisterId> {
        let mut reads = Vec::new();
        self.each_read(&mut |register| reads.push(*register));
        reads
    }
}

impl<R, T> Op<R, T> {
    /// Returns the same operation with its garbage in this register, if it has any.
    pub(crate) fn with_scratch(mut self, scratch: T) -> Self {
        if let Some(field) = self.scratch_mut() {
            *field = scratch;
        }
        self
    }

    /// Returns the same operation, lowered in this style where there is a choice.
    pub(crate) fn with_style(mut self, style: Style) -> Self {
        if let Some(field) = self.style_mut() {
            *field = style;
        }
        self
    }
}
