//! The figure `counting`: outcomes of the phase register, draws from it, and the posterior.
//!
//! Its numbers are those of `qrt count` with `--total 4096`.

use qrt_counting::estimators::{
    CountingProblem, DEFAULT_CONFIDENCE, Device, EstimatorError, Noise, WindowedCounting,
};
use qrt_counting::random::Stream;
use qrt_counting::{PhaseDistribution, posterior};
use qrt_lab::playground::Answer;
use qrt_scene::Window;

/// N, the number of ids.
pub const IDS: u64 = 4096;
/// Most phase bits that the figure offers.
pub const MOST_PHASE_BITS: u32 = 10;
/// Most runs that the figure offers.
pub const MOST_RUNS: u32 = 64;

/// Values of the controls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CountingControls {
    /// The angle, in turns, from 0 to 1/2; rounded to the nearest angle of a number of good ids.
    pub theta: f64,
    /// t, of T = 2^t.
    pub phase_bits: u32,
    /// B, the runs.
    pub runs: u32,
    /// The register's window.
    pub window: Window,
    /// Seed of the draws.
    pub seed: u32,
}

/// Returns the number of good ids among [`IDS`] whose angle is nearest to `theta`, in turns.
pub fn good(theta: f64) -> u64 {
    let sine = libm::sin(std::f64::consts::PI * theta.clamp(0.0, 0.5));
    libm::round(IDS as f64 * sine * sine) as u64
}

/// Returns the distribution, draws, posterior and estimate.
///
/// # Errors
/// A register or a number of runs out of range.
pub fn answer(asked: CountingControls) -> Result<Answer, EstimatorError> {
    let CountingControls {
        theta,
        phase_bits,
        runs,
        window,
        seed,
    } = asked;
    let good = good(theta);
    let distribution = PhaseDistribution::new(good, IDS, phase_bits, window)?;
    let half = distribution.largest_outcome();

    let mut stream = Stream::new(u64::from(seed), 0, 0, 0);
    let problem = CountingProblem { good, total: IDS };
    let mut device = Device::new(problem, Noise::NONE, &mut stream)?;
    let outcomes = device.phases(phase_bits, window, runs)?;
    let mut drawn = vec![0_u32; half as usize + 1];
    for &y in &outcomes {
        drawn[y as usize] += 1;
    }

    let inference = WindowedCounting {
        phase_bits,
        repetitions: runs,
        window,
        confidence: DEFAULT_CONFIDENCE,
    };
    let estimate = inference.infer(&outcomes, IDS)?;
    let posterior = posterior(&outcomes, IDS, phase_bits, window)?;
    let mean: f64 = (0_u64..)
        .zip(&posterior)
        .map(|(good, p)| good as f64 * p)
        .sum();
    let likeliest = estimate.good.unwrap_or_default();

    Ok(Answer::default()
        .number("theta", distribution.theta())
        .number("good", good as f64)
        .number("total", IDS as f64)
        .number("amplitude", good as f64 / IDS as f64)
        .number("size", (1_u64 << phase_bits) as f64)
        .number("queries", estimate.queries as f64)
        .number("likeliest", likeliest as f64)
        .number("likeliest_theta", angle(likeliest, phase_bits, window)?)
        .number("estimate", estimate.amplitude)
        .number("low", estimate.interval.0)
        .number("high", estimate.interval.1)
        .number("confidence", estimate.confidence)
        .number("mean", mean)
        .list(
            "probability",
            (0..=half).map(|y| distribution.probability(y)),
        )
        .list("drawn", drawn.into_iter().map(f64::from))
        .list("posterior", posterior))
}

/// Returns the angles of all numbers of good ids, in turns: the places of a posterior's entries.
///
/// # Errors
/// None; numbers of good ids are in range.
pub fn angles() -> Result<Answer, EstimatorError> {
    let angles: Vec<f64> = (0..=IDS)
        .map(|good| angle(good, 1, Window::Rect))
        .collect::<Result<_, _>>()?;
    Ok(Answer::default().list("angles", angles))
}

fn angle(good: u64, phase_bits: u32, window: Window) -> Result<f64, EstimatorError> {
    Ok(PhaseDistribution::new(good, IDS, phase_bits, window)?.theta())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked() -> CountingControls {
        CountingControls {
            theta: 1.0 / 3.0,
            phase_bits: 6,
            runs: 3,
            window: Window::Rect,
            seed: 1,
        }
    }

    #[test]
    fn probabilities_and_posterior_sum_to_one() {
        for window in [Window::Rect, Window::Sine] {
            for phase_bits in 1..=MOST_PHASE_BITS {
                for theta in [0.0, 0.1, 0.25, 1.0 / 3.0, 0.4999, 0.5] {
                    let asked = CountingControls {
                        theta,
                        phase_bits,
                        window,
                        ..asked()
                    };
                    let answer = answer(asked).unwrap();
                    for name in ["probability", "posterior"] {
                        let sum: f64 = answer.list_of(name).unwrap().iter().sum();
                        assert!((sum - 1.0).abs() < 1e-9, "{asked:?} {name}: {sum}");
                    }
                    let drawn: f64 = answer.list_of("drawn").unwrap().iter().sum();
                    assert_eq!(drawn, 3.0);
                    assert!((answer.number_of("theta").unwrap() - theta).abs() < 6e-3);
                }
            }
        }
    }

    /// Because sin^2(pi/3) = 3/4.
    #[test]
    fn a_third_of_a_turn_is_three_quarters_of_the_ids() {
        let answer = answer(asked()).unwrap();
        assert_eq!(answer.number_of("good"), Some(3072.0));
        assert_eq!(answer.number_of("amplitude"), Some(0.75));
        assert!((answer.number_of("theta").unwrap() - 1.0 / 3.0).abs() < 1e-15);
        assert_eq!(answer.number_of("queries"), Some(3.0 * 63.0));
    }

    #[test]
    fn the_maximum_of_the_posterior_is_the_likeliest() {
        for seed in 0..20 {
            let answer = answer(CountingControls { seed, ..asked() }).unwrap();
            let posterior = answer.list_of("posterior").unwrap();
            let likeliest = answer.number_of("likeliest").unwrap();
            let most = posterior.iter().copied().fold(0.0, f64::max);
            assert!(posterior[likeliest as usize] >= most * (1.0 - 1e-9));
        }
    }

    #[test]
    fn angles_ascend_from_zero_to_a_half() {
        let answer = angles().unwrap();
        let angles = answer.list_of("angles").unwrap();
        assert_eq!((angles[0], angles[IDS as usize]), (0.0, 0.5));
        assert!(angles.windows(2).all(|pair| pair[0] < pair[1]));
    }

    #[test]
    fn controls_out_of_range_are_refused() {
        for (phase_bits, runs) in [(0, 1), (41, 1), (3, 0)] {
            assert!(
                answer(CountingControls {
                    phase_bits,
                    runs,
                    ..asked()
                })
                .is_err()
            );
        }
    }
}
