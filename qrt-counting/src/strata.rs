//! Strata of the comparator: ranges of thresholds, each of which is counted on its own.
//!
//! A path whose colour exceeds `count` of the `C = 2^c` thresholds is good with the comparators
//! `0..count`. A range of thresholds `start..start + length` contains
//! `clamp(count - start, 0, length)` of them, so the good indices of a partition's strata add up to
//! S:
//!
//! ```text
//! S/N = sum_k w_k a_k,    w_k = length_k / C,    a_k the fraction of good indices of stratum k.
//! ```
//!
//! The strata are unions of *octaves*, each of which is half of the rest of the range: octave 0 is
//! the threshold 0, and octave o the thresholds `2^(o-1)..2^o`. A comparator in octave o has its
//! bit `o - 1` set and none above it. For these bits, the circuit of a stratum has an X or nothing
//! where the circuit of the whole range has a Hadamard.

use std::ops::Range;

/// A range of thresholds that begins and ends with octaves.
///
/// ```
/// use qrt_counting::Stratum;
/// let ranges: Vec<_> = Stratum::halving(3, 4).map(|stratum| stratum.thresholds()).collect();
/// assert_eq!(ranges, [0..4, 4..8, 8..16]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stratum {
    first: u32,
    end: u32,
}

impl Stratum {
    /// All thresholds of a comparator of `bits` bits.
    pub fn whole(bits: u32) -> Self {
        Self {
            first: 0,
            end: bits + 1,
        }
    }

    /// Splits the range of `2^bits` thresholds into `strata` parts, from the darkest.
    ///
    /// The last part is the upper half of the range, the part before it the upper half of the rest,
    /// and so on. There are at most `bits + 1` parts.
    pub fn halving(strata: u32, bits: u32) -> impl ExactSizeIterator<Item = Self> + Clone {
        let rest = bits + 1 - (strata.clamp(1, bits + 1) - 1);
        (rest..bits + 2).map(move |end| Self {
            first: if end == rest { 0 } else { end - 1 },
            end,
        })
    }

    /// The octaves of the stratum.
    pub fn octaves(self) -> Range<usize> {
        self.first as usize..self.end as usize
    }

    /// The thresholds of the stratum.
    pub fn thresholds(self) -> Range<u64> {
        let start = |octave: u32| (1_u64 << octave) >> 1;
        start(self.first)..start(self.end)
    }

    /// Number of thresholds in the stratum.
    pub fn length(self) -> u64 {
        let Range { start, end } = self.thresholds();
        end - start
    }

    /// Number of good comparators in the stratum, for a colour that exceeds `count` thresholds.
    pub fn good(self, count: u64) -> u64 {
        let Range { start, end } = self.thresholds();
        count.clamp(start, end) - start
    }

    /// The comparator's bits that are equal in the whole stratum, and whether the lowest of them is
    /// 1.
    ///
    /// All higher ones are 0.
    pub fn fixed_bits(self, bits: u32) -> (Range<u32>, bool) {
        let free = if self.first == 0 {
            self.end
        } else {
            self.first
        };
        (free.saturating_sub(1)..bits, self.first > 0)
    }
}

/// Numbers of thresholds that the colours of paths exceed, summarised as strata need them.
///
/// For each length in bits of a path's count: the number of paths and the sum of their counts.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Octaves {
    bits: u32,
    paths: Vec<u64>,
    sums: Vec<u64>,
}

/// The length in bits of a path's count.
#[inline]
pub(crate) fn length_of(count: u64) -> usize {
    (u64::BITS - count.leading_zeros()) as usize
}

impl Octaves {
    /// Creates a summary of no paths, for a comparator of `bits` bits.
    pub fn new(bits: u32) -> Self {
        // The largest count, 2^bits, is bits + 1 long.
        let lengths = bits as usize + 2;
        Self {
            bits,
            paths: vec![0; lengths],
            sums: vec![0; lengths],
        }
    }

    /// Number of bits of the comparator.
    pub fn bits(&self) -> u32 {
        self.bits
    }

    /// Adds a path whose colour exceeds `count` thresholds, at most `2^bits`.
    #[inline]
    pub fn add(&mut self, count: u64) {
        self.add_paths(count, 1);
    }

