//! Colours of a pixel's paths, as levels: how many paths exceed how many thresholds.

use crate::Octaves;
use qrt_circuit::quantum::MAX_LEVEL_BITS;

/// Number of paths by level: the number of thresholds, of `2^bits`, that a path's colour exceeds.
///
/// ```
/// use qrt_counting::Histogram;
/// let mut histogram = Histogram::new(3);
/// histogram.add_all([8, 0, 8]);
/// assert_eq!(histogram.levels().collect::<Vec<_>>(), [(0, 1), (8, 2)]);
/// assert_eq!((histogram.paths(), histogram.good()), (3, 16));
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Histogram {
    bits: u32,
    /// Levels in ascending order, with their numbers of paths.
    levels: Vec<(u64, u64)>,
}

impl Histogram {
    /// Creates a histogram of no paths, for a comparator of `bits` bits.
    pub fn new(bits: u32) -> Self {
        Self {
            bits,
            levels: Vec::new(),
        }
    }

    /// Number of bits of the comparator.
    pub fn bits(&self) -> u32 {
        self.bits
    }

    /// Adds paths of these levels, each at most `2^bits`.
    pub fn add_all(&mut self, levels: impl IntoIterator<Item = u64>) {
        let mut new: Vec<u64> = levels.into_iter().collect();
        new.sort_unstable();
        let equal = new.chunk_by(|a, b| a == b);
        self.merge(equal.map(|levels| (levels[0], levels.len() as u64)));
    }

    /// Adds the paths of `other`, which has the same comparator.
    pub fn append(&mut self, other: &Self) {
        self.bits = other.bits;
        self.merge(other.levels());
    }

    /// Adds pairs of a level and its number of paths, in ascending order.
    fn merge(&mut self, mut new: impl Iterator<Item = (u64, u64)>) {
        let old = std::mem::take(&mut self.levels);
        let mut next = new.next();
        for (level, paths) in old {
            while let Some(pair) = next.filter(|pair| pair.0 < level) {
                self.levels.push(pair);
                next = new.next();
            }
            let same = next.filter(|pair| pair.0 == level);
            self.levels
                .push((level, paths + same.map_or(0, |pair| pair.1)));
            if same.is_some() {
                next = new.next();
            }
        }
        self.levels.extend(next);
        self.levels.extend(new);
    }

    /// The levels that paths have, in ascending order, with their numbers of paths.
    pub fn levels(&self) -> impl ExactSizeIterator<Item = (u64, u64)> {
        self.levels.iter().copied()
    }

    /// Number of paths.
    pub fn paths(&self) -> u64 {
        self.levels().map(|(_, paths)| paths).sum()
    }

    /// Number of good indices: the sum of the paths' levels.
    pub fn good(&self) -> u64 {
        self.levels().map(|(level, paths)| level * paths).sum()
    }
}

impl From<&Histogram> for Octaves {
    fn from(histogram: &Histogram) -> Self {
        let mut octaves = Self::new(histogram.bits);
        for (level, paths) in histogram.levels() {
            octaves.add_paths(level, paths);
        }
        octaves
    }
}

/// The levels of a pixel's paths: one by one for a comparator that the mean-phase circuit takes, or
/// else by octave.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LevelCounts {
    /// By octave.
    Octaves(Octaves),
    /// One by one.
    Histogram(Histogram),
}

impl Default for LevelCounts {
    fn default() -> Self {
        Self::Octaves(Octaves::default())
    }
}

impl LevelCounts {
    /// Creates counts of no paths, for a comparator of `bits` bits: one by one up to 12 bits.
    pub fn new(bits: u32) -> Self {
        if bits <= MAX_LEVEL_BITS {
            Self::Histogram(Histogram::new(bits))
        } else {
            Self::Octaves(Octaves::new(bits))
        }
    }

    /// Adds paths of these levels, each at most `2^bits`.
    pub fn add_all(&mut self, levels: impl IntoIterator<Item = u64>) {
        match self {
            Self::Octaves(octaves) => levels.into_iter().for_each(|level| octaves.add(level)),
            Self::Histogram(histogram) => histogram.add_all(levels),
        }
    }

