//! Products of a number with many constants, as sums of one another.
//!
//! Geometry multiplies the same few coordinates with many constants. A product by itself
//! is a sum of shifted copies of the number, with one addition less than its constant has signed
//! digits. But 45 is 5 times 9 and takes two additions instead of three, and after 45 the constant 361
//! takes only one more. That is *multiple constant multiplication* (Voronenko and Püschel,
//! *Multiplierless multiple constant multiplication*, ACM Transactions on Algorithms 3, 2007), and
//! what follows is a heuristic like theirs: a multiple that is one addition away from those that are
//! there is taken; of the others, one that brings as many of them as possible to one addition.
//!
//! All sums are exact, and a product drops its lowest bits afterwards.

use std::collections::{BTreeMap, HashSet};

/// So many candidates are compared by what they leave to do, at most.
const COMPARED: usize = 64;

/// Constants have at most so many bits.
const CONSTANT_BITS: u32 = 40;

/// A multiple and how far it is shifted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Term {
    /// An odd number.
    pub(crate) factor: i64,
    pub(crate) shift: u32,
}

impl Term {
    /// Of a number above 0.
    pub(crate) fn of(number: i64) -> Self {
        let shift = number.trailing_zeros();
        Self {
            factor: number >> shift,
            shift,
        }
    }
}

/// How a multiple follows from two others: `a ± b`, without the zeros below.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Sum {
    pub(crate) a: Term,
    pub(crate) b: Term,
    pub(crate) subtract: bool,
    pub(crate) zeros: u32,
}

impl Sum {
    /// About how many Toffolis it takes for a number of `width` bits: those of the sum from where both
    /// terms have bits.
    fn price(&self, multiple: i64, width: u32) -> u32 {
        let bits = width + (64 - multiple.leading_zeros()) + self.zeros;
        let alone = if self.subtract {
            self.b.shift
        } else {
            self.a.shift.max(self.b.shift)
        };
        bits.saturating_sub(alone)
    }
}

/// Products of one number with constants, and the sums by which they are computed.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Multiples {
    products: Box<[(i64, u32)]>,
    /// Odd multiples, each after those that it is the sum of.
    sums: Box<[(i64, Sum)]>,
}

/// Calls `found` with all sums of `known` and another multiple that are `multiple`, as far as their
/// terms are at most `most`.
fn partners(multiple: i64, known: i64, most: i64, mut found: impl FnMut(i64, Sum)) {
    let mut offer = |whole: i64, term: Term| {
        let zeros = whole.trailing_zeros();
        let shifted = term.factor << term.shift;
        let difference = whole - shifted;
        if difference != 0 {
            let other = Term::of(difference.abs());
            let (a, b) = if difference > 0 {
                (other, term)
            } else {
                (term, other)
            };
            let subtract = difference < 0;
            let sum = Sum {
                a,
                b,
                subtract,
                zeros,
            };
            found(other.factor, sum);
        }
        let other = Term::of(whole + shifted);
        let sum = Sum {
            a: other,
            b: term,
            subtract: true,
            zeros,
        };
        found(other.factor, sum);
    };
    let shifts = |number: i64| (0..CONSTANT_BITS).take_while(move |shift| number << shift <= most);
    for shift in shifts(known) {
        let factor = known;
        offer(multiple, Term { factor, shift });
    }
    for shift in shifts(multiple).skip(1) {
        offer(multiple << shift, Term::of(known));
    }
}

/// Nonzero digits of a number in the signed form that has fewest.
fn digits(number: i64) -> u32 {
    (number ^ (3 * number)).count_ones()
}

