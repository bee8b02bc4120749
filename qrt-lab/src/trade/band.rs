//! Errors over a sample of pixels, and their confidence intervals.

use qrt_counting::random::Stream;

/// Number of times that the bootstrap draws the sample anew.
const RESAMPLED: usize = 400;
/// Key of the bootstrap's draws, the same for all tables, so that they are comparable.
const KEY: u64 = 0xB007_57AA;

/// A root mean square, with its 95 % interval: the percentile bootstrap over pixels (Efron, 1979).
///
/// All values are relative to the mean radiance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Band {
    /// The root mean square.
    pub value: f64,
    /// The interval's lower end.
    pub low: f64,
    /// The interval's upper end.
    pub high: f64,
}

impl Band {
    /// Creates the band from each pixel's mean square.
    pub(super) fn of_squares(squares: &[f64]) -> Self {
        let count = squares.len();
        if count == 0 {
            return Self::default();
        }
        let root = |sum: f64| (sum / count as f64).sqrt();
        let mut stream = Stream::new(KEY, count as u32, 0, 0);
        let mut drawn: Vec<f64> = (0..RESAMPLED)
            .map(|_| {
                let any = (0..count).map(|_| {
                    let at = (stream.uniform() * count as f64) as usize;
                    squares[at.min(count - 1)]
                });
                root(any.sum())
            })
            .collect();
        drawn.sort_by(f64::total_cmp);
        Self {
            value: root(squares.iter().sum()),
            low: drawn[RESAMPLED / 40],
            high: drawn[RESAMPLED - 1 - RESAMPLED / 40],
        }
    }

    /// Creates the band of the differences between the pictures `a` and `b`, in units of `mean`.
    pub(super) fn of_difference(a: &[[f64; 3]], b: &[[f64; 3]], mean: f64) -> Self {
        let square = |(a, b): (&[f64; 3], &[f64; 3])| {
            let squares = a.iter().zip(b).map(|(a, b)| ((a - b) / mean).powi(2));
            squares.sum::<f64>() / 3.0
        };
        Self::of_squares(&a.iter().zip(b).map(square).collect::<Vec<_>>())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares the interval's width with theory.
    ///
    /// The mean square of n exponential variables has a relative standard deviation of 1/sqrt(n),
    /// so its root has half of that.
    #[test]
    fn the_interval_is_as_wide_as_the_sample_says() {
        let mut stream = Stream::new(5, 0, 0, 0);
        let count = 1000;
        let squares: Vec<f64> = (0..count)
            .map(|_| -libm::log(stream.fine_uniform()))
            .collect();
        let Band { value, low, high } = Band::of_squares(&squares);
        let wide = 2.0 * 1.96 * 0.5 / f64::from(count).sqrt();
        assert!((value - 1.0).abs() < 0.05, "{value}");
        assert!(((high - low) / wide - 1.0).abs() < 0.2, "{low} {high}");
        assert!(low < value && value < high);
    }

    #[test]
    fn equal_pictures_do_not_differ() {
        let picture = [[0.1, 0.2, 0.3]; 5];
        assert_eq!(
            Band::of_difference(&picture, &picture, 0.2),
            Band::default()
        );
        let other = [[0.2, 0.3, 0.4]; 5];
        let band = Band::of_difference(&picture, &other, 0.2);
        for value in [band.value, band.low, band.high] {
            assert!((value - 0.5).abs() < 1e-12);
        }
        assert_eq!(Band::of_squares(&[]), Band::default());
    }
}
