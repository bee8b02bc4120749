//! The Pareto front of error and price.

/// Returns the indices of the points (price, error) on the Pareto front, from the cheapest on.
///
/// A point is on the front if no other is at most as dear and at most as wrong, and better in one
/// of the two. Of equal points the first one counts.
///
/// ```
/// use qrt_lab::trade::pareto;
/// assert_eq!(pareto(&[(4.0, 0.1), (1.0, 0.5), (2.0, 0.6), (3.0, 0.2)]), [1, 3, 0]);
/// ```
pub fn pareto(points: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| {
        let ((p, e), (q, f)) = (points[a], points[b]);
        p.total_cmp(&q).then(e.total_cmp(&f)).then(a.cmp(&b))
    });
    let mut best = f64::INFINITY;
    order.retain(|&at| {
        let better = points[at].1 < best;
        if better {
            best = points[at].1;
        }
        better
    });
    order
}

#[cfg(test)]
mod tests {
    use super::pareto;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_front_is_what_nothing_beats(
            points in proptest::collection::vec((0..20_u32, 0..20_u32), 0..40),
        ) {
            let points: Vec<(f64, f64)> =
                points.into_iter().map(|(p, e)| (p.into(), e.into())).collect();
            let front = pareto(&points);
            for (at, point) in points.iter().enumerate() {
                let beaten = points.iter().enumerate().any(|(other, rival)| {
                    rival.0 <= point.0 && rival.1 <= point.1 && (rival != point || other < at)
                });
                prop_assert_eq!(front.contains(&at), !beaten);
            }
        }
    }
}
