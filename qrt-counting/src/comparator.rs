//! Comparators: from a path's colour to good indices, and from an amplitude to a pixel.
//!
//! An index of the oracle is a path index and a comparator y of C = 2^c. It is good if the path's
//! colour x exceeds the comparator's threshold. The fraction of good indices is therefore the mean
//! colour over the colour scale, rounded path by path. With h = scale / C:
//!
//! * `midpoints`, thresholds `(y + 1/2) h`: `|h #{y: x > (y + 1/2) h} - x| <= h/2`;
//! * `edges`, thresholds `y h` (the paper's): `#{y: x > y h} = ceil(x/h)`, too large by an error in
//!   [0, h).
//!
//! Each threshold is the `f64` nearest to its definition, and the comparison is strict, so counts
//! are exact at every boundary. A count takes a product, a truncation and a comparison, without a
//! branch, because it runs for every path.

use qrt_scene::{Comparator, ComparatorAt};

use super::error::CountingError;

/// The largest number of comparator bits.
pub const MAX_COMPARATOR_BITS: u32 = 30;

/// C = 2^c comparators over [0, scale].
///
/// ```
/// use qrt_scene::{Comparator, ComparatorAt};
/// use qrt_counting::Comparators;
/// let comparators = Comparators::new(8.0, Comparator { bits: 3, at: ComparatorAt::Midpoints })?;
/// assert_eq!(comparators.good(2.5), 2); // above 0.5 and 1.5; 2.5 itself is not exceeded
/// assert_eq!(comparators.pixel(5, 16), 2.5); // 5 of 2 paths' 16 indices
/// # Ok::<(), qrt_counting::CountingError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparators {
    scale: f64,
    bits: u32,
    step: f64,
    inverse: f64,
    /// The first threshold over the step: 1/2 or 0.
    start: f64,
}

impl Comparators {
    /// Creates comparators for colours in `[0, scale]`; `scale` is in units of radiance and may be
    /// 0.
    ///
    /// # Errors
    ///
    /// More than 30 bits; a scale that is negative, not finite, or so small (below about
    /// `1e-308 * 2^bits`) that thresholds would lose their precision.
    pub fn new(scale: f64, comparator: Comparator) -> Result<Self, CountingError> {
        let Comparator { bits, at } = comparator;
        if bits > MAX_COMPARATOR_BITS {
            return Err(CountingError::ComparatorBitsOutOfRange(bits));
        }
        let step = scale / (1_u64 << bits) as f64;
        let inverse = if scale == 0.0 { 0.0 } else { 1.0 / step };
        let ok = scale == 0.0 || (scale > 0.0 && step.is_normal() && inverse.is_normal());
        if !ok || !scale.is_finite() {
            return Err(CountingError::ScaleOutOfRange(scale));
        }
        let start = match at {
            ComparatorAt::Midpoints => 0.5,
            ComparatorAt::Edges => 0.0,
        };
        Ok(Self {
            scale,
            bits,
            step,
            inverse,
            start,
        })
    }

    /// Creates the comparators of a pixel's red, green and blue channels, with one `scale` each.
    ///
    /// # Errors
    /// As [`Comparators::new`].
    pub fn rgb(scale: [f64; 3], comparator: Comparator) -> Result<[Self; 3], CountingError> {
        let [r, g, b] = scale.map(|scale| Self::new(scale, comparator));
        Ok([r?, g?, b?])
    }

    /// c, the number of qubits of the comparator register.
    pub fn bits(&self) -> u32 {
        self.bits
    }

    /// C, the number of comparators, and of indices per path.
    pub fn count(&self) -> u64 {
        1 << self.bits
    }

    /// h, the distance between thresholds.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Number of thresholds that the colour `x` exceeds, in `0 ..= C`.
    ///
    /// A colour above the scale exceeds all thresholds. A colour below 0 or NaN exceeds none.
    #[inline]
    pub fn good(&self, x: f64) -> u32 {
        let count = 1_i32 << self.bits;
        // `x` exceeds every threshold numbered below `at`, and none numbered above it. A colour
        // above a threshold exceeds it by at least half a unit in the last place, which outweighs
        // the rounding of `inverse`. A colour at or below a threshold may be rounded up to it; the
        // comparison corrects that. The cast turns NaN into 0.
        let at = (x * self.inverse - self.start).clamp(0.0, f64::from(count)) as i32;
        let threshold = (f64::from(at) + self.start) * self.step;
        at as u32 + u32::from(at < count && x > threshold)
    }

    /// Number of good indices of all paths with the given `colours`.
    pub fn good_total(&self, colours: &[f64]) -> u64 {
        colours
            .iter()
            .map(|&colour| u64::from(self.good(colour)))
            .sum()
    }

    /// The pixel for `good` of `total` indices: `scale * good / total`.
    pub fn pixel(&self, good: u64, total: u64) -> f64 {
        self.scale * (good as f64 / total as f64)
    }

    /// The pixel for an estimated amplitude in [0, 1].
    pub fn pixel_of_amplitude(&self, amplitude: f64) -> f64 {
        self.scale * amplitude
    }

