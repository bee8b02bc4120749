//! Three-vectors over [`Arith`], written with [`vector!`](super::math).

use super::Arith;

/// Components x, y, z.
pub(crate) type Vector<A> = [<A as Arith>::Real; 3];

/// The first `N` components, at most three, by an expression of their number `k`.
///
/// Neither closures nor loops: a closure is a function without the lanes' instruction set until
/// it is inlined, and the many short loops of a whole tracer cost minutes of compiling.
macro_rules! components {
    ($first:expr, $k:ident => $component:expr) => {{
        const { assert!(N <= 3) };
        let mut result = $first;
        if N > 0 {
            let $k = 0;
            result[$k] = $component;
        }
        if N > 1 {
            let $k = 1;
            result[$k] = $component;
        }
        if N > 2 {
            let $k = 2;
            result[$k] = $component;
        }
        result
    }};
}

pub(crate) use components;

#[inline(always)]
pub(crate) fn constant<A: Arith>(cx: &mut A, v: [f64; 3]) -> Vector<A> {
    [cx.real(v[0]), cx.real(v[1]), cx.real(v[2])]
}

/// The dot product of two vectors.
#[inline(always)]
pub fn dot<A: Arith>(cx: &mut A, a: &Vector<A>, b: &Vector<A>) -> A::Real {
    let [x, y, z] = mul(cx, a, b);
    math!(cx, x + y + z)
}

/// `s` times each component.
#[inline(always)]
pub(crate) fn scale<A: Arith, const N: usize>(
    cx: &mut A,
    a: &[A::Real; N],
    s: A::Real,
) -> [A::Real; N] {
    mul(cx, a, &[s; N])
}

/// The operation of this name, component by component.
#[inline(always)]
pub(crate) fn mul<A: Arith, const N: usize>(
    cx: &mut A,
    a: &[A::Real; N],
    b: &[A::Real; N],
) -> [A::Real; N] {
    components!(*a, k => cx.mul(a[k], b[k]))
}

/// The operation of this name, component by component.
#[inline(always)]
pub(crate) fn add<A: Arith, const N: usize>(
    cx: &mut A,
    a: &[A::Real; N],
    b: &[A::Real; N],
) -> [A::Real; N] {
    components!(*a, k => cx.add(a[k], b[k]))
}

/// The operation of this name, component by component.
#[inline(always)]
pub(crate) fn sub<A: Arith, const N: usize>(
    cx: &mut A,
    a: &[A::Real; N],
    b: &[A::Real; N],
) -> [A::Real; N] {
    components!(*a, k => cx.sub(a[k], b[k]))
}

/// The operation of this name, component by component.
#[inline(always)]
pub(crate) fn neg<A: Arith, const N: usize>(cx: &mut A, a: &[A::Real; N]) -> [A::Real; N] {
    components!(*a, k => cx.neg(a[k]))
}

/// The operation of this name, component by component.
#[inline(always)]
pub(crate) fn select<A: Arith, const N: usize>(
    cx: &mut A,
    c: A::Bool,
    a: &[A::Real; N],
    b: &[A::Real; N],
) -> [A::Real; N] {
    components!(*a, k => cx.select(c, a[k], b[k]))
}

/// A vector of unit length, up to rounding.
#[inline(always)]
pub(crate) fn unit<A: Arith>(cx: &mut A, a: &Vector<A>) -> Vector<A> {
    [
        cx.known(a[0], -1.0, 1.0),
        cx.known(a[1], -1.0, 1.0),
        cx.known(a[2], -1.0, 1.0),
    ]
}

/// `a` over its length, which is at least `1 / longest`.
#[inline(always)]
pub(crate) fn normalize<A: Arith>(cx: &mut A, a: &Vector<A>, longest: f64) -> Vector<A> {
    let scaled = vector!(cx, *a * div(1.0, length(*a), longest));
    unit(cx, &scaled)
}

/// `2 (a.b) b - a`: `a` mirrored at the axis `b`, a unit vector.
#[inline(always)]
pub(crate) fn mirror<A: Arith>(cx: &mut A, a: &Vector<A>, b: &Vector<A>) -> Vector<A> {
    let cos = dot(cx, a, b);
    vector!(cx, *b * (cos + cos) - *a)
}
