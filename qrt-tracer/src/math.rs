//! Macros that write arithmetic as formulas.
//!
//! [`Arith`](super::Arith) is a list of methods. `math!` and `vector!` write formulas, and expand
//! to calls of these methods alone: operands from left to right, an operation after its operands. A
//! circuit therefore computes the operands in the order of the formula.
//!
//! ```text
//! math!(cx, (eta * cos_o - cos_t) / (eta * cos_o + cos_t))     a number or a truth value
//! vector!(cx, ray.origin + ray.direction * distance)            a vector
//! ```
//!
//! From the tightest to the loosest: `-a` and `!c`; `*` and `/`; `+` and `-`; `<` and `<=`; `&&`;
//! `||`. Operations of one rank group to the left. Nothing is skipped: `&&` computes both sides.
//!
//! - A literal is a constant, and so is `real(x)` of any `f64`.
//! - `f(a, b)` is `cx.f(a, b)`, whose arguments are formulas. The last ones of `div(a, b, most)`,
//!   `scale(a, factor)` and `known(a, low, high)` are plain `f64`s.
//! - `a / b` is a division whose quotient has no known bound; `div` states one.
//! - `dot(v, w)` is a number; in `vector!`, `mirror(v, w)` and `constant(c)` are vectors, and so is
//!   `v * s`, whose right-hand factor is a number.
//! - Anything else is Rust: a variable, a field, an element, an array of components.

