//! Three-vectors over [`Arith`].

use super::Arith;

/// Components x, y, z.
pub(crate) type Vector<A> = [<A as Arith>::Real; 3];

#[inline(always)]
pub(crate) fn constant<A: Arith>(cx: &mut A, v: [f64; 3]) -> Vector<A> {
    [cx.real(v[0]), cx.real(v[1]), cx.real(v[2])]
}

#[inline(always)]
pub(crate) fn dot<A: Arith>(cx: &mut A, a: &Vector<A>, b: &Vector<A>) -> A::Real {
    let x = cx.mul(a[0], b[0]);
    let y = cx.mul(a[1], b[1]);
    let z = cx.mul(a[2], b[2]);
    let xy = cx.add(x, y);
    cx.add(xy, z)
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

/// Component by component.
#[inline(always)]
pub(crate) fn mul<A: Arith, const N: usize>(
    cx: &mut A,
    a: &[A::Real; N],
    b: &[A::Real; N],
) -> [A::Real; N] {
    // Neither closures nor loops: a closure is a function without the lanes' instruction set until
    // it is inlined, and the many short loops of a whole tracer cost minutes of compiling.
    const { assert!(N <= 3) };
    let mut product = *a;
    if N > 0 {
        product[0] = cx.mul(a[0], b[0]);
    }
    if N > 1 {
        product[1] = cx.mul(a[1], b[1]);
    }
    if N > 2 {
        product[2] = cx.mul(a[2], b[2]);
    }
    product
}

/// Component by component.
#[inline(always)]
pub(crate) fn add<A: Arith, const N: usize>(
    cx: &mut A,
    a: &[A::Real; N],
    b: &[A::Real; N],
) -> [A::Real; N] {
    const { assert!(N <= 3) };
    let mut sum = *a;
    if N > 0 {
        sum[0] = cx.add(a[0], b[0]);
    }
    if N > 1 {
        sum[1] = cx.add(a[1], b[1]);
    }
    if N > 2 {
        sum[2] = cx.add(a[2], b[2]);
    }
    sum
}

#[inline(always)]
pub(crate) fn sub<A: Arith>(cx: &mut A, a: &Vector<A>, b: &Vector<A>) -> Vector<A> {
    [cx.sub(a[0], b[0]), cx.sub(a[1], b[1]), cx.sub(a[2], b[2])]
}

#[inline(always)]
pub(crate) fn neg<A: Arith>(cx: &mut A, a: &Vector<A>) -> Vector<A> {
    [cx.neg(a[0]), cx.neg(a[1]), cx.neg(a[2])]
}

/// Component by component.
#[inline(always)]
pub(crate) fn select<A: Arith, const N: usize>(
    cx: &mut A,
    c: A::Bool,
    a: &[A::Real; N],
    b: &[A::Real; N],
) -> [A::Real; N] {
    const { assert!(N <= 3) };
    let mut chosen = *a;
    if N > 0 {
        chosen[0] = cx.select(c, a[0], b[0]);
    }
    if N > 1 {
        chosen[1] = cx.select(c, a[1], b[1]);
    }
    if N > 2 {
        chosen[2] = cx.select(c, a[2], b[2]);
    }
    chosen
}

/// `a` over its length, which is at least `1 / longest`.
#[inline(always)]
pub(crate) fn normalize<A: Arith>(cx: &mut A, a: &Vector<A>, longest: f64) -> Vector<A> {
    let length = cx.length(*a);
    let one = cx.real(1.0);
    let inverse = cx.div(one, length, longest);
    let [x, y, z] = scale(cx, a, inverse);
    [
        cx.known(x, -1.0, 1.0),
        cx.known(y, -1.0, 1.0),
        cx.known(z, -1.0, 1.0),
    ]
}

/// `2 (a.b) b - a`: `a` mirrored at the axis `b`, a unit vector.
#[inline(always)]
pub(crate) fn mirror<A: Arith>(cx: &mut A, a: &Vector<A>, b: &Vector<A>) -> Vector<A> {
    let cos = dot(cx, a, b);
    let twice = cx.add(cos, cos);
    let along = scale(cx, b, twice);
    sub(cx, &along, a)
}
