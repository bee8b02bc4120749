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

#[inline(always)]
pub(crate) fn scale<A: Arith>(cx: &mut A, a: &Vector<A>, s: A::Real) -> Vector<A> {
    [cx.mul(a[0], s), cx.mul(a[1], s), cx.mul(a[2], s)]
}

#[inline(always)]
pub(crate) fn add<A: Arith>(cx: &mut A, a: &Vector<A>, b: &Vector<A>) -> Vector<A> {
    [cx.add(a[0], b[0]), cx.add(a[1], b[1]), cx.add(a[2], b[2])]
}

#[inline(always)]
pub(crate) fn sub<A: Arith>(cx: &mut A, a: &Vector<A>, b: &Vector<A>) -> Vector<A> {
    [cx.sub(a[0], b[0]), cx.sub(a[1], b[1]), cx.sub(a[2], b[2])]
}

#[inline(always)]
pub(crate) fn neg<A: Arith>(cx: &mut A, a: &Vector<A>) -> Vector<A> {
    [cx.neg(a[0]), cx.neg(a[1]), cx.neg(a[2])]
}

#[inline(always)]
pub(crate) fn select<A: Arith>(cx: &mut A, c: A::Bool, a: &Vector<A>, b: &Vector<A>) -> Vector<A> {
    [
        cx.select(c, a[0], b[0]),
        cx.select(c, a[1], b[1]),
        cx.select(c, a[2], b[2]),
    ]
}

#[inline(always)]
pub(crate) fn normalize<A: Arith>(cx: &mut A, a: &Vector<A>) -> Vector<A> {
    let square = dot(cx, a, a);
    let length = cx.sqrt(square);
    let one = cx.real(1.0);
    let inverse = cx.div(one, length);
    scale(cx, a, inverse)
}

/// `2 (a.b) b - a`: `a` mirrored at the axis `b`, a unit vector.
#[inline(always)]
pub(crate) fn mirror<A: Arith>(cx: &mut A, a: &Vector<A>, b: &Vector<A>) -> Vector<A> {
    let cos = dot(cx, a, b);
    let twice = cx.add(cos, cos);
    let along = scale(cx, b, twice);
    sub(cx, &along, a)
}