/// A number or a truth value, by a formula; see [the module](self).
macro_rules! math {
    // Reads one token after the other. The arguments are the pending operations, the operand so
    // far, and the rest. The pending operations are the kind of the formula, its arithmetic, and a
    // list for each rank, which is empty or holds a formula and an operation.
    (@next $w:tt () - $($rest:tt)+) => { math!(@next $w (-) $($rest)+) };
    (@next $w:tt (-) - $($rest:tt)+) => { math!(@next $w (- -) $($rest)+) };
    (@next $w:tt ($($x:tt)+) * $($rest:tt)+) => { math!(@product $w ($($x)+) mul $($rest)+) };
    (@next $w:tt ($($x:tt)+) / $($rest:tt)+) => { math!(@product $w ($($x)+) div $($rest)+) };
    (@next $w:tt ($($x:tt)+) + $($rest:tt)+) => { math!(@sum $w ($($x)+) add $($rest)+) };
    (@next $w:tt ($($x:tt)+) - $($rest:tt)+) => { math!(@sum $w ($($x)+) sub $($rest)+) };
    (@next $w:tt ($($x:tt)+) < $($rest:tt)+) => { math!(@less $w ($($x)+) less $($rest)+) };
    (@next $w:tt ($($x:tt)+) <= $($rest:tt)+) => { math!(@less $w ($($x)+) less_equal $($rest)+) };
    (@next $w:tt ($($x:tt)+) && $($rest:tt)+) => { math!(@and $w ($($x)+) and $($rest)+) };
    (@next $w:tt ($($x:tt)+) || $($rest:tt)+) => { math!(@or $w ($($x)+) or $($rest)+) };
    (@next $w:tt ($($x:tt)*) $token:tt $($rest:tt)*) => {
        math!(@next $w ($($x)* $token) $($rest)*)
    };
    (@next $w:tt ()) => { compile_error!("an operand is missing at the formula's end") };
    (@next {$k:ident $cx:ident $or:tt $and:tt $less:tt $sum:tt $product:tt} $x:tt) => {
        math!(@join $k $cx $or math!(@join $k $cx $and math!(@join $k $cx $less
            math!(@join $k $cx $sum math!(@times $k $cx $product $x)))))
    };
    // An operator of each rank completes the pending operations of tighter ranks.
    (@product {$k:ident $cx:ident $or:tt $and:tt $less:tt $sum:tt $product:tt}
        $x:tt $operation:ident $($rest:tt)+) => {
        math!(@next {$k $cx $or $and $less $sum
            ((math!(@times $k $cx $product $x)) $operation)} () $($rest)+)
    };
    (@sum {$k:ident $cx:ident $or:tt $and:tt $less:tt $sum:tt $product:tt}
        $x:tt $operation:ident $($rest:tt)+) => {
        math!(@next {$k $cx $or $and $less ((math!(@join $k $cx $sum
            math!(@times $k $cx $product $x))) $operation) ()} () $($rest)+)
    };
    (@less {$k:ident $cx:ident $or:tt $and:tt () $sum:tt $product:tt}
        $x:tt $operation:ident $($rest:tt)+) => {
        math!(@next {$k $cx $or $and ((math!(@join $k $cx $sum
            math!(@times $k $cx $product $x))) $operation) () ()} () $($rest)+)
    };
    (@and {$k:ident $cx:ident $or:tt $($tighter:tt)+} $x:tt $operation:ident $($rest:tt)+) => {
        math!(@next {$k $cx $or ((math!(@next {$k $cx () $($tighter)+} $x)) $operation)
            () () ()} () $($rest)+)
    };
    (@or {$k:ident $cx:ident $($tighter:tt)+} $x:tt $operation:ident $($rest:tt)+) => {
        math!(@next {$k $cx ((math!(@next {$k $cx $($tighter)+} $x)) $operation)
            () () () ()} () $($rest)+)
    };

    // A pending operation and its right-hand operand. A `match` binds both before the call.
    (@join $k:ident $cx:ident () $x:expr) => { $x };
    (@join vector $cx:ident ($left:tt $operation:ident) $x:expr) => {
        match ($left, $x) { (a, b) => $crate::vector::$operation($cx, &a, &b) }
    };
    (@join real $cx:ident ($left:tt $operation:ident) $x:expr) => {
        match ($left, $x) { (a, b) => $cx.$operation(a, b) }
    };
    (@times $k:ident $cx:ident () $x:tt) => { math!(@one $k $cx $x) };
    (@times vector $cx:ident ($left:tt mul) $x:tt) => {
        match ($left, math!(@one real $cx $x)) {
            (a, s) => $crate::vector::scale($cx, &a, s)
        }
    };
    (@times real $cx:ident ($left:tt div) $x:tt) => {
        match ($left, math!(@one real $cx $x)) { (a, b) => $cx.div(a, b, f64::INFINITY) }
    };
    (@times real $cx:ident ($left:tt mul) $x:tt) => {
        match ($left, math!(@one real $cx $x)) { (a, b) => $cx.mul(a, b) }
    };

    // One operand.
    (@one real $cx:ident (- $($x:tt)+)) => {
        match math!(@one real $cx ($($x)+)) { a => $cx.neg(a) }
    };
    (@one vector $cx:ident (- $($x:tt)+)) => {
        match math!(@one vector $cx ($($x)+)) { a => $crate::vector::neg($cx, &a) }
    };
    (@one real $cx:ident (! $($x:tt)+)) => {
        match math!(@one real $cx ($($x)+)) { a => $cx.not(a) }
    };
    (@one $k:ident $cx:ident (($($x:tt)+))) => {
        math!(@next {$k $cx () () () () ()} () $($x)+)
    };
    (@one real $cx:ident ($constant:literal)) => { $cx.real($constant) };
    (@one real $cx:ident (real($constant:expr))) => { $cx.real($constant) };
    (@one vector $cx:ident (constant($constant:expr))) => {
        $crate::vector::constant($cx, $constant)
    };
    (@one $k:ident $cx:ident ($f:ident($($x:tt)+))) => { math!(@call $k $cx $f [] () $($x)+) };
    (@one $k:ident $cx:ident ($rust:expr)) => { $rust };

    // A call's arguments, divided at their commas.
    (@call $k:ident $cx:ident $f:ident [$($arg:tt)*] $x:tt , $($rest:tt)+) => {
        math!(@call $k $cx $f [$($arg)* $x] () $($rest)+)
    };
    (@call $k:ident $cx:ident $f:ident [$($arg:tt)*] $x:tt $(,)?) => {
        math!(@apply $k $cx $f $($arg)* $x)
    };
    (@call $k:ident $cx:ident $f:ident $args:tt ($($x:tt)*) $token:tt $($rest:tt)*) => {
        math!(@call $k $cx $f $args ($($x)* $token) $($rest)*)
    };
    (@apply real $cx:ident div $a:tt $b:tt ($most:expr)) => {
        match (math!(@one real $cx ($a)), math!(@one real $cx ($b))) {
            (a, b) => $cx.div(a, b, $most)
        }
    };
    (@apply real $cx:ident scale $a:tt ($factor:expr)) => {
        match math!(@one real $cx ($a)) { a => $cx.scale(a, $factor) }
    };
    (@apply real $cx:ident known $a:tt ($low:expr) ($high:expr)) => {
        match math!(@one real $cx ($a)) { a => $cx.known(a, $low, $high) }
    };
    (@apply real $cx:ident length $a:tt) => {
        match math!(@one vector $cx ($a)) { a => $cx.length(a) }
    };
    (@apply real $cx:ident dot $a:tt $b:tt) => { math!(@two $cx dot $a $b) };
    (@apply vector $cx:ident mirror $a:tt $b:tt) => { math!(@two $cx mirror $a $b) };
    (@two $cx:ident $f:ident $a:tt $b:tt) => {
        match (math!(@one vector $cx ($a)), math!(@one vector $cx ($b))) {
            (a, b) => $crate::vector::$f($cx, &a, &b)
        }
    };
    (@apply real $cx:ident $f:ident $a:tt) => {
        match math!(@one real $cx ($a)) { a => $cx.$f(a) }
    };
    (@apply real $cx:ident $f:ident $a:tt $b:tt) => {
        match (math!(@one real $cx ($a)), math!(@one real $cx ($b))) { (a, b) => $cx.$f(a, b) }
    };
    (@apply real $cx:ident $f:ident $a:tt $b:tt $c:tt) => {
        match (math!(@one real $cx ($a)), math!(@one real $cx ($b)), math!(@one real $cx ($c))) {
            (a, b, c) => $cx.$f(a, b, c)
        }
    };

    ($cx:ident, $($formula:tt)+) => { math!(@next {real $cx () () () () ()} () $($formula)+) };
}

/// A vector, by a formula; see [the module](self).
macro_rules! vector {
    ($cx:ident, $($formula:tt)+) => { math!(@next {vector $cx () () () () ()} () $($formula)+) };
}

#[cfg(test)]
mod tests;
