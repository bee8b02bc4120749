//! What the tracer computes with.

use super::{Sampled, Segment};
use crate::expr::Function;
pub use crate::sampling::{Axis, Coordinate};

/// A stage of the tracer, as the paper's figure has it, or a part of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The ray of this depth: the camera's, or what a surface scatters.
    GenerateRay(usize),
    /// The nearest intersection of the ray of this depth.
    FindIntersection(usize),
    /// The point on a lamp that the start of the ray of this depth is connected to, and what of
    /// its light goes to the viewer if nothing stands between.
    SampleLight(usize),
    /// Whether anything stands between.
    Shadow(usize),
    /// One convex body (by number), within an intersection.
    Body(usize),
    /// One plane (by number) and the primitives on it, within an intersection.
    Plane(usize),
    /// One primitive (by number), within an intersection.
    Primitive(usize),
    /// What the vertex at the end of the ray of this depth emits towards the camera.
    Shade(usize),
    /// On which side the ray of this depth meets the surface.
    Side(usize),
    /// The sampled direction in the local frame, within a ray.
    Sample,
    /// One component of a vector, within a ray.
    Component(usize),
}

/// A number or a vector of a ray that has a name in the layout of registers; in the order of names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// Where it goes: a vector; the camera's are of no particular length.
    Direction,
    /// How far away it meets a surface, in lengths of its direction.
    Distance,
    /// The face that it meets, by number.
    Face,
    /// Whether it meets a surface, on a path that has not ended.
    Found,
    /// The cell of the unit square that samples the point on a lamp.
    Lamp,
    /// Where it starts: a vector, in the scene's frame as the circuit scales it.
    Origin,
    /// The cell of the unit square that it samples: its two coordinates.
    Sample,
    /// The fraction of what it finds that reaches the camera, by channel.
    Throughput,
}

