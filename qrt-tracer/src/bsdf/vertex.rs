//! The vertex at which a path scatters, its local frame, and the choice among surfaces.

use crate::vector::{self, Vector};
use crate::{Arith, TracerPart};
use std::ops::Range;

/// The vertex at which a path scatters.
pub(crate) struct Vertex<A: Arith, const C: usize> {
    /// The direction in which the path arrived.
    pub(crate) arriving: Vector<A>,
    pub(crate) tangent: Vector<A>,
    pub(crate) bitangent: Vector<A>,
    pub(crate) normal: Vector<A>,
    /// The dot product of the arriving direction and `normal`.
    pub(crate) cos_theta: A::Real,
    /// The face's own normal, in a scene that has smooth faces.
    pub(crate) smooth: Option<SmoothHit<A>>,
    /// True if the viewer sees the front of the surface.
    pub(crate) front: A::Bool,
    pub(crate) surface: A::Index,
    /// The row of the surface's colour: its number, or the row of its second colour.
    pub(crate) tint: A::Index,
    /// The interpolated tint, in a scene that has coloured faces.
    pub(crate) painted: Option<Painted<A, C>>,
    /// The point, in a scene of which a surface reads it.
    pub(crate) point: Option<Vector<A>>,
    /// True for paths that have not ended.
    pub(crate) alive: A::Bool,
}

impl<A: Arith, const C: usize> Vertex<A, C> {
    /// Takes the tangents from a row of the stage's frames.
    #[inline(always)]
    pub(crate) fn stand(&mut self, &[tx, ty, tz, bx, by, bz, ..]: &[A::Real; 9]) {
        self.tangent = [tx, ty, tz];
        self.bitangent = [bx, by, bz];
    }

    /// True unless `direction` is on one side of a smooth face and on the other side of its normal.
    /// `None` in a scene without smooth faces. `crosses` is true for directions beyond the normal's plane.
    #[inline(always)]
    pub(crate) fn stays(
        &self,
        cx: &mut A,
        direction: &Vector<A>,
        crosses: Option<A::Bool>,
    ) -> Option<A::Bool> {
        let &SmoothHit { is, face_normal } = self.smooth.as_ref()?;
        let rise = math!(cx, dot(*direction, face_normal));
        let above = match crosses {
            None => self.front,
            Some(crosses) => math!(cx, select_truth(crosses, !self.front, self.front)),
        };
        // A lamp that is in the face's plane, up to rounding, does not light the face.
        Some(math!(
            cx,
            !is || select_truth(above, real(IN_PLANE) < rise, rise < real(-IN_PLANE))
        ))
    }
}

/// Greatest height over a smooth face's plane of a direction that counts as within the plane, in stage
/// units: above the rounding that bounds on the light of lamps allow.
const IN_PLANE: f64 = 4e-9;

/// The tint of a hit in a scene that has coloured faces.
pub(crate) struct Painted<A: Arith, const C: usize> {
    /// The interpolated albedo or reflectance, per channel.
    pub(crate) tint: [A::Real; C],
    /// True if the surface has a checker, whose tint replaces this one; `None` in a scene without checkers.
    pub(crate) checkered: Option<A::Bool>,
}

/// A hit in a scene that has smooth faces.
pub(crate) struct SmoothHit<A: Arith> {
    /// True if the face is smooth.
    pub(crate) is: A::Bool,
    /// The face's own normal.
    pub(crate) face_normal: Vector<A>,
}

/// A sampled direction, in the scene's frame, and its weight per channel.
pub(crate) struct Scattered<A: Arith, const C: usize> {
    /// True if the direction is beyond the surface; `None` if it never is, or in a scene without smooth
    /// faces.
    pub(crate) crosses: Option<A::Bool>,
    pub(crate) direction: Vector<A>,
    pub(crate) weight: [A::Real; C],
    /// The density with which its part of the lobe samples the direction. It is in units of `1 / pi`
    /// per steradian, and 0 if it is not requested.
    pub(crate) density: A::Real,
}

/// The paths on one of `surfaces`, if there may be any.
#[inline(always)]
pub(crate) fn members<A: Arith, const C: usize>(
    cx: &mut A,
    at: &Vertex<A, C>,
    surfaces: &Range<u32>,
) -> Option<A::Bool> {
    if surfaces.is_empty() {
        return None;
    }
    let mut mask = cx.below(at.surface, surfaces.end);
    if surfaces.start > 0 {
        mask = math!(cx, mask && !cx.below(at.surface, surfaces.start));
    }
    let wanted = cx.and(mask, at.alive);
    cx.any(wanted).then_some(mask)
}

/// The viewer's direction in the local frame.
#[inline(always)]
pub(super) fn local_outgoing<A: Arith, const C: usize>(cx: &mut A, at: &Vertex<A, C>) -> Vector<A> {
    let x = math!(cx, dot(at.arriving, at.tangent));
    let y = math!(cx, dot(at.arriving, at.bitangent));
    let z = cx.abs(at.cos_theta);
    [cx.neg(x), cx.neg(y), z]
}

/// `incoming.mirror(outgoing)`, in the local frame.
#[inline(always)]
pub(super) fn cos_to_mirror<A: Arith>(
    cx: &mut A,
    incoming: &Vector<A>,
    outgoing: &Vector<A>,
) -> A::Real {
    let [x, y, z] = vector::mul(cx, incoming, outgoing);
    math!(cx, z - (x + y))
}

/// From the local frame to the scene's: `x T + y B + z N` on the viewer's side.
#[inline(always)]
pub(super) fn to_scene<A: Arith, const C: usize>(
    cx: &mut A,
    at: &Vertex<A, C>,
    local: &Vector<A>,
) -> Vector<A> {
    let height = math!(cx, select(at.front, local[2], -local[2]));
    let local = [local[0], local[1], height];
    [
        component(cx, at, &local, 0),
        component(cx, at, &local, 1),
        component(cx, at, &local, 2),
    ]
}

#[inline(always)]
fn component<A: Arith, const C: usize>(
    cx: &mut A,
    at: &Vertex<A, C>,
    local: &Vector<A>,
    axis: usize,
) -> A::Real {
    cx.enter(TracerPart::Component(axis));
    let frame = [at.tangent[axis], at.bitangent[axis], at.normal[axis]];
    let sum = math!(cx, known(dot(frame, *local), -1.0, 1.0));
    cx.leave();
    sum
}
