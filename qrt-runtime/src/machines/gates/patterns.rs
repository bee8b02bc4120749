//! What the machine executes at a time: single gates, and sequences of them that go through
//! registers of the processor together.
//!
//! A gate on its own costs two or three loads and a store for each vector of a row, and the
//! processor's ports for these are what limits the machine. Ripple adders consist of a few short
//! sequences over and over; executed together, such a sequence loads and stores each of its rows
//! once. Every gate is still executed, on every lane.

use pulp::Simd;
use qrt_core::circuit::Gate;
use std::cell::Cell;

/// A sequence of gates over rows 0 .. `rows` of its own.
pub(super) struct Pattern {
    pub(super) gates: &'static [Gate],
    pub(super) rows: usize,
}

/// Rows of `N` vectors.
pub(super) type Row<S, const N: usize> = Cell<[<S as Simd>::u64s; N]>;

macro_rules! gate {
    (x $t:ident) => {
        Gate::X(Q::$t as u32)
    };
    (cx $a:ident $t:ident) => {
        Gate::Cx(Q::$a as u32, Q::$t as u32)
    };
    (ccx $a:ident $b:ident $t:ident) => {
        Gate::Ccx(Q::$a as u32, Q::$b as u32, Q::$t as u32)
    };
}

macro_rules! apply {
    ($simd:ident, x $t:ident) => {
        $t = $simd.not_u64s($t);
    };
    ($simd:ident, cx $a:ident $t:ident) => {
        $t = $simd.xor_u64s($t, $a);
    };
    ($simd:ident, ccx $a:ident $b:ident $t:ident) => {
        $t = $simd.xor_u64s($t, $simd.and_u64s($a, $b));
    };
}

/// Patterns, each as `number: (rows only read) (rows written) { gates }`.
macro_rules! patterns {
    ($($number:literal: ($($read:ident)*) ($($write:ident)*) { $($gate:ident $($q:ident)+;)+ })+) => {
        /// All patterns, by number.
        pub(super) const PATTERNS: &[Pattern] = &[$({
            #[allow(non_camel_case_types)]
            #[derive(Clone, Copy)]
            enum Q { $($read,)* $($write,)* End }
            Pattern { gates: &[$(gate!($gate $($q)+),)+], rows: Q::End as usize }
        },)+];

        /// Executes pattern `number` on each tuple of rows in `operands`.
        #[inline(always)]
        pub(super) fn execute<S: Simd, const N: usize>(
            simd: S,
            rows: &[Row<S, N>],
            number: usize,
            operands: &[u32],
        ) {
            match number {
                $($number => {
                    const ROWS: usize = PATTERNS[$number].rows;
                    for &[$($read,)* $($write),*] in operands.as_chunks::<ROWS>().0 {
                        $(let $read = rows[$read as usize].as_array_of_cells();)*
                        $(let $write = rows[$write as usize].as_array_of_cells();)*
                        for vector in 0..N {
                            let places = ($(&$write[vector],)*);
                            $(let $read = $read[vector].get();)*
                            $(let mut $write = $write[vector].get();)*
                            $(apply!(simd, $gate $($q)+);)+
                            store!(places, $($write)*);
                        }
                    }
                })+
                _ => {}
            }
        }
    };
}

macro_rules! store {
    ($places:ident, $a:ident) => {
        $places.0.set($a);
    };
    ($places:ident, $a:ident $b:ident) => {
        $places.0.set($a);
        $places.1.set($b);
    };
    ($places:ident, $a:ident $b:ident $c:ident) => {
        $places.0.set($a);
        $places.1.set($b);
        $places.2.set($c);
    };
    ($places:ident, $a:ident $b:ident $c:ident $d:ident) => {
        $places.0.set($a);
        $places.1.set($b);
        $places.2.set($c);
        $places.3.set($d);
    };
}

patterns! {
    // The gates themselves: whatever else is left out, these three are enough.
    0: () (t) { x t; }
    1: (a) (t) { cx a t; }
    2: (a b) (t) { ccx a b t; }
    // Two or more into one target.
    3: (a b) (t) { cx a t; cx b t; }
    4: (a b c) (t) { cx a t; cx b t; cx c t; }
    5: (a b c) (t) { ccx a b t; cx c t; }
    6: (a b c) (t) { cx c t; ccx a b t; }
    // Two from one control.
    7: (a) (s t) { cx a s; cx a t; }
    // Majority and its inverse, in place.
    8: () (a b c) { cx a b; cx a c; ccx b c a; }
    9: () (a b c) { ccx b c a; cx a c; cx a b; }
    // The inverse of a majority that leaves the sum.
    10: () (a b c) { ccx b c a; cx a c; cx c b; }
    11: () (a b c) { cx c b; cx a c; ccx b c a; }
    // A carry out of place: t ^= majority of a, b, c.
    12: (c) (a b t) { cx c a; cx c b; ccx a b t; cx c t; }
    13: (c) (a b t) { cx c t; ccx a b t; cx c b; cx c a; }
    // A full adder: the same, then a as it was and the sum in b.
    14: (c) (a b t) { cx c a; cx c b; ccx a b t; cx c t; cx c a; cx a b; }
    15: (c) (a b t) { cx a b; cx c a; cx c t; ccx a b t; cx c b; cx c a; }
}