impl Quantity {
    /// `direction`
    pub const fn name(self) -> &'static str {
        match self {
            Self::Direction => "direction",
            Self::Distance => "distance",
            Self::Face => "face",
            Self::Found => "found",
            Self::Lamp => "lamp",
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
    /// Which quantity.
    pub quantity: Quantity,
}

/// A part of the tracer that can be done in a function of its own: see [`Arith::apart`].
pub trait Work<A: Arith> {
    /// What it computes.
    type Output;
    /// Does it.
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
    /// `a / b`, which lies within `-most ..= most` wherever it matters; anything where it does not,
    /// or where `b` is zero.
    fn div(&mut self, a: Self::Real, b: Self::Real, most: f64) -> Self::Real;
    /// `a / b` of an author's formula, which lies within `-most ..= most`. Without a bound, the divisor may
    /// be zero, and a machine that holds no infinity refuses the formula.
    #[inline(always)]
    fn quotient(&mut self, a: Self::Real, b: Self::Real, most: f64) -> Self::Real {
        self.div(a, b, most)
    }
    /// Whether `a / b` is above 0, and the quotient itself. One above `most` may be told as not
    /// above 0: nothing is that far away.
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
    /// `sqrt(a)`; anything where `a < 0`.
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
    /// `a`, of which the tracer knows that it lies in `low ..= high`, up to rounding.
    #[inline(always)]
    fn known(&mut self, a: Self::Real, _low: f64, _high: f64) -> Self::Real {
        a
    }
    /// `a`, a cosine that an author's formula takes. Floating-point machines clamp it to -1 and 1: rounding may
    /// take it beyond, where the formula need not be defined. Registers need not, for the last entry of a
    /// function's table stands for all beyond.
    #[inline(always)]
    fn cosine(&mut self, a: Self::Real) -> Self::Real {
        a
    }
    /// A distance beyond everything: that of no hit.
    #[inline(always)]
    fn t_max(&mut self, _most: f64) -> Self::Real {
        self.real(f64::MAX)
    }
    /// `low <= value <= high`, with bounds that may be infinite; a machine whose numbers are coarse
    /// reaches outwards by what it rounds.
    #[inline(always)]
    fn inside(&mut self, low: f64, value: Self::Real, high: f64) -> Self::Bool {
        let low = self.real(low);
        let high = self.real(high);
        super::between(self, low, value, high)
    }
    /// `table[row] <= value`, reaching outwards as [`Arith::inside`] does.
    #[inline(always)]
    fn at_least(&mut self, value: Self::Real, table: &[[f64; 1]], row: Self::Index) -> Self::Bool {
        let [low] = self.rows(table, row);
        self.less_equal(low, value)
    }
    /// `value <= table[row]`, reaching outwards as [`Arith::inside`] does.
    #[inline(always)]
    fn at_most(&mut self, value: Self::Real, table: &[[f64; 1]], row: Self::Index) -> Self::Bool {
        let [high] = self.rows(table, row);
        self.less_equal(value, high)
    }
    /// How far a hit is moved towards its face's centre, as a fraction of the way: see
    /// [`super::INWARD`].
    #[inline(always)]
    fn inward(&mut self) -> f64 {
        super::INWARD
    }
    /// Keeps `a`, though nothing may need it: the paper's records of every primitive.
    #[inline(always)]
    fn record(&mut self, _a: Self::Real) {}
    /// What `a` is, in the layout of registers.
    #[inline(always)]
    fn named<const K: usize>(&mut self, _name: Named, _a: &[Self::Real; K]) {}
    /// What `a` is, in the layout of registers.
    #[inline(always)]
    fn named_truth(&mut self, _name: Named, _a: Self::Bool) {}
    /// What `a` is, in the layout of registers.
    #[inline(always)]
    fn named_index(&mut self, _name: Named, _a: Self::Index) {}
    /// A ray of the path, and what it meets: for machines that are asked about paths, not about
    /// colours alone.
    #[inline(always)]
    fn traced(&mut self, _depth: usize, _segment: Segment<Self>) {}
    /// What follows is what this surface alone makes of light, until it is said of none: what is
    /// wrong there is wrong with its material.
    #[inline(always)]
    fn of_surface(&mut self, _surface: Option<u32>) {}
    /// Does `work`. A machine may do it in a function of its own: the tracer is one function, and
    /// takes a compiler the longer the larger it is.
    #[inline(always)]
    fn apart<W: Work<Self>>(&mut self, work: W) -> W::Output {
        work.run(self)
    }
    /// Whether what was computed in a part that is left is asked for again rather than kept.
    #[inline(always)]
    fn recomputes(&self) -> bool {
        false
    }
    /// What follows belongs to `part`, until [`Arith::leave`].
    #[inline(always)]
    fn enter(&mut self, _part: Part) {}
    /// The end of what the last open [`Arith::enter`] began.
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
    /// Whether `a` may hold for some path. A machine that knows the values may return false and so
    /// spare work that could change nothing; a circuit always returns true.
    fn any(&mut self, a: Self::Bool) -> bool;
    /// `if c { a } else { b }`
    fn select(&mut self, c: Self::Bool, a: Self::Real, b: Self::Real) -> Self::Real;

    /// The constant `value`.
    fn index(&mut self, value: u32) -> Self::Index;
    /// `if c { a } else { b }`
    fn select_index(&mut self, c: Self::Bool, a: Self::Index, b: Self::Index) -> Self::Index;
    /// `a == value`
    fn is(&mut self, a: Self::Index, value: u32) -> Self::Bool;
    /// `a < value`
    fn below(&mut self, a: Self::Index, value: u32) -> Self::Bool;
    /// Row `row` of a table of reals with `K` columns.
    fn rows<const K: usize>(&mut self, table: &[[f64; K]], row: Self::Index) -> [Self::Real; K];
    /// Entry `row` of a table of integers.
    fn entry(&mut self, table: &[u32], row: Self::Index) -> Self::Index;

    /// The index of a sample coordinate, `0..2^bits`: from the path index alone.
    fn coordinate(&mut self, coordinate: Coordinate) -> Self::Index;
    /// The cell centre `(index + 1/2) / 2^bits`.
    fn centre(&mut self, index: Self::Index, bits: u32) -> Self::Real;
    /// A function of one sample coordinate, by table where that is possible.
    fn sampled(&mut self, function: &Sampled, index: Self::Index) -> Self::Real;
    /// The pixel's column and row.
    fn pixel(&mut self) -> [Self::Real; 2];
}
