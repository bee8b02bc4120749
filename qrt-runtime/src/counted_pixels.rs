//! The figures of pixels beside their colours, as pictures and checkpoints have them.
//!
//! This module alone lists these figures: for the pixels of a tile or a picture, for their bytes in a
//! checkpoint, and for a picture's metadata.

use qrt_counting::estimators::Estimate;
use qrt_scene::{Counting, Estimator};
use std::collections::BTreeMap;
use std::collections::TryReserveError;
use std::ops::Range;

/// The figures of one pixel; 0 for a channel that is not counted.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CountedPixel {
    queries: u64,
    good: [u64; 3],
    widths: [f64; 3],
    strata: [u8; 3],
}

impl CountedPixel {
    /// The figures of a pixel without estimates.
    pub(crate) fn new(queries: u64, good: [u64; 3]) -> Self {
        Self {
            queries,
            good,
            ..Self::default()
        }
    }

    /// Adds the estimate of a channel, whose interval has this `width` in radiance.
    pub(crate) fn add_estimate(&mut self, channel: usize, estimate: &Estimate, width: f64) {
        // The sum is at most 3 * 2^40 * 10^6, below 2^62.
        self.queries += estimate.queries;
        // There are at most 31 strata.
        self.strata[channel] = estimate.strata as u8;
        self.widths[channel] = width;
    }
}

/// Figures of pixels, each a list in the order of the pixels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CountedPixels {
    /// Number of queries of the oracle, for all channels together. 0 under `exact`, which sums over
    /// all paths and queries no oracle. With a search for primary hits: queries of the oracle of
    /// nearest hits, for all paths together.
    pub queries: Vec<u64>,
    /// S, the number of good indices of each channel; 0 for a channel that is not counted.
    pub good: Vec<[u64; 3]>,
    /// Width of each channel's interval, in radiance; the interval has the estimator's confidence. 0
    /// under `exact`, which estimates nothing. With colour from one run, the width of the luminance
    /// is in the first place.
    pub widths: Vec<[f64; 3]>,
    /// Number of strata of the comparator that were counted one by one, by channel: 1 if the whole
    /// comparator was counted at once, 0 if nothing was counted. With colour from one run, the number
    /// of the luminance is in the first place.
    pub strata: Vec<[u8; 3]>,
}

impl CountedPixels {
    /// Bytes of a pixel's figures in a checkpoint.
    pub(crate) const BYTES: u64 = 59;

    /// Figures of `pixels` pixels, all 0.
    pub(crate) fn zeros(pixels: usize) -> Result<Self, TryReserveError> {
        Ok(Self {
            queries: filled(0, pixels)?,
            good: filled([0; 3], pixels)?,
            widths: filled([0.0; 3], pixels)?,
            strata: filled([0; 3], pixels)?,
        })
    }

    /// Adds the figures of the next pixel.
    pub(crate) fn push(&mut self, pixel: &CountedPixel) {
        self.queries.push(pixel.queries);
        self.good.push(pixel.good);
        self.widths.push(pixel.widths);
        self.strata.push(pixel.strata);
    }

    /// Adds the figures that `other` has of the pixels `from`.
    #[cfg(feature = "parts")]
    pub(crate) fn extend(&mut self, other: &Self, from: Range<usize>) {
        self.queries.extend(&other.queries[from.clone()]);
        self.good.extend(&other.good[from.clone()]);
        self.widths.extend(&other.widths[from.clone()]);
        self.strata.extend(&other.strata[from]);
    }

    /// Replaces the figures of the pixels `at` by those that `other` has of the pixels `from`.
    pub(crate) fn replace(&mut self, at: Range<usize>, other: &Self, from: Range<usize>) {
        self.queries[at.clone()].copy_from_slice(&other.queries[from.clone()]);
        self.good[at.clone()].copy_from_slice(&other.good[from.clone()]);
        self.widths[at.clone()].copy_from_slice(&other.widths[from.clone()]);
        self.strata[at].copy_from_slice(&other.strata[from]);
    }

    /// True if every list has this number of pixels.
    pub(crate) fn fill(&self, pixels: u64) -> bool {
        let lengths = [
            self.queries.len(),
            self.good.len(),
            self.widths.len(),
            self.strata.len(),
        ];
        lengths.iter().all(|&length| length as u64 == pixels)
    }

    /// Appends the figures to the bytes of a checkpoint: queries (u64 each), good indices (3 u64
    /// each), widths of intervals (3 f64 each), strata (3 u8 each); little-endian, floats as their
    /// bits.
    pub(crate) fn encode(&self, bytes: &mut Vec<u8>) {
        for number in self.queries.iter().chain(self.good.iter().flatten()) {
            bytes.extend(number.to_le_bytes());
        }
        for width in self.widths.iter().flatten() {
            bytes.extend(width.to_bits().to_le_bytes());
        }
        bytes.extend(self.strata.iter().flatten());
    }

    /// Decodes the figures of `pixels` pixels, which are all of `bytes`.
    pub(crate) fn decode(bytes: &[u8], pixels: usize) -> Option<Self> {
        let (queries, rest) = bytes.split_at_checked(8 * pixels)?;
        let (good, rest) = rest.split_at_checked(24 * pixels)?;
        let (widths, strata) = rest.split_at_checked(24 * pixels)?;
        let words = |bytes: &[u8]| -> Vec<u64> {
            let words = bytes.as_chunks::<8>().0.iter();
            words.map(|word| u64::from_le_bytes(*word)).collect()
        };
        let widths = words(widths);
        let widths = widths.as_chunks::<3>().0.iter();
        Some(Self {
            queries: words(queries),
            good: words(good).as_chunks::<3>().0.to_vec(),
            widths: widths.map(|width| width.map(f64::from_bits)).collect(),
            strata: strata.as_chunks::<3>().0.to_vec(),
        })
    }

    /// The number of pixels' channels for each number of strata.
    pub fn strata_used(&self) -> BTreeMap<u8, u64> {
        let mut used = BTreeMap::new();
        for &strata in self.strata.iter().flatten().filter(|&&strata| strata > 0) {
            *used.entry(strata).or_default() += 1;
        }
        used
    }

    /// Entries of a picture's metadata: the requested strata and those that were counted, if
    /// `estimator` counts strata.
    pub(crate) fn entries(
        &self,
        estimator: Estimator,
        counting: &Counting,
    ) -> Vec<(&'static str, String)> {
        if !estimator.counts_strata() {
            return Vec::new();
        }
        let asked = counting.strata.map_or("auto".into(), |n| n.to_string());
        let used = self.strata_used().into_iter();
        let used = used.map(|(n, channels)| format!("{n}:{channels}"));
        let used: Vec<String> = used.collect();
        vec![("strata", asked), ("strata_used", used.join(" "))]
    }
}

/// A list with a value for each pixel, or an error if there is not enough memory.
pub(crate) fn filled<T: Clone>(value: T, pixels: usize) -> Result<Vec<T>, TryReserveError> {
    let mut all = Vec::new();
    all.try_reserve_exact(pixels)?;
    all.resize(pixels, value);
    Ok(all)
}
