//! A library that re-exports qrt, and a macro of its own that uses qrt's.

pub use qrt;

/// Defines a function that adds a number to another.
#[macro_export]
macro_rules! adder {
    ($name:ident) => {
        #[$crate::qrt::reversible(crate = $crate::qrt)]
        fn $name(
            a: &$crate::qrt::circuit::format::UInt<4>,
            b: &mut $crate::qrt::circuit::format::UInt<4>,
        ) {
            b += a;
        }
    };
}
