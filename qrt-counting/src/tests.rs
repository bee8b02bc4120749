//! Tests of counting.

mod draws;
mod high_precision;
mod inference;
mod posterior_mean;

/// Checks Pearson's statistic over bins of at least ten expected draws.
///
/// It may exceed its mean by at most five standard deviations (a normal deviate by Wilson and
/// Hilferty).
pub(crate) fn chi_square_is_plausible(counts: &[u64], probabilities: &[f64]) {
    assert_eq!(counts.len(), probabilities.len());
    let draws = counts.iter().sum::<u64>() as f64;
    let (mut statistic, mut bins) = (0.0, 0.0_f64);
    let (mut seen, mut expected) = (0.0, 0.0);
    let mut left = draws;
    for (&count, &probability) in counts.iter().zip(probabilities) {
        seen += count as f64;
        expected += probability * draws;
        left -= probability * draws;
        // The last bin takes the rest.
        if expected >= 10.0 && left >= 10.0 {
            statistic += (seen - expected) * (seen - expected) / expected;
            bins += 1.0;
            (seen, expected) = (0.0, 0.0);
        }
    }
    if expected > 0.0 || seen > 0.0 {
        assert!(
            expected > 1e-9 * draws || seen == 0.0,
            "draws where none can be"
        );
        if expected >= 5.0 {
            statistic += (seen - expected) * (seen - expected) / expected;
            bins += 1.0;
        }
    }
    let freedom = bins - 1.0;
    if freedom < 1.0 {
        return;
    }
    let spread = 2.0 / (9.0 * freedom);
    let deviate = ((statistic / freedom).cbrt() - (1.0 - spread)) / spread.sqrt();
    assert!(
        deviate < 5.0,
        "chi-square {statistic} with {freedom} degrees of freedom"
    );
}
