//! The input of a block of states.

use super::lane::LANES;
use crate::PixelLanes;
use std::ops::Range;

/// The input of a block of states.
pub(super) struct Block<'a> {
    pub(super) inputs: &'a [&'a [u64]],
    pub(super) spans: &'a [PixelLanes<'a>],
    /// By input: `first`, if lane l holds `first ^ (l mod 2^k)`, with the k of
    /// [`super::pattern_bits`].
    pub(super) runs: Vec<Option<u64>>,
}

impl Block<'_> {
    /// Returns the content of an input register. The lanes after the last given one hold the same
    /// as that.
    #[inline(always)]
    pub(super) fn input(&self, input: u32, lane: usize) -> u64 {
        let lanes = self.inputs[input as usize];
        lanes.get(lane).or(lanes.last()).copied().unwrap_or(0)
    }

    /// Calls `each` with the lanes and the parameters of every span; the last one takes all lanes
    /// that remain.
    #[inline(always)]
    pub(super) fn each_span(&self, mut each: impl FnMut(Range<usize>, &[u64])) {
        let mut first = 0;
        for (place, span) in self.spans.iter().enumerate() {
            let last = place + 1 == self.spans.len();
            let end = if last { LANES } else { first + span.lanes };
            each(first..end.min(LANES), span.parameters);
            first = end.min(LANES);
        }
    }
}