    /// Adds `paths` paths whose colours exceed `count` thresholds, at most `2^bits`.
    #[inline]
    pub(crate) fn add_paths(&mut self, count: u64, paths: u64) {
        let length = length_of(count);
        self.paths[length] += paths;
        self.sums[length] += count * paths;
    }

    /// Adds the paths of `other`, which has the same comparator.
    pub fn append(&mut self, other: &Self) {
        if self.paths.is_empty() {
            self.clone_from(other);
            return;
        }
        let sums = self.sums.iter_mut().zip(&other.sums);
        for (sum, more) in self.paths.iter_mut().zip(&other.paths).chain(sums) {
            *sum += more;
        }
    }

    /// A summary with the same comparator and the pairs that `next` returns, one per length.
    ///
    /// The order is that of [`Octaves::by_length`]. The result is `None` if `next` ends early.
    pub fn with_lengths(&self, mut next: impl FnMut() -> Option<(u64, u64)>) -> Option<Self> {
        let mut octaves = self.clone();
        for (paths, sum) in octaves.paths.iter_mut().zip(&mut octaves.sums) {
            (*paths, *sum) = next()?;
        }
        Some(octaves)
    }

    /// The number of paths and the sum of their counts, for each length of the counts in bits.
    pub fn by_length(&self) -> impl Iterator<Item = (u64, u64)> {
        self.paths.iter().copied().zip(self.sums.iter().copied())
    }

    /// Number of paths.
    pub fn paths(&self) -> u64 {
        self.paths.iter().sum()
    }

    /// Number of good indices in each octave, from the darkest.
    pub fn good(&self) -> Vec<u64> {
        let mut longer: u64 = self.paths.iter().skip(1).sum();
        // Good indices below threshold 2^o: a count of up to o bits adds itself, a longer count
        // 2^o.
        let (mut below, mut sum) = (0, 0);
        (0..=self.bits as usize)
            .map(|octave| {
                if octave > 0 {
                    longer -= self.paths[octave];
                    sum += self.sums[octave];
                }
                let all = sum + (longer << octave);
                let good = all - below;
                below = all;
                good
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
            #[test]
            fn good_indices_of_strata_are_those_of_their_thresholds(
                bits in 1..12_u32, fractions in proptest::collection::vec(0.0..=1.0_f64, 0..40),
                cut in 0..40_usize,
            ) {
                let counts: Vec<u64> =
                    fractions.iter().map(|f| (f * f64::from(1_u32 << bits)).round() as u64).collect();
                let (early, late) = counts.split_at(cut.min(counts.len()));
                let mut octaves = Octaves::new(bits);
                for &count in early {
     octaves.add(count);
    }
                let mut later = Octaves::new(bits);
                for &count in late {
     later.add(count);
    }
                octaves.append(&later);
                let good = octaves.good();
                prop_assert_eq!(octaves.paths(), counts.len() as u64);
                prop_assert_eq!(good.iter().sum::<u64>(), counts.iter().sum::<u64>());
                for strata in 1..=bits + 3 {
                    let parts: Vec<Stratum> = Stratum::halving(strata, bits).collect();
                    prop_assert_eq!(parts.len() as u32, strata.min(bits + 1));
                    let mut next = 0;
                    for part in parts {
                        let thresholds = part.thresholds();
                        prop_assert_eq!(thresholds.start, next);
                        next = thresholds.end;
                        let one_by_one: u64 = (counts.iter())
                            .map(|&count| thresholds.clone().filter(|&y| y < count).count() as u64)
                            .sum();
                        prop_assert_eq!(good[part.octaves()].iter().sum::<u64>(), one_by_one);
                        prop_assert_eq!(counts.iter().map(|&c| part.good(c)).sum::<u64>(), one_by_one);
                        // All comparators of the stratum agree in the fixed bits.
                        let (fixed, lowest) = part.fixed_bits(bits);
                        for y in thresholds {
                            for bit in fixed.clone() {
                                let one = lowest && bit == fixed.start;
                                prop_assert_eq!(y >> bit & 1 == 1, one);
                            }
                        }
                        prop_assert_eq!(part.length(), 1 << (bits - fixed.len() as u32));
                    }
                    prop_assert_eq!(next, 1 << bits);
                }
            }
        }
}
