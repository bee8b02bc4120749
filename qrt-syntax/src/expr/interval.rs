//! Intervals: bounds of an expression over intervals of its variables, rounded outward so that they
//! are proofs.
//!
//! Every operation returns an interval that encloses all its values for operands within theirs, or
//! none if it has no value (the root of a negative number). Bounds are infinite if none is known.

use super::{Expr, ExprNode, Function, Id, Variable};

/// All numbers from `lo` to `hi`, both included; no NaN; `lo <= hi`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Interval {
    pub lo: f64,
    pub hi: f64,
}

/// An interval for each variable.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Domain {
    pub u: Interval,
    pub v: Interval,
    pub cos_i: Interval,
    pub cos_o: Interval,
    pub cos_a: Interval,
    pub x: Interval,
    pub y: Interval,
    pub z: Interval,
}

impl Default for Domain {
    /// The whole domain: u, v, cos_i, cos_o in [0, 1], cos_a in [-1, 1], and all points.
    fn default() -> Self {
        let unit = Interval { lo: 0.0, hi: 1.0 };
        let cos_a = Interval { lo: -1.0, hi: 1.0 };
        let any = Interval {
            lo: f64::NEG_INFINITY,
            hi: f64::INFINITY,
        };
        Self {
            u: unit,
            v: unit,
            cos_i: unit,
            cos_o: unit,
            cos_a,
            x: any,
            y: any,
            z: any,
        }
    }
}

impl Domain {
    /// The interval of `variable`.
    pub fn get(&self, variable: Variable) -> Interval {
        match variable {
            Variable::U => self.u,
            Variable::V => self.v,
            Variable::CosI => self.cos_i,
            Variable::CosO => self.cos_o,
            Variable::CosA => self.cos_a,
            Variable::X => self.x,
            Variable::Y => self.y,
            Variable::Z => self.z,
        }
    }

    /// The interval of `variable`, mutable.
    pub fn get_mut(&mut self, variable: Variable) -> &mut Interval {
        match variable {
            Variable::U => &mut self.u,
            Variable::V => &mut self.v,
            Variable::CosI => &mut self.cos_i,
            Variable::CosO => &mut self.cos_o,
            Variable::CosA => &mut self.cos_a,
            Variable::X => &mut self.x,
            Variable::Y => &mut self.y,
            Variable::Z => &mut self.z,
        }
    }
}

impl Expr {
    /// An interval that holds every value that the expression has on `domain`: a proof, not an
    /// estimate, but not the tightest. `None` if it has no value there.
    ///
    /// ```
    /// use qrt_syntax::expr::{Domain, Expr, Variable};
    /// let e = Expr::parse("1 + 2*u", &Variable::SQUARE).unwrap();
    /// let range = e.range(&Domain::default()).unwrap();
    /// assert!(range.lo <= 1.0 && range.lo > 0.999 && range.hi >= 3.0 && range.hi < 3.001);
    /// ```
    pub fn range(&self, domain: &Domain) -> Option<Interval> {
        self.ranges(domain)[self.root.index()]
    }

    /// Returns the range of every node, as [`Expr::range`] does for the root.
    pub fn ranges(&self, domain: &Domain) -> Vec<Option<Interval>> {
        let mut ranges: Vec<Option<Interval>> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let range = node.range(domain, |id| ranges[id.index()]);
            ranges.push(range);
        }
        ranges
    }
}

impl ExprNode {
    fn range(&self, domain: &Domain, of: impl Fn(Id) -> Option<Interval>) -> Option<Interval> {
        match *self {
            Self::Number(value) => Some(Interval::point(value)),
            Self::Variable(variable) => Some(domain.get(variable)),
            Self::Neg(a) => Some(-of(a)?),
            Self::Add(a, b) => Some(of(a)?.plus(of(b)?)),
            Self::Sub(a, b) => Some(of(a)?.plus(-of(b)?)),
            Self::Mul(a, b) => Some(of(a)?.times(of(b)?)),
            Self::Div(a, b) => Some(of(a)?.over(of(b)?)),
            Self::Powi(a, n) => Some(of(a)?.powi(n)),
            Self::Pow(a, b) => of(a)?.pow(of(b)?),
            Self::Sqrt(a) => of(a)?.sqrt(),
            Self::Abs(a) => Some(of(a)?.abs()),
            Self::Min(a, b) => {
                let (a, b) = (of(a)?, of(b)?);
                Some(Interval {
                    lo: least(a.lo, b.lo),
                    hi: a.hi.min(b.hi),
                })
            }
            Self::Max(a, b) => {
                let (a, b) = (of(a)?, of(b)?);
                Some(Interval {
                    lo: a.lo.max(b.lo),
                    hi: a.hi.max(b.hi),
                })
            }
            Self::Function(f, a) => of(a)?.apply(f),
            Self::Atan2(a, b) => Some(of(a)?.atan2(of(b)?)),
            Self::IfLess(a, b, x, y) => {
                let (a, b) = (of(a)?, of(b)?);
                if a.hi < b.lo {
                    of(x)
                } else if a.lo >= b.hi {
                    of(y)
                } else {
                    match (of(x), of(y)) {
                        (Some(x), Some(y)) => Some(x.hull(y)),
                        (x, y) => x.or(y),
                    }
                }
            }
        }
    }
}