    /// Bounds of the error `h good(x) - x` for colours in `[0, scale]`: `(-h/2, h/2)` or `(0, h)`.
    pub fn error_bounds(&self) -> (f64, f64) {
        (
            (0.0 - self.start) * self.step,
            (1.0 - self.start) * self.step,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn comparators(scale: f64, bits: u32, at: ComparatorAt) -> Comparators {
        Comparators::new(scale, Comparator { bits, at }).unwrap()
    }

    fn brute(scale: f64, bits: u32, at: ComparatorAt, x: f64) -> u32 {
        let step = scale / f64::from(1_u32 << bits);
        (0..1_u32 << bits)
            .filter(|&y| match at {
                ComparatorAt::Midpoints => x > (f64::from(y) + 0.5) * step,
                ComparatorAt::Edges => x > f64::from(y) * step,
            })
            .count() as u32
    }

    fn at() -> impl Strategy<Value = ComparatorAt> {
        prop_oneof![Just(ComparatorAt::Midpoints), Just(ComparatorAt::Edges)]
    }

    proptest! {
        #[test]
        fn counting_thresholds_one_by_one_agrees(
            mantissa in 1.0..2.0_f64, exponent in -900..900_i32, bits in 0..11_u32,
            fraction in 0.0..=1.0_f64, at in at(),
        ) {
            let scale = mantissa * 2.0_f64.powi(exponent);
            let x = fraction * scale;
            let found = comparators(scale, bits, at);
            let good = found.good(x);
            prop_assert_eq!(good, brute(scale, bits, at, x));
            let error = f64::from(good) * found.step() - x;
            let (low, high) = found.error_bounds();
            let rounding = 1e-15 * scale;
            prop_assert!(error >= low - rounding && error <= high + rounding);
        }

        #[test]
        fn thresholds_themselves_and_their_neighbours_are_exact(
            scale in 1e-3..1e3_f64, bits in 0..11_u32, y in 0..=2048_u32, at in at(),
        ) {
            let step = scale / f64::from(1_u32 << bits);
            let start = if at == ComparatorAt::Midpoints { 0.5 } else { 0.0 };
            let threshold = (f64::from(y) + start) * step;
            for x in [threshold.next_down(), threshold, threshold.next_up()] {
                let good = comparators(scale, bits, at).good(x);
                prop_assert_eq!(good, brute(scale, bits, at, x));
            }
        }

        #[test]
        fn a_pixel_is_the_mean_colour_to_half_a_step(
            colours in proptest::collection::vec(0.0..=3.0_f64, 1..50), bits in 4..12_u32,
        ) {
            let found = comparators(3.0, bits, ComparatorAt::Midpoints);
            let total = colours.len() as u64 * found.count();
            let pixel = found.pixel(found.good_total(&colours), total);
            let mean = colours.iter().sum::<f64>() / colours.len() as f64;
            prop_assert!((pixel - mean).abs() <= 0.5 * found.step() + 1e-14);
        }
    }

    /// Checks scales for which the division rounds to the wrong side of a threshold.
    #[test]
    fn every_threshold_of_awkward_scales_is_exact() {
        for tenths in 1..60 {
            let scale = f64::from(tenths) / 10.0;
            for (at, start) in [(ComparatorAt::Midpoints, 0.5), (ComparatorAt::Edges, 0.0)] {
                let found = comparators(scale, 9, at);
                for y in 0..512_u32 {
                    let threshold = (f64::from(y) + start) * found.step();
                    assert_eq!(found.good(threshold), y, "{scale} {y}");
                    assert_eq!(found.good(threshold.next_up()), y + 1, "{scale} {y}");
                }
            }
        }
    }

    #[test]
    fn edges_err_to_one_side_and_midpoints_do_not() {
        let edges = comparators(1.0, 4, ComparatorAt::Edges);
        let midpoints = comparators(1.0, 4, ComparatorAt::Midpoints);
        let colours: Vec<f64> = (0..1000).map(|i| (f64::from(i) + 0.5) / 1000.0).collect();
        let total = 16 * colours.len() as u64;
        let bias = |found: &Comparators| found.pixel(found.good_total(&colours), total) - 0.5;
        assert!((bias(&edges) - 1.0 / 32.0).abs() < 1e-3);
        assert!(bias(&midpoints).abs() < 1e-3);
    }

    #[test]
    fn every_colour_has_a_count_and_every_bad_scale_a_refusal() {
        let found = comparators(2.0, 10, ComparatorAt::Midpoints);
        for (x, good) in [
            (f64::NAN, 0),
            (f64::NEG_INFINITY, 0),
            (-1.0, 0),
            (0.0, 0),
            (2.0, 1024),
            (1e300, 1024),
            (f64::INFINITY, 1024),
        ] {
            assert_eq!(found.good(x), good, "{x}");
        }
        let black = comparators(0.0, 10, ComparatorAt::Edges);
        assert_eq!(black.good(0.0), 0);
        assert_eq!(black.pixel(0, 1024), 0.0);
        let comparator = Comparator {
            bits: 10,
            at: ComparatorAt::Edges,
        };
        let widest = comparators(3.0, 30, ComparatorAt::Edges);
        assert_eq!(widest.good(3.0), 1 << 30);
        assert_eq!(widest.good(3.0_f64.next_down()), 1 << 30);
        assert_eq!(widest.good(f64::INFINITY), 1 << 30);
        for scale in [-1.0, f64::NAN, f64::INFINITY, 1e-308] {
            assert!(Comparators::new(scale, comparator).is_err(), "{scale}");
        }
        assert!(
            Comparators::new(
                1.0,
                Comparator {
                    bits: 32,
                    ..comparator
                }
            )
            .is_err()
        );
    }
}
