//! The arithmetic that the tracer computes with.

use super::Sampled;
pub use qrt_scene::sampling::{Axis, Coordinate};
use qrt_syntax::expr::Function;

/// A stage of the tracer, as in the paper's figure, or a part of a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TracerPart {
    /// The ray of this depth: the camera's, or the one that a surface scatters.
    GenerateRay(usize),
    /// The nearest intersection of the ray of this depth.
    FindIntersection(usize),
    /// The point on a lamp that is sampled at the start of the ray of this depth. Also the part of its light
    /// that goes to the viewer if nothing stands between.
    SampleLight(usize),
    /// The test for anything between the start of the ray of this depth and the point on the lamp.
    Shadow(usize),
    /// One convex body (by number), within an intersection.
    Body(usize),
    /// One plane (by number) and the primitives on it, within an intersection.
    Plane(usize),
    /// One primitive (by number), within an intersection.
    Primitive(usize),
    /// One sphere (by its face's number), within an intersection.
    Ball(usize),
    /// All meshes whose edges are tested, within an intersection.
    Mesh,
    /// Edges of meshes (by the number of their group), within an intersection.
    Edges(usize),
    /// The plane of one face that the ray's line meets (by its place among these), within an intersection.
    Slot(usize),
    /// The light of the sky and the sun, at the end of the ray of this depth.
    Sky(usize),
    /// The light that the vertex at the end of the ray of this depth emits towards the camera.
    Shade(usize),
    /// The side on which the ray of this depth meets the surface.
    Side(usize),
    /// The interpolated normal where the ray of this depth meets a smooth face.
    Normal(usize),
    /// The interpolated tint of a face with colours at its vertices, within a ray or the sampling of a lamp.
    Tint,
    /// The sampled direction in the local frame, within a ray.
    Sample,
    /// One component of a vector, within a ray.
    Component(usize),
}

/// A number or a vector of a ray that has a name in the layout of registers. Variants are in the order of
/// names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// The ray's direction, a vector. Directions of the camera's rays have no particular length.
    Direction,
    /// The distance at which the ray meets a surface, in lengths of its direction.
    Distance,
    /// The number of the face that the ray meets.
    Face,
    /// True if the ray meets a surface, on a path that has not ended.
    Found,
    /// The cell of the unit square that samples the point on a lamp.
    Lamp,
    /// The cell of the unit square that samples the point on the camera's lens.
    Lens,
    /// The point where the ray starts, a vector in the scene's frame as the circuit scales it.
    Origin,
    /// The cell of the unit square that it samples: its two coordinates.
    Sample,
    /// The fraction of the light that the ray finds which reaches the camera, by channel.
    Throughput,
}

impl Quantity {
    /// The name of the quantity, such as `direction`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Direction => "direction",
            Self::Distance => "distance",
            Self::Face => "face",
            Self::Found => "found",
            Self::Lamp => "lamp",
            Self::Lens => "lens",
            Self::Origin => "origin",
            Self::Sample => "sample",
            Self::Throughput => "throughput",
        }
    }
}

/// A quantity of one ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Named {
    /// The number of bounces before the ray: 0 for the primary ray.
    pub depth: usize,
    /// The quantity.
    pub quantity: Quantity,
}

/// A part of the tracer that can run in a function of its own: see [`Arith::apart`].
pub trait Work<A: Arith> {
    /// The type of the result.
    type Output;
    /// Computes the result.
    fn run(self, cx: &mut A) -> Self::Output;
}

/// The arithmetic of a machine.
///
/// A value stands for one number *per path*: a lane of `f64`, or a register in superposition.
/// Plain Rust values (`f64`, `u32`, slices) are constants that every path shares, which a circuit
/// folds. Implementations must not depend on the values of paths for control flow, except through
/// [`Arith::any`].
pub trait Arith: Sized {
    /// A real number.
    type Real: Copy;
    /// A truth value.
    type Bool: Copy;
    /// A small unsigned integer: a face, a plane, a surface, a sample index.
    type Index: Copy;

