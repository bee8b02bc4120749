//! The content of a register: a sum of words, each of which is a list of bits.

use super::polynomial::{Atoms, Bit};
use std::collections::{BTreeMap, HashMap};

/// `sum of factor * word`, modulo `2^width`. An update by `^=` leaves one word; an update by `+=`
/// adds to the sum.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Content {
    width: usize,
    terms: BTreeMap<Vec<Bit>, u64>,
}

/// Sums whose bits have been read, by these bits.
pub(super) type Sums = HashMap<Vec<Bit>, Content>;

impl Content {
    pub(super) fn zero(width: usize) -> Self {
        Self {
            width,
            terms: BTreeMap::new(),
        }
    }

    pub(super) fn from_bits(bits: &[Bit], sums: &Sums) -> Self {
        let mut content = Self::zero(bits.len());
        content.add(bits, 1, sums);
        content
    }

    pub(super) fn width(&self) -> usize {
        self.width
    }

    fn mask(&self) -> u64 {
        u64::MAX >> (64 - self.width)
    }

    /// Adds `factor * word`; the word has the width of this register.
    pub(super) fn add(&mut self, word: &[Bit], factor: u64, sums: &Sums) {
        if let Some(sum) = sums.get(word) {
            for (word, own) in &sum.terms {
                self.add_term(word.clone(), own.wrapping_mul(factor));
            }
            return;
        }
        let known: Option<Vec<bool>> = word.iter().map(Bit::known).collect();
        if let Some(bits) = known {
            let units = bits.iter().rev().fold(0, |n, bit| n << 1 | u64::from(*bit));
            self.add_term(one(self.width), units.wrapping_mul(factor));
            return;
        }
        // Zeros below belong to the factor, so that 2 x equals x added twice.
        let zeros = word.iter().take_while(|bit| bit.is_zero()).count();
        let mut word = word[zeros..].to_vec();
        word.resize(self.width, Bit::default());
        self.add_term(word, factor << zeros);
    }

    fn add_term(&mut self, word: Vec<Bit>, factor: u64) {
        let mask = self.mask();
        let own = self.terms.entry(word).or_default();
        *own = own.wrapping_add(factor) & mask;
        self.terms.retain(|_, factor| *factor != 0);
    }

    /// Returns the register's bits, the lowest first.
    pub(super) fn bits(&self, atoms: &mut Atoms, sums: &mut Sums) -> Vec<Bit> {
        let single = match self.terms.first_key_value() {
            None => return vec![Bit::default(); self.width],
            Some(term) => (self.terms.len() == 1).then_some(term),
        };
        if let Some((word, factor)) = single {
            if *word == one(self.width) {
                let bit = |place| Bit::constant(factor >> place & 1 == 1);
                return (0..self.width).map(bit).collect();
            }
            if factor.is_power_of_two() {
                let mut bits = vec![Bit::default(); factor.trailing_zeros() as usize];
                bits.extend_from_slice(word);
                bits.truncate(self.width);
                return bits;
            }
        }
        let terms = self.terms.iter();
        let terms: Vec<(u32, u64)> = terms.map(|(word, by)| (atoms.word(word), *by)).collect();
        let bits = atoms.bits(&format!("sum {terms:?}"), self.width);
        sums.insert(bits.clone(), self.clone());
        bits
    }

    /// Returns the content where an atom has this value.
    pub(super) fn with(&self, atom: u32, value: bool, sums: &Sums) -> Self {
        if !self.terms.keys().flatten().any(|bit| bit.mentions(atom)) {
            return self.clone();
        }
        let mut rest = Self::zero(self.width);
        for (word, factor) in &self.terms {
            let word: Vec<Bit> = word.iter().map(|bit| bit.with(atom, value)).collect();
            rest.add(&word, *factor, sums);
        }
        rest
    }

    /// Adds `end` minus `start`, where the guard holds its value.
    pub(super) fn add_difference(
        &mut self,
        [start, end]: [&Self; 2],
        (atom, value): (u32, bool),
        atoms: &mut Atoms,
        sums: &Sums,
    ) {
        let guard = Bit::atom(atom);
        for (content, sign) in [(end, 1), (start, u64::MAX)] {
            for (word, factor) in &content.terms {
                let factor = factor.wrapping_mul(sign);
                let guarded: Vec<Bit> = word.iter().map(|bit| guard.and(bit, atoms)).collect();
                if value {
                    self.add(&guarded, factor, sums);
                } else {
                    // (1 - g) w = w - g w
                    self.add(word, factor, sums);
                    self.add(&guarded, factor.wrapping_neg(), sums);
                }
            }
        }
    }
}

/// Returns the word 1.
fn one(width: usize) -> Vec<Bit> {
    let mut bits = vec![Bit::default(); width];
    bits[0] = Bit::constant(true);
    bits
}
