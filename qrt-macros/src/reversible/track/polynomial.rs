//! The content of a bit, as a polynomial over GF(2).
//!
//! Its variables, the *atoms*, are the initial bits of parameters and the results of operations:
//! the bits of a product, the truth of a comparison. Two bits with equal polynomials are equal on
//! every path; the bit that holds the polynomial 0 holds 0.

use std::collections::{BTreeSet, HashMap};
use std::rc::Rc;

/// An exclusive or of products of atoms. The empty product is 1, the empty exclusive or 0.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Bit(Rc<BTreeSet<Vec<u32>>>);

/// Products with more terms are not multiplied out: a factor becomes an atom.
const MOST_TERMS: usize = 32;

impl Bit {
    pub(super) fn constant(value: bool) -> Self {
        Self::sum(value.then(Vec::new))
    }

    pub(super) fn atom(atom: u32) -> Self {
        Self::sum([vec![atom]])
    }

    /// Returns the exclusive or of these products.
    fn sum(products: impl IntoIterator<Item = Vec<u32>>) -> Self {
        let mut sum = BTreeSet::new();
        for product in products {
            // A product that occurs twice cancels.
            if let Some(product) = sum.replace(product) {
                sum.remove(&product);
            }
        }
        Self(sum.into())
    }

    pub(super) fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    pub(super) fn known(&self) -> Option<bool> {
        let one = self.0.len() == 1 && self.0.first().is_some_and(Vec::is_empty);
        (self.is_zero() || one).then_some(one)
    }

    pub(super) fn xor(&self, other: &Self) -> Self {
        match (self.is_zero(), other.is_zero()) {
            (true, _) => other.clone(),
            (_, true) => self.clone(),
            _ => {
                let sum: BTreeSet<_> = self.0.symmetric_difference(&other.0).cloned().collect();
                Self(sum.into())
            }
        }
    }

    pub(super) fn not(&self) -> Self {
        self.xor(&Self::constant(true))
    }

    pub(super) fn and(&self, other: &Self, atoms: &mut Atoms) -> Self {
        let (own, others) = (self.0.len(), other.0.len());
        if own.min(others) > 1 && own * others > MOST_TERMS {
            let mut short = |factor: &Self| match factor.0.len() {
                0 | 1 => factor.clone(),
                _ => atoms.of_bit(factor),
            };
            return short(self).and(&short(other), atoms);
        }
        let products = self.0.iter().flat_map(|a| {
            other.0.iter().map(move |b| {
                let mut both: Vec<u32> = a.iter().chain(b).copied().collect();
                both.sort_unstable();
                both.dedup();
                both
            })
        });
        Self::sum(products)
    }

    /// True if it depends on an atom.
    pub(super) fn mentions(&self, atom: u32) -> bool {
        self.0.iter().any(|product| product.contains(&atom))
    }

    /// Returns the polynomial where an atom has this value.
    pub(super) fn with(&self, atom: u32, value: bool) -> Self {
        if !self.mentions(atom) {
            return self.clone();
        }
        let products = self.0.iter().filter_map(|product| {
            let mut product = product.clone();
            if let Some(place) = product.iter().position(|other| *other == atom) {
                if !value {
                    return None;
                }
                product.remove(place);
            }
            Some(product)
        });
        Self::sum(products)
    }

    /// Returns an atom and a value: the atom has this value exactly where the polynomial is 1.
    pub(super) fn as_guard(&self, atoms: &mut Atoms) -> (u32, bool) {
        let inverted = self.0.contains(&Vec::new());
        let rest = if inverted { self.not() } else { self.clone() };
        let single = match rest.0.first() {
            Some(product) if rest.0.len() == 1 && product.len() == 1 => Some(product[0]),
            _ => None,
        };
        let atom = single.unwrap_or_else(|| {
            let word = atoms.word(&[rest]);
            atoms.named(&format!("bit {word}"))
        });
        (atom, !inverted)
    }
}

/// Numbers of atoms, and of words of bits: equal ones have equal numbers.
#[derive(Default)]
pub(super) struct Atoms {
    names: HashMap<String, u32>,
    words: HashMap<Vec<Bit>, u32>,
}

impl Atoms {
    /// Returns the atom of this name.
    pub(super) fn named(&mut self, name: &str) -> u32 {
        let next = self.names.len() as u32;
        *self.names.entry(name.to_owned()).or_insert(next)
    }

    /// Returns the number of a word, which is a list of bits, the lowest first.
    pub(super) fn word(&mut self, bits: &[Bit]) -> u32 {
        let next = self.words.len() as u32;
        *self.words.entry(bits.to_vec()).or_insert(next)
    }

    /// Returns a polynomial as one atom, or as its negation.
    fn of_bit(&mut self, bit: &Bit) -> Bit {
        let (atom, value) = bit.as_guard(self);
        let atom = Bit::atom(atom);
        if value { atom } else { atom.not() }
    }

    /// Returns `width` bits of a word that is known by its name alone.
    pub(super) fn bits(&mut self, name: &str, width: usize) -> Vec<Bit> {
        let mut bit = |place| Bit::atom(self.named(&format!("{name}[{place}]")));
        (0..width).map(&mut bit).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the value of a polynomial whose atoms are the bits of `values`.
    fn value(bit: &Bit, values: u32) -> bool {
        let holds = |product: &&Vec<u32>| product.iter().all(|atom| values >> atom & 1 == 1);
        bit.0.iter().filter(holds).count() % 2 == 1
    }

    #[test]
    fn polynomials_compute_what_bits_compute() {
        let mut atoms = Atoms::default();
        let [a, b, c] = [0, 1, 2].map(Bit::atom);
        let majority = a.and(&b, &mut atoms);
        let majority = majority.xor(&a.xor(&b).and(&c, &mut atoms));
        for values in 0..8_u32 {
            assert_eq!(value(&majority, values), values.count_ones() >= 2);
            assert_eq!(value(&majority.not(), values), values.count_ones() < 2);
        }
        assert_eq!(majority.with(2, false), a.and(&b, &mut atoms));
        assert_eq!(majority.xor(&majority).known(), Some(false));
        assert_eq!(a.and(&a, &mut atoms), a);
    }

    #[test]
    fn long_products_are_equal_if_their_factors_are() {
        let mut atoms = Atoms::default();
        let names: Vec<String> = (0..12).map(|atom| format!("x[{atom}]")).collect();
        let mut sum = |from: usize, to: usize| {
            let parts = names[from..to].iter().map(|name| atoms.named(name));
            parts.fold(Bit::default(), |sum, atom| sum.xor(&Bit::atom(atom)))
        };
        let (a, b) = (sum(0, 6), sum(6, 12));
        let product = a.and(&b, &mut atoms);
        assert_eq!(product, b.and(&a, &mut atoms));
        assert_eq!(product.0.len(), 1);
        assert_ne!(product, a.and(&b.not(), &mut atoms));
    }
}
