//! Assignment of a block's lanes to pixels.

use std::ops::Range;

/// Neighbouring lanes of one pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span<'a> {
    /// Number of lanes that belong to the pixel.
    pub lanes: usize,
    /// The pixel's classical parameters: one value each, in the program's order.
    pub parameters: &'a [u64],
}

/// Returns the parts of `spans` that lie within `lanes`.
pub fn part_of_spans<'a>(spans: &[Span<'a>], lanes: Range<usize>) -> Vec<Span<'a>> {
    let mut first = 0;
    let parts = spans.iter().map(|span| {
        let end = first + span.lanes;
        let part = first.max(lanes.start)..end.min(lanes.end);
        first = end;
        Span {
            lanes: part.len(),
            parameters: span.parameters,
        }
    });
    parts.filter(|span| span.lanes > 0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_has_its_lanes_alone() {
        let words: [&[u64]; 3] = [&[1], &[2], &[3]];
        let of = |lanes: [usize; 3]| {
            let spans = lanes.into_iter().zip(words);
            let spans = spans.filter(|(lanes, _)| *lanes > 0);
            let spans = spans.map(|(lanes, parameters)| Span { lanes, parameters });
            spans.collect::<Vec<_>>()
        };
        let all = of([3, 4, 1]);
        assert_eq!(part_of_spans(&all, 0..8), all);
        assert_eq!(part_of_spans(&all, 0..3), of([3, 0, 0]));
        assert_eq!(part_of_spans(&all, 2..4), of([1, 1, 0]));
        assert_eq!(part_of_spans(&all, 4..6), of([0, 2, 0]));
        assert_eq!(part_of_spans(&all, 6..8), of([0, 1, 1]));
    }
}
