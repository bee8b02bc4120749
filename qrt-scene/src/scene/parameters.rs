//! Parameters of the circuit and of counting, and limits on their cost.

use super::record::{keyword, record};
use super::shape::{AutoOr, Maybe, number, whole, word};
use super::uncompute::UncomputeShape;
use super::{Estimator, LENGTH, Uncompute, Window};

/// Fraction bits under `precision: { fraction: auto }`.
pub const DEFAULT_FRACTION: u32 = 16;

record! {
    /// Width of the circuit's fixed-point numbers.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Precision = "precision";
    /// Bits behind the point; `auto` is 16.
    pub fraction: Option<u32> = AutoOr(whole::<u32>(4, 30)), or None;
}

record! {
    /// The comparator register.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Comparator = "the comparator";
    /// Its qubits, c: a colour is compared with 2^c thresholds; default 10. 0 suits colours that are 0
    /// or the scale.
    pub bits: u32 = whole::<u32>(0, 30), or 10;
    /// The positions of the thresholds, with h = scale / 2^bits.
    pub at: ComparatorAt = word::<ComparatorAt>(), or ComparatorAt::Midpoints;
}

impl Comparator {
    /// Maximum number of strata of the comparator: each halving fixes one bit.
    pub const fn most_strata(self) -> u32 {
        self.bits + 1
    }
}

keyword! {
    /// The positions of the thresholds, with h = scale / 2^bits.
    pub enum ComparatorAt = "a comparator position";
    /// At (y + 1/2) h.
    Midpoints = "midpoints";
    /// At y h, as in the paper.
    Edges = "edges";
}

record! {
    /// The counting of the good indices.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Counting = "counting";
    /// T = 2^phase_bits; default 8. A run of the counting circuit takes T - 1 queries; estimators
    /// without a phase register may spend up to B (T - 1).
    pub phase_bits: u32 = whole::<u32>(1, 40), or 8;
    /// B, the number of runs; default 1.
    pub repetitions: u32 = whole::<u32>(1, 1_000_000), or 1;
    /// The window on the phase register of `posterior-mean`; `paper` and `qss` count with the
    /// rectangular one and `sine` with the sine window, whatever stands here.
    pub window: Window = word::<Window>(), or Window::Sine;
    /// The estimator that turns measurements into an amplitude. Without it: `auto`, which needs the fewest queries,
    /// in a picture of up to 4,096 pixels, and wherever `error`, `accuracy` or more than one stratum is written;
    /// `sine`, which is simulated fastest, in a larger picture.
    pub estimator: Option<Estimator> = Maybe(word::<Estimator>()), or None;
    /// Parts of the comparator's range that are counted one by one: n of them are the upper half,
    /// the upper half of the rest, and so on, and what remains. `auto`, the default, chooses n for
    /// each channel of each pixel from what it measures first. Only the estimators `adaptive-bayes`,
    /// `auto` and `random-depth` count by strata; for all others the number is 1.
    pub strata: Option<u32> = AutoOr(whole::<u32>(1, 31)), or None;
    /// Half the width of the interval, in radiance, at which a channel of a pixel is done though
    /// queries are left; of the luminance where one run gives the colour. Without it, the default,
    /// all queries are used. Estimators with a phase register have no interval to look at in between.
    pub error: Option<f64> = Maybe(LENGTH), or None;
}

impl Counting {
    /// The estimator; `auto` if there is none. That of a large picture in a valid scene is never left out: see
    /// [`ValidScene::is_counted_by_size`](crate::valid::ValidScene::is_counted_by_size).
    pub fn estimator(&self) -> Estimator {
        self.estimator.unwrap_or(Estimator::Auto)
    }

    /// The window in which the phase register is prepared: the estimator's own, or else `window`.
    pub fn register_window(&self) -> Window {
        self.estimator().register_window(self.window)
    }

    /// True if the levels of paths may be read: by the estimator, or to count strata one by one.
    pub fn reads_levels(&self) -> bool {
        self.estimator().reads_levels() || self.may_count_strata()
    }

    /// True if strata of the comparator may be counted one by one.
    pub fn may_count_strata(&self) -> bool {
        self.estimator().counts_strata() && self.strata != Some(1)
    }
}

record! {
    /// The layout of the circuit.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Circuit = "the circuit";
    /// The uncompute strategy of work registers. Parts that are uncomputed early may be listed, with hyphens between
    /// them: `plane`, `body`, `search`, `ray`, `shading` and `component` of the tracer; the garbage of
    /// `tables`, `products` and `quotients`; and `recompute`, which computes cheap values at each use instead
    /// of keeping them, or `rerun`, which also runs again what these are computed from.
    pub uncompute: Uncompute = UncomputeShape, or Uncompute::Keep;
    /// The way to keep the nearest intersection.
    pub nearest: Nearest = word::<Nearest>(), or Nearest::Running;
}

keyword! {
    /// The way to keep the nearest intersection.
    pub enum Nearest = "a way to keep the nearest hit";
    /// The distance and the face's number so far, and a flag per primitive.
    Running = "running";
    /// All intersections and nearest records, as in the paper.
    Paper = "paper";
}

record! {
    /// Asked accuracy; qrt chooses the parameters.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Accuracy = "accuracy";
    /// Of a channel of a pixel, relative to the picture's mean radiance over pixels and channels.
    pub error: f64 = number(0.0, 1.0).above().below();
    /// The fraction of all channels of all pixels that are within the error.
    pub confidence: f64 = number(0.0, 1.0).above().below();
}

record! {
    /// Limits on the circuit's cost; beyond them, an error.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Budget = "the budget";
    /// Maximum number of qubits at a time.
    pub qubits: Option<u64> = Maybe(whole::<u64>(1, 1 << 53)), or None;
    /// Maximum number of Toffoli gates in one call of the oracle.
    pub toffoli: Option<u64> = Maybe(whole::<u64>(1, 1 << 53)), or None;
}
