//! Number formats as types, and registers that carry their formats.
//!
//! A routine's registers have their widths in their types, so registers that do not fit together do
//! not compile:
//!
//! ```
//! use qrt_circuit::format::{Fixed, Format, UInt};
//!
//! assert_eq!(UInt::<8>::WIDTH, 8);
//! assert_eq!(Fixed::<2, 14>::WIDTH, 16);
//! assert_eq!(Fixed::<2, 14>::bits(-0.25), Some(0xF000));
//! assert_eq!(Fixed::<2, 14>::value(0xF000), -0.25);
//! ```

use super::{Declaration, Machine, Recorded, Recorder, Type, Word};
use std::fmt;
use std::marker::PhantomData;

/// An unsigned integer of `W` bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UInt<const W: u32>;

/// An integer of `W` bits in two's complement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Int<const W: u32>;

/// A number in two's complement: `I` bits before the point, its sign among them, and `F` after it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fixed<const I: i32, const F: u32>;

/// An unsigned number with `I` bits before the point and `F` after it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UFixed<const I: i32, const F: u32>;

/// One bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bool;

/// The meaning of a register's bits, as a type.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not the format of a register",
    label = "not a format",
    note = "registers are `UInt<W>`, `Int<W>`, `Fixed<I, F>`, `UFixed<I, F>` or `Bool`"
)]
pub trait Format {
    /// The format as a value.
    const TYPE: Type;
    /// Number of bits of a register of this format: 1 to 63.
    const WIDTH: u32;

    /// Returns the bits that stand for `value`. `None` if `value` is not a number of this format.
    fn bits(value: f64) -> Option<u64> {
        let scaled = value * 2_f64.powi(fraction(Self::TYPE).cast_signed());
        let whole = scaled as i64;
        let bits = whole.cast_unsigned() & (u64::MAX >> (64 - Self::WIDTH));
        (whole as f64 == scaled && Self::value(bits) == value).then_some(bits)
    }

    /// Returns the number that `bits` stand for.
    fn value(bits: u64) -> f64 {
        let signed = matches!(Self::TYPE, Type::Int | Type::Fixed { .. });
        let word = Word {
            signed,
            ..Word::unsigned((), 0, Self::WIDTH)
        };
        word.read(bits) as f64 * 2_f64.powi(-fraction(Self::TYPE).cast_signed())
    }
}

fn fraction(ty: Type) -> u32 {
    match ty {
        Type::UFixed { fraction } | Type::Fixed { fraction } => fraction,
        Type::Bool | Type::UInt | Type::Int | Type::Scratch => 0,
    }
}

/// Checks a register's width at compile time.
#[doc(hidden)]
pub const fn width(bits: i64) -> u32 {
    assert!(0 < bits && bits < 64, "a register has 1 to 63 bits");
    bits as u32
}

/// Number of bits of the longest of a table's numbers: at least 1, and 64 if one is negative.
#[doc(hidden)]
pub const fn entry_bits(entries: &[i64]) -> u32 {
    let (mut all, mut at) = (1, 0);
    while at < entries.len() {
        all |= entries[at];
        at += 1;
    }
    64 - all.leading_zeros()
}

/// The expected format of a routine's parameter, computed from the routine's constants.
#[doc(hidden)]
pub trait ExpectedFormat {
    /// The format.
    type Format: Format;
    /// The message for a register of another format.
    const OTHERWISE: &'static str;
}

/// Fails to compile if the register's format is not the expected one.
#[doc(hidden)]
#[inline(always)]
pub fn agree<E: ExpectedFormat, R, T: Format>(_: Option<&Reg<R, T>>) {
    const {
        let same = match (T::TYPE, E::Format::TYPE) {
            (Type::Bool, Type::Bool) | (Type::UInt, Type::UInt) | (Type::Int, Type::Int) => true,
            (Type::UFixed { fraction: a }, Type::UFixed { fraction: b })
            | (Type::Fixed { fraction: a }, Type::Fixed { fraction: b }) => a == b,
            _ => false,
        };
        assert!(same && T::WIDTH == E::Format::WIDTH, "{}", E::OTHERWISE);
    }
}

impl<const W: u32> Format for UInt<W> {
    const TYPE: Type = Type::UInt;
    const WIDTH: u32 = width(W as i64);
}

impl<const W: u32> Format for Int<W> {
    const TYPE: Type = Type::Int;
    const WIDTH: u32 = width(W as i64);
}

impl<const I: i32, const F: u32> Format for Fixed<I, F> {
    const TYPE: Type = Type::Fixed { fraction: F };
    const WIDTH: u32 = width(I as i64 + F as i64);
}

