//! Sums over a pixel's paths.

use super::one_run::{OneRun, Segments};
use crate::sample::Sum;
use qrt_counting::LevelCounts;

/// Sums over the paths of a pixel, per channel.
#[derive(Clone, Debug, Default)]
pub(super) struct Totals {
    pub(super) colour: [Sum; 3],
    pub(super) good: [u64; 3],
    /// The levels of the paths, if the estimator asks for them.
    pub(super) levels: [LevelCounts; 3],
    /// The counts of the luminance, if it is counted.
    pub(super) segments: Segments,
    /// Number of queries for primary hits.
    pub(super) queries: u64,
    /// Number of paths out of bounds, and the colour of the first of them.
    pub(super) stray: [(u64, f64); 3],
}

impl Totals {
    /// Encodes the totals, so that they can be continued later.
    pub(super) fn encode(&self) -> Vec<u64> {
        let mut words = vec![self.queries];
        for channel in 0..3 {
            let (paths, colour) = self.stray[channel];
            words.extend(self.colour[channel].encode());
            words.extend([self.good[channel], paths, colour.to_bits()]);
            self.levels[channel].encode(&mut words);
        }
        self.segments.encode(&mut words);
        words
    }

    /// Adds the totals of later path indices.
    pub(super) fn append(&mut self, later: &Self) {
        self.segments.append(&later.segments);
        self.queries += later.queries;
        for channel in 0..3 {
            self.colour[channel].append(&later.colour[channel]);
            self.good[channel] += later.good[channel];
            self.levels[channel].append(&later.levels[channel]);
            let (paths, colour) = later.stray[channel];
            let stray = &mut self.stray[channel];
            if stray.0 == 0 {
                stray.1 = colour;
            }
            stray.0 += paths;
        }
    }

    /// Decodes totals from words into `self`, which must be totals without paths; `None` if the
    /// words are not those of totals.
    pub(super) fn decode(mut self, words: &[u64], one_run: Option<&OneRun>) -> Option<Self> {
        let mut words = words.iter().copied();
        let words = &mut words;
        let totals = &mut self;
        totals.queries = words.next()?;
        for channel in 0..3 {
            let sum: Vec<u64> = words.by_ref().take(Sum::WORDS).collect();
            totals.colour[channel] = Sum::decode(sum.as_array()?)?;
            totals.good[channel] = words.next()?;
            totals.stray[channel] = (words.next()?, f64::from_bits(words.next()?));
            totals.levels[channel] = totals.levels[channel].decode(words)?;
        }
        totals.segments = Segments::decode(words, one_run)?;
        words.next().is_none().then_some(self)
    }
}