    /// Adds the paths of `other`, which has the same comparator.
    pub fn append(&mut self, other: &Self) {
        match (&mut *self, other) {
            (Self::Octaves(sums), Self::Octaves(other)) => sums.append(other),
            (Self::Histogram(sums), Self::Histogram(other)) => sums.append(other),
            // Counts of no paths, as `default` makes them.
            (Self::Octaves(sums), Self::Histogram(_)) => {
                debug_assert_eq!(sums.paths(), 0, "levels of one comparator are of one kind");
                *self = other.clone();
            }
            (Self::Histogram(_), Self::Octaves(other)) => {
                debug_assert_eq!(other.paths(), 0, "levels of one comparator are of one kind");
            }
        }
    }

    /// Number of good indices.
    pub fn good(&self) -> u64 {
        match self {
            Self::Octaves(octaves) => octaves.good().iter().sum(),
            Self::Histogram(histogram) => histogram.good(),
        }
    }

    /// The counts by octave.
    pub fn octaves(&self) -> Octaves {
        match self {
            Self::Octaves(octaves) => octaves.clone(),
            Self::Histogram(histogram) => Octaves::from(histogram),
        }
    }

    /// The counts as words, from which [`LevelCounts::decode`] makes them again.
    pub fn encode(&self, words: &mut Vec<u64>) {
        match self {
            Self::Octaves(octaves) => {
                words.extend(octaves.by_length().flat_map(|(paths, sum)| [paths, sum]));
            }
            Self::Histogram(histogram) => {
                words.push(histogram.levels.len() as u64);
                words.extend(histogram.levels().flat_map(|(level, paths)| [level, paths]));
            }
        }
    }

    /// Counts like these, which are of no paths, from words; `None` if the words are not those of
    /// such counts.
    pub fn decode(&self, words: &mut impl Iterator<Item = u64>) -> Option<Self> {
        match self {
            Self::Octaves(octaves) => octaves
                .with_lengths(|| Some((words.next()?, words.next()?)))
                .map(Self::Octaves),
            Self::Histogram(none) => {
                let mut histogram = none.clone();
                for _ in 0..words.next()? {
                    let pair = (words.next()?, words.next()?);
                    let above = histogram.levels.last().is_none_or(|last| last.0 < pair.0);
                    if !above || pair.0 > 1 << none.bits {
                        return None;
                    }
                    histogram.levels.push(pair);
                }
                Some(Self::Histogram(histogram))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    proptest! {
        #[test]
        fn counts_are_those_of_a_map_and_survive_as_words(
            bits in 0..15_u32, fractions in proptest::collection::vec(0.0..=1.0_f64, 0..60),
            cut in 0..60_usize,
        ) {
            let all = (1_u64 << bits) as f64;
            let levels: Vec<u64> = fractions.iter().map(|x| (x * x * all).round() as u64).collect();
            let (early, late) = levels.split_at(cut.min(levels.len()));
            let none = LevelCounts::new(bits);
            let (mut counts, mut later) = (none.clone(), none.clone());
            counts.add_all(early.iter().copied());
            later.add_all(late.iter().copied());
            counts.append(&later);
            prop_assert_eq!(counts.good(), levels.iter().sum::<u64>());
            let mut words = Vec::new();
            counts.encode(&mut words);
            prop_assert_eq!(none.decode(&mut words.iter().copied()), Some(counts.clone()));
            if !words.is_empty() {
                prop_assert_eq!(none.decode(&mut words[1..].iter().copied()).filter(|c| *c == counts), None);
            }
            let mut octaves = Octaves::new(bits);
            for level in &levels {
                octaves.add(*level);
            }
            prop_assert_eq!(counts.octaves(), octaves);
            if let LevelCounts::Histogram(histogram) = &counts {
                let mut map = BTreeMap::new();
                for level in &levels {
                    *map.entry(*level).or_insert(0) += 1;
                }
                prop_assert_eq!(histogram.levels().collect::<Vec<_>>(), map.into_iter().collect::<Vec<_>>());
                prop_assert_eq!(histogram.paths(), levels.len() as u64);
            } else {
                prop_assert!(bits > 12);
            }
            let mut sums = LevelCounts::default();
            sums.append(&counts);
            prop_assert_eq!(sums, counts);
        }
    }
}