impl Multiples {
    /// Products of a number of `width` bits with constants, each of which drops so many of its lowest
    /// bits; none if a constant is below 1 or has more than 40 bits.
    pub fn new(products: &[(i64, u32)], width: u32) -> Option<Self> {
        let constants = 1..1 << CONSTANT_BITS;
        if products
            .iter()
            .any(|(factor, _)| !constants.contains(factor))
        {
            return None;
        }
        let odd = || products.iter().map(|(factor, _)| Term::of(*factor).factor);
        let mut search = Search {
            most: odd().max().map_or(1, |most| most << 2),
            width,
            known: vec![1],
            near: HashSet::new(),
            wanted: BTreeMap::new(),
        };
        search.reach(1);
        odd().for_each(|multiple| search.want(multiple));
        let sums = std::iter::from_fn(|| search.step()).collect();
        Some(Self {
            products: products.into(),
            sums,
        })
    }

    /// The constants, and how many of their products' lowest bits are dropped.
    pub fn products(&self) -> &[(i64, u32)] {
        &self.products
    }

    /// How many additions all of them take.
    pub fn additions(&self) -> usize {
        self.sums.len()
    }

    pub(crate) fn sums(&self) -> &[(i64, Sum)] {
        &self.sums
    }
}

struct Search {
    /// No multiple and no term is greater.
    most: i64,
    width: u32,
    known: Vec<i64>,
    /// What is one sum away from those that are known.
    near: HashSet<i64>,
    /// What is still to do, and from which further multiples it would be one sum.
    wanted: BTreeMap<i64, HashSet<i64>>,
}

impl Search {
    fn want(&mut self, multiple: i64) {
        if self.known.contains(&multiple) || self.wanted.contains_key(&multiple) {
            return;
        }
        let mut from: HashSet<i64> = HashSet::new();
        for &known in &self.known {
            partners(multiple, known, self.most, |other, _| {
                from.insert(other);
            });
        }
        // The sum of a multiple with itself, shifted.
        for shift in 1..CONSTANT_BITS {
            for factor in [(1 << shift) - 1, (1 << shift) + 1] {
                if factor > 1 && multiple % factor == 0 {
                    from.insert(multiple / factor);
                }
            }
        }
        self.wanted.insert(multiple, from);
    }

    /// Adds what is one sum away from `multiple` and those that are known.
    fn reach(&mut self, multiple: i64) {
        let most = self.most;
        for &known in &self.known {
            for [a, b] in [[multiple, known], [known, multiple]] {
                for shifted in (0..CONSTANT_BITS)
                    .map(|shift| a << shift)
                    .take_while(|&s| s <= most)
                {
                    let sums = [shifted + b, (shifted - b).abs()].into_iter();
                    let sums = sums.filter(|&sum| sum > 0).map(|sum| Term::of(sum).factor);
                    self.near.extend(sums.filter(|&sum| sum <= most));
                }
            }
        }
    }

    fn add(&mut self, multiple: i64) -> Option<(i64, Sum)> {
        let mut best: Option<(u32, Sum)> = None;
        for &known in &self.known {
            partners(multiple, known, self.most, |other, sum| {
                let price = sum.price(multiple, self.width);
                if self.known.contains(&other) && best.is_none_or(|(least, _)| price < least) {
                    best = Some((price, sum));
                }
            });
        }
        self.known.push(multiple);
        self.reach(multiple);
        self.wanted.remove(&multiple);
        for (&wanted, from) in &mut self.wanted {
            partners(wanted, multiple, self.most, |other, _| {
                from.insert(other);
            });
        }
        best.map(|(_, sum)| (multiple, sum))
    }

    fn step(&mut self) -> Option<(i64, Sum)> {
        loop {
            let known = |from: &HashSet<i64>| self.known.iter().any(|known| from.contains(known));
            let there = self.wanted.iter().find(|(_, from)| known(from));
            if let Some((&multiple, _)) = there {
                return self.add(multiple);
            }
            if self.wanted.is_empty() {
                return None;
            }
            if let Some(between) = self.between() {
                return self.add(between);
            }
            // Nothing is two sums away: what has the fewest digits of all that would help is wanted, too.
            let mut helpful: BTreeMap<i64, u32> = BTreeMap::new();
            for from in self.wanted.values() {
                for &other in from.iter().filter(|&&other| other <= self.most) {
                    *helpful.entry(other).or_default() += 1;
                }
            }
            let simplest =
                |&(&other, &helps): &(&i64, &u32)| (digits(other), std::cmp::Reverse(helps), other);
            let (&next, _) = helpful.iter().min_by_key(simplest)?;
            self.want(next);
        }
    }

