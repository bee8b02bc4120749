//! Repeated parts of a sequence, written once.
//!
//! Pairs of neighbours that occur more than once become symbols of their own, the most frequent
//! first, until every pair of the remaining sequence occurs once: Larsson and Moffat, *Off-line
//! dictionary-based compression*, Proceedings of the IEEE 88 (2000). Symbols that are too short to
//! be worth it, or are used once, are then written out again.

use std::collections::{HashMap, HashSet};

/// A sequence with symbols for its repeated parts.
pub(super) struct Repeats {
    pub(super) whole: Vec<usize>,
    /// The contents of the symbols beyond those of the sequence, each after those that it uses.
    pub(super) parts: Vec<Vec<usize>>,
}

impl Repeats {
    /// Finds the repeats in a sequence of symbols below `symbols`. Each part stands for at least
    /// `least` of them.
    pub(super) fn find(sequence: Vec<usize>, symbols: usize, least: usize) -> Self {
        let mut whole = sequence;
        let mut pairs: Vec<[usize; 2]> = Vec::new();
        loop {
            let frequent = frequent(&whole);
            if frequent.is_empty() {
                break;
            }
            let numbers = symbols + pairs.len()..;
            let replaced: HashMap<_, _> = frequent.iter().copied().zip(numbers).collect();
            pairs.extend(frequent);
            whole = replace(&whole, &replaced);
        }
        Writer::new(symbols, pairs, &whole, least).write(&whole)
    }
}

/// Returns the pairs of neighbours that occur most often, and others that occur nearly that often,
/// if no two pairs share a symbol. Empty if no pair occurs twice.
fn frequent(sequence: &[usize]) -> Vec<[usize; 2]> {
    let mut pairs: Vec<[usize; 2]> = sequence.windows(2).map(|two| [two[0], two[1]]).collect();
    pairs.sort_unstable();
    let runs = pairs.chunk_by(|a, b| a == b).filter(|run| run.len() > 1);
    let mut counted: Vec<(usize, [usize; 2])> = runs.map(|run| (run.len(), run[0])).collect();
    counted.sort_unstable_by(|a, b| b.cmp(a));
    let most = counted.first().map_or(0, |(most, _)| *most);
    let often = counted
        .into_iter()
        .take_while(|(count, _)| 3 * count >= 2 * most);
    let mut taken = HashSet::new();
    let apart = often.filter_map(|(_, pair)| {
        let is_free = pair.iter().all(|symbol| !taken.contains(symbol));
        is_free.then(|| {
            taken.extend(pair);
            pair
        })
    });
    apart.collect()
}

/// Returns the sequence with symbols in the place of pairs.
fn replace(sequence: &[usize], replaced: &HashMap<[usize; 2], usize>) -> Vec<usize> {
    let mut out = Vec::with_capacity(sequence.len());
    let mut rest = sequence;
    while let [symbol, after @ ..] = rest {
        let pair = after
            .first()
            .and_then(|next| replaced.get(&[*symbol, *next]));
        out.push(*pair.unwrap_or(symbol));
        rest = &after[usize::from(pair.is_some())..];
    }
    out
}

/// A writer of sequences, which writes out the pairs that are no parts.
struct Writer {
    symbols: usize,
    pairs: Vec<[usize; 2]>,
    /// The symbols of the pairs that are parts.
    parts: Vec<Option<usize>>,
}

impl Writer {
    fn new(symbols: usize, pairs: Vec<[usize; 2]>, whole: &[usize], least: usize) -> Self {
        let mut lengths = vec![1; symbols];
        let mut uses = vec![0; symbols + pairs.len()];
        for [a, b] in &pairs {
            lengths.push(lengths[*a] + lengths[*b]);
        }
        for symbol in pairs.iter().flatten().chain(whole) {
            uses[*symbol] += 1;
        }
        let mut next = symbols..;
        // A symbol that uses a long part is long itself, so no symbol that is too short uses a
        // part.
        let parts = lengths.iter().zip(uses).skip(symbols);
        let parts = parts.map(|(length, uses)| {
            let is_part = *length >= least && uses > 1;
            is_part.then(|| next.next()).flatten()
        });
        let parts = parts.collect();
        Self {
            symbols,
            pairs,
            parts,
        }
    }

    fn write(&self, whole: &[usize]) -> Repeats {
        let parts = self.pairs.iter().zip(&self.parts);
        let parts = parts.filter(|(_, part)| part.is_some());
        Repeats {
            whole: self.written(whole),
            parts: parts.map(|(pair, _)| self.written(pair)).collect(),
        }
    }

    fn written(&self, sequence: &[usize]) -> Vec<usize> {
        let mut out = Vec::new();
        let mut rest: Vec<usize> = sequence.iter().rev().copied().collect();
        while let Some(symbol) = rest.pop() {
            match symbol.checked_sub(self.symbols) {
                None => out.push(symbol),
                Some(pair) => match self.parts[pair] {
                    Some(part) => out.push(part),
                    None => rest.extend(self.pairs[pair].iter().rev()),
                },
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Checks the parts, and returns the original sequence.
    fn unfolded(repeats: &Repeats, symbols: usize, least: usize) -> Vec<usize> {
        let mut parts: Vec<Vec<usize>> = Vec::new();
        let write = |parts: &[Vec<usize>], sequence: &[usize]| {
            let own = sequence.iter().flat_map(|&symbol| {
                let part = symbol.checked_sub(symbols).map(|part| parts[part].clone());
                part.unwrap_or_else(|| vec![symbol])
            });
            own.collect::<Vec<_>>()
        };
        for (number, part) in repeats.parts.iter().enumerate() {
            parts.push(write(&parts, part));
            assert!(parts[number].len() >= least);
            let all = repeats.parts.iter().flatten().chain(&repeats.whole);
            assert!(all.filter(|&&symbol| symbol == symbols + number).count() > 1);
        }
        write(&parts, &repeats.whole)
    }

    #[test]
    fn nested_repetitions_are_told_once() {
        // Each level repeats the last one twice, with symbols of its own around it.
        let mut sequence: Vec<usize> = (0..20).collect();
        for level in 0..8 {
            let once = sequence.clone();
            sequence.insert(0, 20 + 3 * level);
            sequence.push(21 + 3 * level);
            sequence.extend(once);
            sequence.push(22 + 3 * level);
        }
        let repeats = Repeats::find(sequence.clone(), 44, 16);
        assert_eq!(unfolded(&repeats, 44, 16), sequence);
        assert_eq!(repeats.parts.len(), 8);
        let told = repeats.parts.iter().chain([&repeats.whole]);
        assert_eq!(told.map(Vec::len).sum::<usize>(), 20 + 8 * 5);
        assert!(sequence.len() > 5_000);
    }

    #[test]
    fn what_is_not_repeated_stays_as_it_is() {
        for sequence in [vec![], vec![0], (0..50).collect(), vec![1; 7]] {
            let repeats = Repeats::find(sequence.clone(), 50, 16);
            assert_eq!((repeats.whole, repeats.parts.len()), (sequence, 0));
        }
    }

    proptest! {
        #[test]
        fn any_sequence_is_told(
            sequence in proptest::collection::vec(0_usize..6, 0..300),
            least in 2_usize..20,
        ) {
            let repeats = Repeats::find(sequence.clone(), 6, least);
            prop_assert_eq!(unfolded(&repeats, 6, least), sequence);
        }
    }
}
