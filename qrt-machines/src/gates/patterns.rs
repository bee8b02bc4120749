//! Patterns, which the machine executes one at a time: single gates, and sequences of gates that go
//! through registers of the processor together.
//!
//! A gate on its own costs two or three loads and a store for each vector of a row, and the
//! processor's ports for loads and stores limit the machine. Ripple adders repeat a few short
//! sequences. If the machine executes such a sequence as one pattern, it loads and stores each of
//! the rows once. Every gate is still executed, on every lane.

use pulp::Simd;
use qrt_circuit::Gate;
use std::cell::Cell;

/// A sequence of gates over rows 0 .. `rows` of its own.
pub(super) struct Pattern {
    pub(super) gates: &'static [Gate],
    pub(super) rows: usize,
}

/// `N` vectors: a row, or a part of one.
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

/// Defines patterns, each as `number: (rows that end unchanged) (other rows) { gates }`.
macro_rules! patterns {
    ($($number:literal: ($($read:ident)*) ($($write:ident)*) { $($gate:ident $($q:ident)+;)+ })+) => {
        /// All patterns, by number.
        pub(super) const PATTERNS: &[Pattern] = &[$({
            #[allow(non_camel_case_types)]
            #[derive(Clone, Copy)]
            enum Q { $($read,)* $($write,)* End }
            Pattern { gates: &[$(gate!($gate $($q)+),)+], rows: Q::End as usize }
        },)+];

        /// Executes pattern `number` on each tuple of rows in `operands`; a row has `parts` parts.
        #[inline(always)]
        pub(super) fn execute<S: Simd, const N: usize>(
            simd: S,
            (rows, parts): (&[Row<S, N>], usize),
            number: usize,
            operands: &[u32],
        ) {
            match number {
                $($number => {
                    const ROWS: usize = PATTERNS[$number].rows;
                    for &[$($read,)* $($write),*] in operands.as_chunks::<ROWS>().0 {
                        for part in 0..parts {
                            let part_of = |row: u32| {
                                rows[row as usize * parts + part].as_array_of_cells()
                            };
                            $(let $read = part_of($read);)*
                            $(let $write = part_of($write);)*
                            for vector in 0..N {
                                let places = ($(&$write[vector],)*);
                                $(
                                    #[allow(
                                        unused_mut,
                                        reason = "gates may write to a row that ends unchanged"
                                    )]
                                    let mut $read = $read[vector].get();
                                )*
                                $(let mut $write = $write[vector].get();)*
                                $(apply!(simd, $gate $($q)+);)+
                                store!(places, $($write)*);
                            }
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
    ($places:ident, $a:ident $b:ident $c:ident $d:ident $e:ident $f:ident $g:ident $h:ident) => {
        $places.0.set($a);
        $places.1.set($b);
        $places.2.set($c);
        $places.3.set($d);
        $places.4.set($e);
        $places.5.set($f);
        $places.6.set($g);
        $places.7.set($h);
    };
    ($places:ident, $a:ident $b:ident $c:ident $d:ident $e:ident $f:ident $g:ident $h:ident $i:ident) => {
        $places.0.set($a);
        $places.1.set($b);
        $places.2.set($c);
        $places.3.set($d);
        $places.4.set($e);
        $places.5.set($f);
        $places.6.set($g);
        $places.7.set($h);
        $places.8.set($i);
    };
}

patterns! {
    // Single gates. These three patterns are sufficient; all others are faster.
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
    // A full adder: the same, then `a` is restored and `b` becomes the sum.
    14: (a c) (b t) { cx c a; cx c b; ccx a b t; cx c t; cx c a; cx a b; }
    15: (a c) (b t) { cx a b; cx c a; cx c t; ccx a b t; cx c b; cx c a; }
    // A full adder out of place: the carry c becomes the sum, and t the carry; of a + b, of a - b
    // and of b - a.
    16: (a b) (c t) { cx a c; cx a b; ccx c b t; cx a t; cx a b; cx b c; }
    17: (a b) (c t) { cx b c; cx a b; cx a t; ccx c b t; cx a b; cx a c; }
    18: (a b) (c t) {
        cx a c; cx a b; x b; ccx c b t; x b; cx a t; cx a b; cx b c; x c;
    }
    19: (a b) (c t) {
        x c; cx b c; cx a b; cx a t; x b; ccx c b t; x b; cx a b; cx a c;
    }
    20: (a b) (c t) {
        cx a c; cx a b; x c; x b; ccx c b t; x b; x c; cx a t; x t; cx a b; cx b c; x c;
    }
    21: (a b) (c t) {
        x c; cx b c; cx a b; x t; cx a t; x c; x b; ccx c b t; x b; x c; cx a b; cx a c;
    }
    // Out-of-place majorities that leave their operands unchanged.
    22: (a b c) (t) { cx a b; cx a c; ccx b c t; cx a c; cx a b; cx a t; }
    23: (a b c) (t) { cx a t; cx a b; cx a c; ccx b c t; cx a c; cx a b; }
    // Conjunctions with a negation.
    24: (a b) (t) { x a; ccx a b t; x a; }
    25: (a) (t) { cx a t; x t; }
    26: (a) (t) { x t; cx a t; }
    // Many controls and one target, as in a table look-up.
    27: (a b c d) (t) { cx a t; cx b t; cx c t; cx d t; }
    28: (a b c d e f g h) (t) {
        cx a t; cx b t; cx c t; cx d t; cx e t; cx f t; cx g t; cx h t;
    }
    // One control and many targets.
    29: (a) (s t u v) { cx a s; cx a t; cx a u; cx a v; }
    // Four majorities up a ladder, or down: the carry from one to the next stays in a register.
    30: () (a b c d e f g h i) {
        cx a b; cx a c; ccx b c a; cx d e; cx d a; ccx e a d;
        cx f g; cx f d; ccx g d f; cx h i; cx h f; ccx i f h;
    }
    31: () (a b c d e f g h i) {
        ccx i f h; cx h f; cx h i; ccx g d f; cx f d; cx f g;
        ccx e a d; cx d a; cx d e; ccx b c a; cx a c; cx a b;
    }
    32: () (a b c d e f g h i) {
        ccx i f h; cx h f; cx f i; ccx g d f; cx f d; cx d g;
        ccx e a d; cx d a; cx a e; ccx b c a; cx a c; cx c b;
    }
    33: () (a b c d e f g h i) {
        cx c b; cx a c; ccx b c a; cx a e; cx d a; ccx e a d;
        cx d g; cx f d; ccx g d f; cx f i; cx h f; ccx i f h;
    }
    // Three full adders out of place, in a row: of a + b and of a - b.
    34: (a b d e g h) (c t u v) {
        cx a c; cx a b; ccx c b t; cx a t; cx a b; cx b c;
        cx d t; cx d e; ccx t e u; cx d u; cx d e; cx e t;
        cx g u; cx g h; ccx u h v; cx g v; cx g h; cx h u;
    }
    35: (a b d e g h) (c t u v) {
        cx h u; cx g h; cx g v; ccx u h v; cx g h; cx g u;
        cx e t; cx d e; cx d u; ccx t e u; cx d e; cx d t;
        cx b c; cx a b; cx a t; ccx c b t; cx a b; cx a c;
    }
    36: (a b d e g h) (c t u v) {
        cx a c; cx a b; x b; ccx c b t; x b; cx a t; cx a b; cx b c; x c;
        cx d t; cx d e; x e; ccx t e u; x e; cx d u; cx d e; cx e t; x t;
        cx g u; cx g h; x h; ccx u h v; x h; cx g v; cx g h; cx h u; x u;
    }
    37: (a b d e g h) (c t u v) {
        x u; cx h u; cx g h; cx g v; x h; ccx u h v; x h; cx g h; cx g u;
        x t; cx e t; cx d e; cx d u; x e; ccx t e u; x e; cx d e; cx d t;
        x c; cx b c; cx a b; cx a t; x b; ccx c b t; x b; cx a b; cx a c;
    }
    // One control and many targets, negated or not.
    38: (a) (s t u v) { cx a s; x s; cx a t; x t; cx a u; x u; cx a v; x v; }
    39: (a) (s t u v) { x s; cx a s; x t; cx a t; x u; cx a u; x v; cx a v; }
    40: (a) (s t u v w x y z) {
        cx a s; cx a t; cx a u; cx a v; cx a w; cx a x; cx a y; cx a z;
    }
}