impl std::ops::Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            lo: -self.hi,
            hi: -self.lo,
        }
    }
}

/// The lesser of two bounds. Of two zeros it is -0.0, if one is: a quotient by -0.0 is negative.
fn least(a: f64, b: f64) -> f64 {
    match a == b {
        true if a.is_sign_negative() => a,
        true => b,
        false => a.min(b),
    }
}

/// Assumed error of libm's functions, in ulps: they are right to one, and four leave a margin.
const LIBM_ULPS: u32 = 4;

impl Interval {
    /// The interval of all numbers.
    pub const ALL: Self = Self {
        lo: f64::NEG_INFINITY,
        hi: f64::INFINITY,
    };

    /// The interval of one number alone.
    pub fn point(value: f64) -> Self {
        Self {
            lo: value,
            hi: value,
        }
    }

    /// The least interval that holds both.
    pub(crate) fn hull(self, other: Self) -> Self {
        Self {
            lo: least(self.lo, other.lo),
            hi: -least(-self.hi, -other.hi),
        }
    }

    /// True if the interval contains `value`.
    pub fn contains(self, value: f64) -> bool {
        self.lo <= value && value <= self.hi
    }

    /// Returns an interval that is wider by `ulps`; a NaN bound becomes infinite.
    fn outward_by(mut lo: f64, mut hi: f64, ulps: u32) -> Self {
        for _ in 0..ulps {
            lo = lo.next_down();
            hi = hi.next_up();
        }
        Self {
            lo: if lo.is_nan() { f64::NEG_INFINITY } else { lo },
            hi: if hi.is_nan() { f64::INFINITY } else { hi },
        }
    }

    /// Returns the interval around a result that was rounded to `value`, where `lost` has the sign
    /// of the rounding error. Exact results stay exact, so that `1 - u` is known to be at least 0.
    fn around(value: f64, lost: f64) -> Self {
        let known = value.is_finite() && (value == 0.0 || value.abs() > 1e-280);
        if !known || lost.is_nan() {
            return Self::outward_by(value, value, 1);
        }
        Self {
            lo: if lost < 0.0 { value.next_down() } else { value },
            hi: if lost > 0.0 { value.next_up() } else { value },
        }
    }

    /// Clamps the interval to the range of a function.
    fn within(self, lo: f64, hi: f64) -> Self {
        Self {
            lo: self.lo.clamp(lo, hi),
            hi: self.hi.clamp(lo, hi),
        }
    }

    /// The interval of all sums of two numbers, one of each interval.
    pub fn plus(self, other: Self) -> Self {
        // Knuth's exact sum: the rounding error of a + b.
        let sum = |a: f64, b: f64| {
            let sum = a + b;
            let rest = sum - a;
            Self::around(sum, (a - (sum - rest)) + (b - rest))
        };
        Self {
            lo: sum(self.lo, other.lo).lo,
            hi: sum(self.hi, other.hi).hi,
        }
    }