impl<const I: i32, const F: u32> Format for UFixed<I, F> {
    const TYPE: Type = Type::UFixed { fraction: F };
    const WIDTH: u32 = width(I as i64 + F as i64);
}

impl Format for Bool {
    const TYPE: Type = Type::Bool;
    const WIDTH: u32 = 1;
}

/// A register of the format `T`, on a machine whose registers are `R`.
///
/// Routines take it by reference: `&` to read it, `&mut` to change it.
pub struct Reg<R, T> {
    register: R,
    format: PhantomData<T>,
}

impl<R: fmt::Debug, T> fmt::Debug for Reg<R, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Reg").field(&self.register).finish()
    }
}

impl<R, T: Format> Reg<R, T> {
    /// Wraps a register that was declared with this format.
    #[doc(hidden)]
    pub fn new(register: R) -> Self {
        Self {
            register,
            format: PhantomData,
        }
    }

    /// Allocates a work register that holds 0.
    #[inline(always)]
    pub fn zero<M: Machine<Register = R>>(machine: &mut M, name: &'static str) -> Self {
        Self::new(machine.zero(&Declaration::work(name, T::TYPE, T::WIDTH)))
    }

    /// Undoes the operation that computed the register.
    #[inline(always)]
    pub fn undo<M: Machine<Register = R>>(self, machine: &mut M) {
        machine.undo([self.register]);
    }

    /// Frees a work register that holds 0 again.
    #[inline(always)]
    pub fn free<M: Machine<Register = R>>(self, machine: &mut M) {
        machine.free(self.register);
    }

    /// Returns the machine's register.
    #[inline(always)]
    pub fn register(&self) -> &R {
        &self.register
    }

    /// Returns the machine's register, for a change.
    #[inline(always)]
    pub fn register_mut(&mut self) -> &mut R {
        &mut self.register
    }

    /// Returns all bits of the register, as an integer in units of the lowest bit.
    #[inline(always)]
    pub fn word(&self) -> Word<&R> {
        Word {
            signed: matches!(T::TYPE, Type::Int | Type::Fixed { .. }),
            ..Word::unsigned(&self.register, 0, T::WIDTH)
        }
    }
}

impl<T: Format> Reg<Recorded, T> {
    /// Wraps a machine's register, to read it in the format `T`.
    ///
    /// # Panics
    /// If the width of `register` is not that of `T`.
    pub fn from_recorded(register: Recorded) -> Self {
        assert!(
            register.width() == T::WIDTH,
            "a register of {} bits was taken for one of {}",
            register.width(),
            T::WIDTH
        );
        Self::new(register)
    }

    /// Declares an input: a register that holds a value before the program's first instruction.
    pub fn input(recorder: &mut Recorder, name: &'static str) -> Self {
        Self::new(recorder.input(&Declaration::work(name, T::TYPE, T::WIDTH)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_read_what_they_write() {
        for bits in 0..256 {
            assert_eq!(UInt::<8>::bits(UInt::<8>::value(bits)), Some(bits));
            assert_eq!(Int::<8>::bits(Int::<8>::value(bits)), Some(bits));
            assert_eq!(
                Fixed::<-1, 9>::bits(Fixed::<-1, 9>::value(bits)),
                Some(bits)
            );
            assert_eq!(
                UFixed::<3, 5>::bits(UFixed::<3, 5>::value(bits)),
                Some(bits)
            );
        }
        assert_eq!(Int::<8>::value(0x80), -128.0);
        assert_eq!(UFixed::<3, 5>::value(1), 0.03125);
        assert_eq!(Bool::value(1), 1.0);
    }

    #[test]
    #[should_panic(expected = "a register of 4 bits was taken for one of 8")]
    fn a_register_is_of_its_own_width() {
        let mut m = Recorder::new(crate::Style::InPlace);
        let a = m.input(&Declaration::work("a", Type::UInt, 4));
        let _: Reg<_, UInt<8>> = Reg::from_recorded(a);
    }

    #[test]
    fn what_a_format_lacks_has_no_bits() {
        assert_eq!(UInt::<8>::bits(256.0), None);
        assert_eq!(UInt::<8>::bits(-1.0), None);
        assert_eq!(Int::<8>::bits(128.0), None);
        assert_eq!(Fixed::<2, 14>::bits(0.1), None);
        assert_eq!(Fixed::<2, 14>::bits(f64::NAN), None);
        assert_eq!(UInt::<63>::bits(1e300), None);
    }
}