    /// The constant `value`.
    fn real(&mut self, value: f64) -> Self::Real;
    /// `a + b`
    fn add(&mut self, a: Self::Real, b: Self::Real) -> Self::Real;
    /// `a - b`
    fn sub(&mut self, a: Self::Real, b: Self::Real) -> Self::Real;
    /// `a b`
    fn mul(&mut self, a: Self::Real, b: Self::Real) -> Self::Real;
    /// `a / b`, which lies within `-most ..= most` on the paths that use it. Arbitrary if it lies outside, or
    /// if `b` is zero.
    fn div(&mut self, a: Self::Real, b: Self::Real, most: f64) -> Self::Real;
    /// `a / b` in a user-defined formula, which lies within `-most ..= most`. If `most` is infinite, the
    /// divisor may be zero, and a machine without infinity rejects the formula.
    #[inline(always)]
    fn quotient(&mut self, a: Self::Real, b: Self::Real, most: f64) -> Self::Real {
        self.div(a, b, most)
    }
    /// Returns whether `a / b` is above 0, and the quotient. A quotient above `most` may count as not above 0:
    /// nothing is that far away.
    #[inline(always)]
    fn ahead(&mut self, a: Self::Real, b: Self::Real, most: f64) -> (Self::Bool, Self::Real) {
        let quotient = self.div(a, b, most);
        let zero = self.real(0.0);
        (self.less(zero, quotient), quotient)
    }
    /// `-a`
    fn neg(&mut self, a: Self::Real) -> Self::Real;
    /// `|a|`
    fn abs(&mut self, a: Self::Real) -> Self::Real;
    /// `sqrt(a)`; arbitrary if `a < 0`.
    fn sqrt(&mut self, a: Self::Real) -> Self::Real;
    /// The lesser of `a` and `b`.
    fn min(&mut self, a: Self::Real, b: Self::Real) -> Self::Real;
    /// The greater of `a` and `b`.
    fn max(&mut self, a: Self::Real, b: Self::Real) -> Self::Real;
    /// `factor a`, for a constant factor.
    #[inline(always)]
    fn scale(&mut self, a: Self::Real, factor: f64) -> Self::Real {
        let factor = self.real(factor);
        self.mul(a, factor)
    }
    /// `sqrt(x^2 + y^2 + z^2)`
    #[inline(always)]
    fn length(&mut self, v: [Self::Real; 3]) -> Self::Real {
        let square = super::vector::dot(self, &v, &v);
        self.sqrt(square)
    }
    /// `a`, which the tracer knows to lie in `low ..= high`, up to rounding.
    #[inline(always)]
    fn known(&mut self, a: Self::Real, _low: f64, _high: f64) -> Self::Real {
        a
    }
    /// `a`, a cosine that a user-defined formula reads. Floating-point machines clamp it to [-1, 1]: rounding
    /// may take it beyond, where the formula may be undefined. Registers need no clamp, because the last entry
    /// of a function's table stands for all values beyond.
    #[inline(always)]
    fn cosine(&mut self, a: Self::Real) -> Self::Real {
        a
    }
    /// The distance of no hit, greater than all others.
    #[inline(always)]
    fn t_max(&mut self, _most: f64) -> Self::Real {
        self.real(f64::MAX)
    }
    /// `low <= value <= high`, with bounds that may be infinite. A machine with coarse numbers widens the
    /// interval by its rounding error.
    #[inline(always)]
    fn inside(&mut self, low: f64, value: Self::Real, high: f64) -> Self::Bool {
        let low = self.real(low);
        let high = self.real(high);
        super::between(self, low, value, high)
    }
    /// `table[row] <= value`, widened like [`Arith::inside`].
    #[inline(always)]
    fn at_least(&mut self, value: Self::Real, table: &[[f64; 1]], row: Self::Index) -> Self::Bool {
        let [low] = self.rows(table, row);
        self.less_equal(low, value)
    }
    /// `value <= table[row]`, widened like [`Arith::inside`].
    #[inline(always)]
    fn at_most(&mut self, value: Self::Real, table: &[[f64; 1]], row: Self::Index) -> Self::Bool {
        let [high] = self.rows(table, row);
        self.less_equal(value, high)
    }
    /// The fraction of the way to its face's centre by which a hit is moved: see [`super::INWARD`].
    #[inline(always)]
    fn inward(&mut self) -> f64 {
        super::INWARD
    }
    /// Keeps `a` even if nothing reads it: for the paper's records of every primitive.
    #[inline(always)]
    fn record(&mut self, _a: Self::Real) {}
    /// Names the numbers `a` in the layout of registers.
    #[inline(always)]
    fn named<const K: usize>(&mut self, _name: Named, _a: &[Self::Real; K]) {}
    /// Names the truth value `a` in the layout of registers.
    #[inline(always)]
    fn named_truth(&mut self, _name: Named, _a: Self::Bool) {}
    /// Names the integer `a` in the layout of registers.
    #[inline(always)]
    fn named_index(&mut self, _name: Named, _a: Self::Index) {}
    /// Reports a ray of the path and its hit, for machines that need paths and not colours alone.
    #[inline(always)]
    fn traced(&mut self, _depth: usize, _segment: Segment<Self>) {}
    /// Sets the surface whose effect on light the next operations compute, or none. Their errors are errors of
    /// that surface's material.
    #[inline(always)]
    fn of_surface(&mut self, _surface: Option<u32>) {}
    /// Runs `work`. A machine may run it in a function of its own: the tracer is one function, and its compile
    /// time grows with its size.
    #[inline(always)]
    fn apart<W: Work<Self>>(&mut self, work: W) -> W::Output {
        work.run(self)
    }
    /// True if values of a part are recomputed after the part ends, rather than kept.
    #[inline(always)]
    fn recomputes(&self) -> bool {
        false
    }
    /// Begins `part`, which lasts until [`Arith::leave`].
    #[inline(always)]
    fn enter(&mut self, _part: TracerPart) {}
    /// Ends the part that the last open [`Arith::enter`] began.
    #[inline(always)]
    fn leave(&mut self) {}
    /// A function of the expression language.
    fn function(&mut self, function: Function, a: Self::Real) -> Self::Real;
    /// `a^b` for `a >= 0`.
    fn pow(&mut self, a: Self::Real, b: Self::Real) -> Self::Real;
    /// The angle of the vector `(x, y)`.
    fn atan2(&mut self, y: Self::Real, x: Self::Real) -> Self::Real;

