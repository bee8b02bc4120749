//! What the tracer computes with.

use super::Sampled;
use crate::expr::Function;

/// Which of a depth's two sample coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The first: the radial one of the built-in maps; to the right on the film.
    U,
    /// The second: the azimuthal one of the built-in maps; downwards on the film.
    V,
}

/// A sample coordinate of a path: its depth (0 is the primary ray) and axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Coordinate {
    /// Depth of the ray it samples.
    pub depth: usize,
    /// Which of the two.
    pub axis: Axis,
}

impl Coordinate {
    /// Its dimension in a sequence: `2 depth` for `u`, `2 depth + 1` for `v`.
    pub fn dimension(self) -> usize {
        2 * self.depth + usize::from(self.axis == Axis::V)
    }
}

/// The arithmetic of a machine.
///
/// A value stands for one number *per path*: a lane of `f64`, or a register in superposition.
/// Plain Rust values (`f64`, `u32`, slices) are constants that every path shares, which a circuit
/// folds. Implementations must not depend on the values of paths for control flow, except through
/// [`Arith::possible`].
pub trait Arith {
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
    /// `a / b`; anything where `b` is zero.
    fn div(&mut self, a: Self::Real, b: Self::Real) -> Self::Real;
    /// `-a`
    fn neg(&mut self, a: Self::Real) -> Self::Real;
    /// `|a|`
    fn abs(&mut self, a: Self::Real) -> Self::Real;
    /// `sqrt(a)`; anything where `a < 0`.
    fn sqrt(&mut self, a: Self::Real) -> Self::Real;
    /// The lesser.
    fn min(&mut self, a: Self::Real, b: Self::Real) -> Self::Real;
    /// The greater.
    fn max(&mut self, a: Self::Real, b: Self::Real) -> Self::Real;
    /// `factor a`, for a constant factor.
    #[inline(always)]
    fn scale(&mut self, a: Self::Real, factor: f64) -> Self::Real {
        let factor = self.real(factor);
        self.mul(a, factor)
    }
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
    /// Conjunction.
    fn and(&mut self, a: Self::Bool, b: Self::Bool) -> Self::Bool;
    /// Disjunction.
    fn or(&mut self, a: Self::Bool, b: Self::Bool) -> Self::Bool;
    /// Negation.
    fn not(&mut self, a: Self::Bool) -> Self::Bool;
    /// May `a` hold for some path? A machine that knows the values may answer "no" and so spare
    /// work that could change nothing; a circuit always answers "yes".
    fn possible(&mut self, a: Self::Bool) -> bool;
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

    /// The index of a sample coordinate, `0..2^bits`: from the path's id alone.
    fn coordinate(&mut self, coordinate: Coordinate) -> Self::Index;
    /// The cell centre `(index + 1/2) / 2^bits`.
    fn centre(&mut self, index: Self::Index, bits: u32) -> Self::Real;
    /// A function of one sample coordinate, by table where that is possible.
    fn sampled(&mut self, function: &Sampled, index: Self::Index) -> Self::Real;
    /// The pixel's column and row.
    fn pixel(&mut self) -> [Self::Real; 2];
}