    /// The interval of all products of two numbers, one of each interval.
    pub fn times(self, other: Self) -> Self {
        let product = |a: f64, b: f64| {
            // The bound 0 times the bound infinity is 0: infinity stands for large numbers.
            if a == 0.0 || b == 0.0 {
                return Self::point(0.0);
            }
            let product = a * b;
            let around = Self::around(product, a.mul_add(b, -product));
            if (a > 0.0) == (b > 0.0) {
                around.within(0.0, f64::INFINITY)
            } else {
                around.within(f64::NEG_INFINITY, 0.0)
            }
        };
        let is_point = |interval: Self| interval.lo == interval.hi;
        if is_point(self) && is_point(other) {
            return product(self.lo, other.lo);
        }
        // Rounding keeps order.
        if self.lo >= 0.0 && other.lo >= 0.0 {
            return Self {
                lo: product(self.lo, other.lo).lo,
                hi: product(self.hi, other.hi).hi,
            };
        }
        product(self.lo, other.lo)
            .hull(product(self.lo, other.hi))
            .hull(product(self.hi, other.lo))
            .hull(product(self.hi, other.hi))
    }

    pub(super) fn over(self, other: Self) -> Self {
        // The divisor has both signs, if only in 0.0 and -0.0. A difference that is zero is 0.0 and
        // not -0.0, also if it is at most zero. An infinite quotient may end as a finite angle.
        if other.hi >= 0.0 && (other.lo.is_sign_negative() || other.hi == 0.0) {
            return Self::ALL;
        }
        if other.hi < 0.0 {
            return (-self).over(-other);
        }
        // Now 0 <= other.lo and 0 < other.hi.
        let quotient = |a: f64, b: f64| {
            if a == 0.0 || b == f64::INFINITY {
                return Self::point(0.0);
            }
            let quotient = a / b;
            let around = Self::around(quotient, (-quotient).mul_add(b, a));
            if a > 0.0 {
                around.within(0.0, f64::INFINITY)
            } else {
                around.within(f64::NEG_INFINITY, 0.0)
            }
        };
        // Avoid -0.0, so that quotients by this bound have the right sign.
        let (least, most) = (other.lo.abs(), other.hi);
        Self {
            lo: quotient(self.lo, if self.lo < 0.0 { least } else { most }).lo,
            hi: quotient(self.hi, if self.hi < 0.0 { most } else { least }).hi,
        }
    }

    pub(super) fn abs(self) -> Self {
        if self.lo >= 0.0 {
            self
        } else if self.hi <= 0.0 {
            -self
        } else {
            Self {
                lo: 0.0,
                hi: self.hi.max(-self.lo),
            }
        }
    }

    pub(super) fn sqrt(self) -> Option<Self> {
        if self.hi < 0.0 {
            return None;
        }
        let root = |x: f64| {
            let root = x.sqrt();
            Self::around(root, (-root).mul_add(root, x)).within(0.0, f64::INFINITY)
        };
        Some(Self {
            lo: root(self.lo.max(0.0)).lo,
            hi: root(self.hi).hi,
        })
    }

    pub(super) fn powi(self, n: i32) -> Self {
        if n == 0 {
            return Self::point(1.0);
        }
        if n < 0 {
            return Self::point(1.0).over(self.positive_powi(n.unsigned_abs()));
        }
        self.positive_powi(n.unsigned_abs())
    }

    /// The power by the interval products of repeated squaring, so that their rounding is covered.
    fn positive_powi(self, n: u32) -> Self {
        let power = |x: f64| {
            let mut square = Self::point(x);
            for _ in 0..n.trailing_zeros() {
                square = square.times(square);
            }
            let mut result = square;
            let mut bits = n.checked_shr(n.trailing_zeros() + 1).unwrap_or(0);
            while bits != 0 {
                square = square.times(square);
                if bits & 1 != 0 {
                    result = result.times(square);
                }
                bits >>= 1;
            }
            result
        };
        let base = if n.is_multiple_of(2) {
            self.abs()
        } else {
            self
        };
        Self {
            lo: power(base.lo).lo,
            hi: power(base.hi).hi,
        }
    }

