//! Placement of labels without overlaps.

/// Moves heights apart so that neighbours are at least `gap` apart.
///
/// All heights lie within `low..=high`, and the gap shrinks if there is too little room. Each group
/// of labels that would overlap is centred on the mean of its members' `wanted` heights.
pub(super) fn apart(wanted: &[f64], gap: f64, low: f64, high: f64) -> Vec<f64> {
    let mut order: Vec<usize> = (0..wanted.len()).collect();
    order.sort_by(|&a, &b| wanted[a].total_cmp(&wanted[b]).then(a.cmp(&b)));
    // (members, sum over members of the group's first height that would give the member its wanted
    // one)
    let mut groups: Vec<(usize, f64)> = Vec::new();
    let gap = gap.min((high - low) / (wanted.len().max(2) - 1) as f64);
    let start = |&(count, sum): &(usize, f64)| {
        let last = high - (count - 1) as f64 * gap;
        (sum / count as f64).min(last).max(low)
    };
    for &label in &order {
        let mut group = (1, wanted[label]);
        while let Some(above) = groups.last() {
            if start(above) + above.0 as f64 * gap <= start(&group) + 1e-9 {
                break;
            }
            let shift = group.0 as f64 * above.0 as f64 * gap;
            group = (above.0 + group.0, above.1 + group.1 - shift);
            groups.pop();
        }
        groups.push(group);
    }
    let mut placed = vec![0.0; wanted.len()];
    let mut labels = order.into_iter();
    for group in &groups {
        for (k, label) in labels.by_ref().take(group.0).enumerate() {
            placed[label] = start(group) + k as f64 * gap;
        }
    }
    placed
}

#[cfg(test)]
mod tests {
    use super::apart;
    use proptest::prelude::*;

    #[test]
    fn labels_in_each_others_way_are_centred() {
        assert_eq!(apart(&[50.0, 20.0], 10.0, 0.0, 100.0), [50.0, 20.0]);
        assert_eq!(apart(&[50.0, 50.0], 10.0, 0.0, 100.0), [45.0, 55.0]);
        assert_eq!(
            apart(&[99.0, 98.0, 1.0], 10.0, 0.0, 100.0),
            [100.0, 90.0, 1.0]
        );
        assert!(apart(&[], 10.0, 0.0, 100.0).is_empty());
    }

    proptest! {
        #[test]
        fn none_overlap_and_all_are_inside(
            wanted in proptest::collection::vec(-50.0..150.0_f64, 1..12), gap in 1.0..9.0_f64,
        ) {
            let placed = apart(&wanted, gap, 0.0, 100.0);
            let mut sorted = placed.clone();
            sorted.sort_by(f64::total_cmp);
            prop_assert!(sorted.windows(2).all(|pair| pair[1] - pair[0] > gap - 1e-6));
            prop_assert!(placed.iter().all(|&at| (-1e-6..100.0 + 1e-6).contains(&at)));
            for (a, b) in wanted.iter().zip(&placed) {
                for (c, d) in wanted.iter().zip(&placed) {
                    prop_assert!(a >= c || b < d, "order is kept");
                }
            }
        }
    }
}