    /// The constant `value`.
    fn truth(&mut self, value: bool) -> Self::Bool;
    /// `a < b`
    fn less(&mut self, a: Self::Real, b: Self::Real) -> Self::Bool;
    /// `a <= b`
    fn less_equal(&mut self, a: Self::Real, b: Self::Real) -> Self::Bool;
    /// True if `floor(a)` is odd.
    fn odd(&mut self, a: Self::Real) -> Self::Bool;
    /// `a && b`, both of which are computed.
    fn and(&mut self, a: Self::Bool, b: Self::Bool) -> Self::Bool;
    /// `a || b`, both of which are computed.
    fn or(&mut self, a: Self::Bool, b: Self::Bool) -> Self::Bool;
    /// `if c { a } else { b }`
    #[inline(always)]
    fn select_truth(&mut self, c: Self::Bool, a: Self::Bool, b: Self::Bool) -> Self::Bool {
        math!(self, c && a || !c && b)
    }
    /// `!a`
    fn not(&mut self, a: Self::Bool) -> Self::Bool;
    /// Returns whether `a` may hold on some path. A machine that knows the values may return false to skip work
    /// that changes nothing. A circuit returns true unless `a` is the constant false.
    fn any(&mut self, a: Self::Bool) -> bool;
    /// `if c { a } else { b }`
    fn select(&mut self, c: Self::Bool, a: Self::Real, b: Self::Real) -> Self::Real;

    /// The constant `value`.
    fn index(&mut self, value: u32) -> Self::Index;
    /// `if c { a } else { b }`
    fn select_index(&mut self, c: Self::Bool, a: Self::Index, b: Self::Index) -> Self::Index;
    /// `a == value`
    fn is(&mut self, a: Self::Index, value: u32) -> Self::Bool;
    /// `a == b`
    fn same(&mut self, a: Self::Index, b: Self::Index) -> Self::Bool;
    /// The first `most` of the marked integers whose truth value holds, in their order. A truth value tells
    /// for each whether it was found; if not, the integer is 0. Those that hold after these are ignored.
    fn encode(
        &mut self,
        marked: &[(Self::Bool, u32)],
        most: usize,
    ) -> Vec<(Self::Bool, Self::Index)> {
        let mut rest: Vec<Self::Bool> = marked.iter().map(|(holds, _)| *holds).collect();
        let mut all = Vec::with_capacity(most);
        for _ in 0..most {
            let (mut found, mut first) = (self.truth(false), self.index(0));
            for ((_, value), rest) in marked.iter().zip(&mut rest) {
                let taken = math!(self, *rest && !found);
                let value = self.index(*value);
                first = self.select_index(taken, value, first);
                found = self.or(found, taken);
                *rest = math!(self, *rest && !taken);
            }
            all.push((found, first));
        }
        all
    }
    /// `a < value`
    fn below(&mut self, a: Self::Index, value: u32) -> Self::Bool;
    /// Row `row` of a table of reals with `K` columns.
    fn rows<const K: usize>(&mut self, table: &[[f64; K]], row: Self::Index) -> [Self::Real; K];
    /// Entry `row` of a table of integers.
    fn entry(&mut self, table: &[u32], row: Self::Index) -> Self::Index;

    /// The index of a sample coordinate, `0..2^bits`, computed from the path index.
    fn coordinate(&mut self, coordinate: Coordinate) -> Self::Index;
    /// The cell centre `(index + 1/2) / 2^bits`.
    fn centre(&mut self, index: Self::Index, bits: u32) -> Self::Real;
    /// A function of one sample coordinate, by table where that is possible.
    fn sampled(&mut self, function: &Sampled, index: Self::Index) -> Self::Real;
    /// The pixel's column and row.
    fn pixel(&mut self) -> [Self::Real; 2];
}

/// A ray of a path and its hit: see [`Arith::traced`].
pub struct Segment<A: Arith> {
    /// The point where the ray starts, in stage units.
    pub origin: [A::Real; 3],
    /// The direction of the ray.
    pub direction: [A::Real; 3],
    /// True if the path has not ended before the ray.
    pub goes: A::Bool,
    /// True if the path has not ended before the ray, and the ray meets a face.
    pub found: A::Bool,
    /// As [`super::Hit::distance`].
    pub distance: A::Real,
    /// As [`super::Hit::face`].
    pub face: A::Index,
    /// As [`super::Hit::front`].
    pub front: Option<A::Bool>,
}

impl<A: Arith> Clone for Segment<A> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<A: Arith> Copy for Segment<A> {}