    pub(super) fn pow(self, exponent: Self) -> Option<Self> {
        if exponent.lo == exponent.hi && exponent.lo == exponent.lo.trunc() {
            let n = exponent.lo;
            if n.abs() <= i32::MAX.into() {
                return Some(self.powi(n as i32));
            }
            return Some(Self::ALL);
        }
        if self.lo < 0.0 {
            // Negative numbers have only integer powers.
            let integers = exponent.lo.ceil() <= exponent.hi.floor();
            if integers {
                return Some(Self::ALL);
            }
        }
        if self.hi < 0.0 {
            return None;
        }
        // Monotone in each operand on either side of 1 and of 0: extremes are at corners.
        // Avoid -0.0, whose powers may be negative.
        let base = Self {
            lo: self.lo.max(0.0).abs(),
            hi: self.hi.abs(),
        };
        let corners = [
            libm::pow(base.lo, exponent.lo),
            libm::pow(base.lo, exponent.hi),
            libm::pow(base.hi, exponent.lo),
            libm::pow(base.hi, exponent.hi),
        ];
        if corners.iter().any(|c| c.is_nan()) {
            return Some(Self {
                lo: 0.0,
                hi: f64::INFINITY,
            });
        }
        let mut lo = corners.into_iter().fold(f64::INFINITY, f64::min);
        let mut hi = corners.into_iter().fold(f64::NEG_INFINITY, f64::max);
        if base.contains(1.0) || exponent.contains(0.0) {
            lo = lo.min(1.0);
            hi = hi.max(1.0);
        }
        let result = Self::outward_by(lo, hi, LIBM_ULPS);
        Some(result.within(0.0, f64::INFINITY))
    }

    pub(super) fn apply(self, f: Function) -> Option<Self> {
        let monotone = |interval: Self| {
            Self::outward_by(f.value(interval.lo), f.value(interval.hi), LIBM_ULPS)
        };
        match f {
            Function::Sin => Some(self.wave(f, 0.25)),
            Function::Cos => Some(self.wave(f, 0.0)),
            Function::Tan => Some(self.tan()),
            Function::Asin | Function::Acos => {
                if self.hi < -1.0 || self.lo > 1.0 {
                    return None;
                }
                let inner = self.within(-1.0, 1.0);
                if f == Function::Asin {
                    return Some(monotone(inner));
                }
                let falling = Self {
                    lo: inner.hi,
                    hi: inner.lo,
                };
                Some(monotone(falling).within(0.0, f64::INFINITY))
            }
            Function::Atan => Some(monotone(self)),
            Function::Exp => Some(monotone(self).within(0.0, f64::INFINITY)),
            Function::Log => (self.hi >= 0.0).then(|| monotone(self.within(0.0, f64::INFINITY))),
        }
    }

    /// Sine or cosine, which is 1 at `peak` turns and -1 half a turn later.
    fn wave(self, f: Function, peak: f64) -> Self {
        let all = Self { lo: -1.0, hi: 1.0 };
        // Beyond this, the phase is no longer known to within the slack of 1e-9.
        if self.lo.abs().max(self.hi.abs()) >= 1e6 {
            return all;
        }
        let turns = |x: f64| x / std::f64::consts::TAU;
        let (lo, hi) = (turns(self.lo) - 1e-9, turns(self.hi) + 1e-9);
        if hi - lo >= 1.0 {
            return all;
        }
        let holds = |phase: f64| (hi - phase).floor() >= (lo - phase).ceil();
        let (a, b) = (f.value(self.lo), f.value(self.hi));
        let ends = Self::outward_by(a.min(b), a.max(b), LIBM_ULPS).within(-1.0, 1.0);
        Self {
            lo: if holds(peak + 0.5) { -1.0 } else { ends.lo },
            hi: if holds(peak) { 1.0 } else { ends.hi },
        }
    }

    fn tan(self) -> Self {
        let half_turns = |x: f64| x / std::f64::consts::PI - 0.5;
        let (lo, hi) = (half_turns(self.lo) - 1e-9, half_turns(self.hi) + 1e-9);
        let small = self.lo.abs().max(self.hi.abs()) < 1e6;
        if !small || hi.floor() >= lo.ceil() {
            return Self::ALL;
        }
        let value = |x| Function::Tan.value(x);
        Self::outward_by(value(self.lo), value(self.hi), LIBM_ULPS)
    }

    /// The angle of the vector (`x`, `self`).
    fn atan2(self, x: Self) -> Self {
        let pi = std::f64::consts::PI;
        // Around the origin and across the cut on the negative x axis, every angle is possible.
        if x.lo <= 0.0 && self.contains(0.0) {
            return Self::outward_by(-pi, pi, 1);
        }
        let mut lo = f64::INFINITY;
        let mut hi = f64::NEG_INFINITY;
        for y in [self.lo, self.hi] {
            for x in [x.lo, x.hi] {
                let angle = libm::atan2(y, x);
                lo = lo.min(angle);
                hi = hi.max(angle);
            }
        }
        Self::outward_by(lo, hi, LIBM_ULPS)
    }
}