    /// Of what is one sum away, that from which most of what is wanted is one sum.
    fn between(&self) -> Option<i64> {
        let mut helps: BTreeMap<i64, usize> = BTreeMap::new();
        for from in self.wanted.values() {
            for &other in from.iter().filter(|other| self.near.contains(other)) {
                *helps.entry(other).or_default() += 1;
            }
        }
        let most = *helps.values().max()?;
        let mut best = helps.into_iter().filter(|&(_, helps)| helps == most);
        if most == self.wanted.len() {
            return best.next().map(|(between, _)| between);
        }
        // What the others would then need, by the digits of the simplest multiple that would help.
        let left = |&between: &i64| -> u32 {
            let far = self
                .wanted
                .iter()
                .filter(|(_, from)| !from.contains(&between));
            far.map(|(&wanted, _)| {
                let mut fewest = u32::MAX;
                partners(wanted, between, self.most, |other, _| {
                    fewest = fewest.min(digits(other));
                });
                fewest
            })
            .sum()
        };
        let compared = best.take(COMPARED).map(|(between, _)| between);
        compared.min_by_key(|between| (left(between), *between))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Checks that each sum is what it says, of what was made before it, and returns how many there are.
    fn checked(wanted: &[i64]) -> usize {
        let products: Vec<(i64, u32)> = wanted.iter().map(|&factor| (factor, 0)).collect();
        let multiples = Multiples::new(&products, 18).unwrap();
        let mut made = HashSet::from([1]);
        for &(multiple, sum) in multiples.sums() {
            let [a, b] = [sum.a, sum.b].map(|term| {
                assert!(made.contains(&term.factor), "{multiple} by {sum:?}");
                term.factor << term.shift
            });
            let value = if sum.subtract { a - b } else { a + b };
            assert_eq!(value, multiple << sum.zeros, "{sum:?}");
            made.insert(multiple);
        }
        assert!(
            wanted
                .iter()
                .all(|&wanted| made.contains(&Term::of(wanted).factor))
        );
        multiples.additions()
    }

    #[test]
    fn constants_share_sums() {
        assert_eq!(checked(&[45]), 2);
        assert_eq!(checked(&[45, 361]), 3);
        assert_eq!(checked(&[3]), 1);
        assert_eq!(checked(&[]), 0);
        assert_eq!(checked(&[1, 4, 6, 3]), 1);
        for wrong in [0, -3, 1 << 40] {
            assert_eq!(Multiples::new(&[(3, 0), (wrong, 0)], 18), None);
        }
        // 24 additions by their digits.
        assert!(checked(&[160_563, 155_959, 82_957, 40_649]) <= 12);
    }

    /// Signed digits alone are what a product took before.
    #[test]
    fn one_constant_takes_no_more_additions_than_its_digits_and_mostly_fewer() {
        let odd = || (1..1_i64 << 12).step_by(2);
        let mut fewer = 0;
        for constant in odd() {
            let by_digits = digits(constant) as usize - 1;
            let sums = checked(&[constant]);
            assert!(sums <= by_digits, "{constant}: {sums} {by_digits}");
            fewer += by_digits - sums;
        }
        let by_digits: usize = odd().map(|constant| digits(constant) as usize - 1).sum();
        assert!(8 * fewer > by_digits, "{fewer} of {by_digits}");
    }

    proptest! {
        #[test]
        fn any_constants_are_reached(wanted in proptest::collection::vec(1_i64..1 << 24, 1..8)) {
            let by_digits: u32 = wanted.iter().map(|&n| digits(n) - 1).sum();
            let sums = checked(&wanted);
            prop_assert!(sums <= by_digits as usize, "{sums} {by_digits}");
        }
    }
}
