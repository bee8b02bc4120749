//! Tests that draws follow their distribution.

use qrt_circuit::quantum::Window;

use super::chi_square_is_plausible;
use crate::PhaseDistribution;
use crate::random::Stream;

const WINDOWS: [Window; 2] = [Window::Rect, Window::Sine];

/// (good, total): both ends, phases on the grid, and phases at every kind of offset.
const CASES: [(u64, u64); 8] = [
    (0, 5),
    (5, 5),
    (1, 2),
    (1, 1000),
    (3, 10),
    (77, 100),
    (4_999, 10_000),
    (999, 1000),
];

#[test]
fn every_outcome_of_a_small_register_comes_as_often_as_it_should() {
    for bits in [1, 2, 3, 4, 6, 9] {
        for (good, total) in CASES {
            for window in WINDOWS {
                let found = PhaseDistribution::new(good, total, bits, window).unwrap();
                let sampler = found.sampler();
                let mut stream = Stream::new(u64::from(bits), good as u32, total as u32, 0);
                let outcomes = found.largest_outcome() as usize + 1;
                let mut counts = vec![0; outcomes];
                for _ in 0..40_000 {
                    counts[sampler.sample(&mut stream) as usize] += 1;
                }
                let expected: Vec<f64> =
                    (0..outcomes as u64).map(|y| found.probability(y)).collect();
                chi_square_is_plausible(&counts, &expected);
            }
        }
    }
}

/// Compares signed distances from the peak, in bins that widen by powers of two.
#[test]
fn tails_of_a_large_register_are_as_heavy_as_they_should_be() {
    for bits in [18, 29, 40] {
        for (good, total) in [(3, 10), (1 << 40, (1 << 41) + 12_345), (77, 100)] {
            for window in WINDOWS {
                let found = PhaseDistribution::new(good, total, bits, window).unwrap();
                let sampler = found.sampler();
                let peak = found.nearest_outcome() as i64;
                let bin = |distance: i64| {
                    let size = distance.unsigned_abs();
                    let level = if size < 16 {
                        size
                    } else {
                        12 + u64::from(size.ilog2())
                    };
                    let level = level.min(26) as i64;
                    (26 + level * distance.signum()) as usize
                };
                let mut expected = vec![0.0; 53];
                // Distances below 2^14 are added up. The outermost bins take the remaining
                // probability.
                let reach = (1_i64 << 14) - 1;
                for distance in -reach..=reach {
                    let p = found.probability((peak + distance) as u64);
                    expected[bin(distance)] += p;
                }
                let beyond = 1.0 - expected.iter().sum::<f64>();
                expected[0] += 0.5 * beyond;
                expected[52] += 0.5 * beyond;
                let mut counts = vec![0_u64; 53];
                let mut stream = Stream::new(99, bits, good as u32, 1);
                for _ in 0..200_000 {
                    counts[bin(sampler.sample(&mut stream) as i64 - peak)] += 1;
                }
                // The two outermost bins differ if the peak is not in the middle, so they are
                // merged.
                counts[52] += std::mem::take(&mut counts[0]);
                expected[52] += std::mem::take(&mut expected[0]);
                counts.rotate_right(1);
                expected.rotate_right(1);
                chi_square_is_plausible(&counts[..], &expected[..]);
            }
        }
    }
}

/// Compares the draws outside of the lobe with their conditional probabilities.
///
/// The sampler draws these by rejection. For the sine window they are rare.
#[test]
fn outcomes_beyond_the_lobe_have_their_conditional_distribution() {
    for (window, draws) in [(Window::Rect, 300_000), (Window::Sine, 3_000_000)] {
        for (good, total) in [(3, 10), (4_999, 10_000)] {
            let found = PhaseDistribution::new(good, total, 5, window).unwrap();
            let sampler = found.sampler();
            let mut stream = Stream::new(4, good as u32, 0, 2);
            let mut counts = [0_u64; 17];
            for _ in 0..draws {
                counts[sampler.sample(&mut stream) as usize] += 1;
            }
            let expected: Vec<f64> = (0..=16).map(|y| found.probability(y)).collect();
            let far = |y: u64| y.abs_diff(found.nearest_outcome()) > 2;
            let (mut tail_counts, mut tail) = (Vec::new(), Vec::new());
            for y in (0..=16).filter(|&y| far(y)) {
                tail_counts.push(counts[y as usize]);
                tail.push(expected[y as usize]);
            }
            let mass: f64 = tail.iter().sum();
            let seen: u64 = tail_counts.iter().sum();
            let deviation = (f64::from(draws) * mass * (1.0 - mass)).sqrt();
            assert!((seen as f64 - f64::from(draws) * mass).abs() < 5.0 * deviation);
            for p in &mut tail {
                *p /= mass;
            }
            chi_square_is_plausible(&tail_counts, &tail);
        }
    }
}

#[test]
fn on_the_grid_a_rectangular_register_reads_its_phase_every_time() {
    for bits in [2, 11, 40] {
        for (good, total, quarter) in [(0, 7, 0), (7, 14, 1), (7, 7, 2)] {
            let found = PhaseDistribution::new(good, total, bits, Window::Rect).unwrap();
            let mut stream = Stream::new(1, 2, 3, 0);
            for _ in 0..100 {
                assert_eq!(found.sample(&mut stream), quarter << (bits - 2));
            }
        }
    }
}

#[test]
fn the_same_seed_draws_the_same_outcomes() {
    let found = PhaseDistribution::new(3, 10, 40, Window::Rect).unwrap();
    let run = |seed| {
        let mut stream = Stream::new(seed, 1, 2, 0);
        (0..50)
            .map(|_| found.sample(&mut stream))
            .collect::<Vec<_>>()
    };
    assert_eq!(run(3), run(3));
    assert_ne!(run(3), run(4));
}
