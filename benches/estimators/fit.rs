//! Slopes and quantiles.

/// The least-squares slope of ln y over ln x.
pub(crate) fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let logarithms = points.iter().map(|&(x, y)| (x.ln(), y.ln()));
    let (x, y) = logarithms
        .clone()
        .fold((0.0, 0.0), |sum, (x, y)| (sum.0 + x / n, sum.1 + y / n));
    let (xx, xy) = logarithms.fold((0.0, 0.0), |sum, (a, b)| {
        (sum.0 + (a - x) * (a - x), sum.1 + (a - x) * (b - y))
    });
    xy / xx
}

/// What 95 % of the values do not exceed. Sorts them.
pub(crate) fn quantile_95(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[(values.len() * 19).div_ceil(20) - 1]
}
