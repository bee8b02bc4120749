//! Products of a number with many constants, as sums of one another.
//!
//! Geometry multiplies the same few coordinates by many constants. A single product is a sum of
//! shifted copies of the number, with one addition less than its constant has signed digits. But 45
//! is 5 times 9 and takes two additions instead of three, and after 45 the constant 361 takes only
//! one more. That is *multiple constant multiplication* (Voronenko and Püschel, *Multiplierless
//! multiple constant multiplication*, ACM Transactions on Algorithms 3, 2007). The search below is
//! a heuristic like theirs. It takes a wanted multiple that is one addition away from the known
//! ones. If there is none, it takes a multiple that brings the most of the wanted ones to one
//! addition.
//!
//! All sums are exact, and a product drops its lowest bits afterwards.
//!
//! The search is a part of what `qrt!` does while a program is compiled, usually in an unoptimised
//! build. There, everything except an operator or an index into a slice is a call: hence plain
//! loops, and a set type of its own.

mod candidates;

use crate::Cores;
use candidates::{Candidates, Set};
use std::collections::{HashMap, HashSet};
use std::hash::{Hash, Hasher};
use std::sync::{Arc, Mutex, PoisonError};

/// The most candidates that are compared by their estimated remaining work.
const COMPARED: usize = 64;

/// The most bits of a constant.
const CONSTANT_BITS: u32 = 40;

/// A multiple and how far it is shifted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Term {
    /// The odd factor.
    pub(crate) factor: i64,
    pub(crate) shift: u32,
}

impl Term {
    /// Splits a number above 0 into its odd factor and its shift.
    pub(crate) fn from_number(number: i64) -> Self {
        let shift = number.trailing_zeros();
        Self {
            factor: number >> shift,
            shift,
        }
    }
}

/// The sum of two terms that yields a multiple: `a ± b`, without the zeros below.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Sum {
    pub(crate) a: Term,
    pub(crate) b: Term,
    pub(crate) subtract: bool,
    pub(crate) zeros: u32,
}

impl Sum {
    /// Estimates the Toffolis of the sum, except for those of the number's bits: those of the bits
    /// from the place where both terms have bits.
    fn price(&self, multiple: i64) -> i32 {
        let bits = 64 - multiple.leading_zeros() + self.zeros;
        let alone = if self.subtract {
            self.b.shift
        } else {
            self.a.shift.max(self.b.shift)
        };
        bits as i32 - alone as i32
    }
}

/// Products of one number with constants, and the sums by which they are computed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Multiples {
    products: Box<[(i64, u32)]>,
    /// Odd multiples, each after the terms of its sum.
    sums: Arc<[(i64, Sum)]>,
}

/// A cache of the sums that compute multiples, found once for the same constants without their
/// zeros.
#[derive(Clone, Debug, Default)]
pub struct KnownSums {
    found: HashMap<Vec<i64>, Arc<[(i64, Sum)]>>,
}

/// Hashes the products alone, since the sums follow from them.
impl Hash for Multiples {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.products.hash(state);
    }
}

/// Calls `found` with all sums of `known` and another multiple of `all` that equal `multiple`, if
/// their terms are at most `most`.
fn partners(multiple: i64, known: i64, most: i64, all: &Set, mut found: impl FnMut(Partner)) {
    let mut offer = |whole: i64, term: Term| {
        let shifted = term.factor << term.shift;
        let difference = whole - shifted;
        let other = distance(whole, shifted);
        if difference != 0 && all.contains(odd_part(other)) {
            found(Partner {
                whole,
                term,
                other,
                minus: difference < 0,
                from_other: false,
            });
        }
        let other = whole + shifted;
        if all.contains(odd_part(other)) {
            found(Partner {
                whole,
                term,
                other,
                minus: true,
                from_other: true,
            });
        }
    };
    let mut shift = 0;
    while shift < CONSTANT_BITS && known << shift <= most {
        let factor = known;
        offer(multiple, Term { factor, shift });
        shift += 1;
    }
    let term = Term::from_number(known);
    let mut shift = 1;
    while shift < CONSTANT_BITS && multiple << shift <= most {
        offer(multiple << shift, term);
        shift += 1;
    }
}

/// The other multiples that form `multiple` together with `known`, some of them more than once.
struct Others {
    numbers: [i64; 4 * CONSTANT_BITS as usize],
    count: usize,
}

impl Others {
    /// Finds the multiples. `multiple` and `known` are odd, so their sum or difference is even only
    /// if neither is shifted.
    #[inline(always)]
    fn new(multiple: i64, known: i64, most: i64) -> Self {
        let mut others = Self {
            numbers: [0; 4 * CONSTANT_BITS as usize],
            count: 0,
        };
        if known <= most {
            if multiple != known {
                others.push(odd_part(distance(multiple, known)));
            }
            others.push(odd_part(multiple + known));
        }
        others.push_shifted(multiple, known, most);
        others.push_shifted(known, multiple, most);
        others
    }

    #[inline(always)]
    fn push_shifted(&mut self, number: i64, shifted: i64, most: i64) {
        let mut shift = 1;
        while shift < CONSTANT_BITS && shifted << shift <= most {
            self.push(distance(number, shifted << shift));
            self.push(number + (shifted << shift));
            shift += 1;
        }
    }

    #[inline(always)]
    fn push(&mut self, number: i64) {
        self.numbers[self.count] = number;
        self.count += 1;
    }
}

/// `|a - b|`; the library's function is a call in unoptimised code.
#[inline(always)]
fn distance(a: i64, b: i64) -> i64 {
    if a < b { b - a } else { a - b }
}

/// Returns a number above 0 without its factors of two.
#[inline(always)]
fn odd_part(mut number: i64) -> i64 {
    while number & 1 == 0 {
        number >>= 1;
    }
    number
}

/// Two terms whose sum or difference is `whole`.
#[derive(Clone, Copy)]
struct Partner {
    whole: i64,
    term: Term,
    /// The other term, as a number.
    other: i64,
    /// True if one term is subtracted: the other one from `term`, or `term` from it if
    /// `from_other`.
    minus: bool,
    from_other: bool,
}

impl Partner {
    fn sum(&self) -> Sum {
        let other = Term::from_number(self.other);
        let (a, b) = if self.minus && !self.from_other {
            (self.term, other)
        } else {
            (other, self.term)
        };
        Sum {
            a,
            b,
            subtract: self.minus,
            zeros: self.whole.trailing_zeros(),
        }
    }
}

/// Number of nonzero digits of a number in the signed form with the fewest.
#[inline(always)]
fn digits(number: i64) -> u32 {
    ((number ^ (3 * number)) as u64).count_ones()
}

impl Multiples {
    /// Products of a number with constants: each constant, and the number of lowest bits that its
    /// product drops. `None` if a constant is below 1 or has more than 40 bits.
    pub fn new(products: &[(i64, u32)]) -> Option<Self> {
        Self::known(products, &mut KnownSums::default())
    }

    /// Finds products as [`Multiples::new`] does, with a cache: the sums follow from the constants
    /// alone.
    pub fn known(products: &[(i64, u32)], known: &mut KnownSums) -> Option<Self> {
        Self::all(&[products.into()], known, Cores::One).pop()?
    }

    /// Finds products as [`Multiples::known`] does, for several numbers.
    pub fn all(
        products: &[Box<[(i64, u32)]>],
        known: &mut KnownSums,
        cores: Cores,
    ) -> Vec<Option<Self>> {
        let odd: Vec<Option<Vec<i64>>> = products.iter().map(|own| odd_factors(own)).collect();
        let unknown = odd.iter().flatten();
        let unknown = unknown.filter(|odd| !known.found.contains_key(*odd));
        let unknown: Vec<&Vec<i64>> = unknown.collect::<HashSet<_>>().into_iter().collect();
        // Memory of earlier searches is reused: it is most of the memory that a search allocates.
        let rooms = Mutex::new(Vec::new());
        let rooms = || rooms.lock().unwrap_or_else(PoisonError::into_inner);
        let found = cores.map(&unknown, 4, |odd| {
            let room = rooms().pop().unwrap_or_else(Candidates::new);
            let (sums, room) = Search::sums(odd, room);
            rooms().push(room);
            sums.into()
        });
        for (odd, sums) in unknown.into_iter().zip(found) {
            known.found.insert(odd.clone(), sums);
        }
        let own = products.iter().zip(&odd);
        let own = own.map(|(products, odd)| {
            Some(Self {
                products: products.clone(),
                sums: Arc::clone(known.found.get(odd.as_ref()?)?),
            })
        });
        own.collect()
    }

    /// Returns the constants, each with the number of lowest bits that its product drops.
    pub fn products(&self) -> &[(i64, u32)] {
        &self.products
    }

    pub(crate) fn sums(&self) -> &[(i64, Sum)] {
        &self.sums
    }
}

/// Returns the constants without their zeros, in ascending order. `None` if one is below 1 or has
/// more than 40 bits.
fn odd_factors(products: &[(i64, u32)]) -> Option<Vec<i64>> {
    let constants = 1..1 << CONSTANT_BITS;
    let odd = products.iter().map(|(factor, _)| {
        let is_constant = constants.contains(factor);
        is_constant.then(|| Term::from_number(*factor).factor)
    });
    let mut odd: Vec<i64> = odd.collect::<Option<_>>()?;
    odd.sort_unstable();
    odd.dedup();
    Some(odd)
}

struct Search {
    /// The largest value of a multiple or a term.
    most: i64,
    known: Vec<i64>,
    is_known: Set,
    candidates: Candidates,
    /// Number of known multiples from which the candidates are reached.
    reached: usize,
    /// The multiples that are still to do, in ascending order.
    wanted: Vec<Wanted>,
}

/// A multiple that is still to do.
struct Wanted {
    multiple: i64,
    /// The further multiples from which it would be one sum.
    from: Set,
    /// True if one of them is known.
    is_near: bool,
}

impl Wanted {
    fn new(multiple: i64) -> Self {
        Self {
            multiple,
            from: Set::new(),
            is_near: false,
        }
    }

    #[inline(always)]
    fn insert(&mut self, other: i64, known: &Set, candidates: &mut Candidates) {
        if self.is_near {
            return;
        }
        if known.contains(other) {
            self.is_near = true;
            self.leave(candidates);
        } else if self.from.insert(other) {
            candidates.helps(other);
        }
    }

    fn insert_all(&mut self, others: &Others, known: &Set, candidates: &mut Candidates) {
        let mut next = 0;
        while next < others.count {
            self.insert(others.numbers[next], known, candidates);
            next += 1;
        }
    }

    /// Withdraws the multiple's candidates: it is computed before they are compared again.
    fn leave(&mut self, candidates: &mut Candidates) {
        let from = std::mem::replace(&mut self.from, Set::new());
        let mut next = 0;
        while next < from.held {
            candidates.helps_no_more(from.all[next]);
            next += 1;
        }
    }
}

impl Search {
    /// Returns the sums that compute the odd numbers `odd`, which ascend. `room` is empty, and is
    /// returned empty.
    fn sums(odd: &[i64], room: Candidates) -> (Vec<(i64, Sum)>, Candidates) {
        let mut search = Self {
            most: odd.last().map_or(1, |most| most << 2),
            known: vec![1],
            is_known: Set::new(),
            reached: 0,
            candidates: room,
            wanted: Vec::new(),
        };
        search.is_known.insert(1);
        for &multiple in odd {
            search.want(multiple);
        }
        let sums = std::iter::from_fn(|| search.step()).collect();
        search.candidates.clear();
        (sums, search.candidates)
    }

    fn want(&mut self, multiple: i64) {
        let place = self
            .wanted
            .partition_point(|wanted| wanted.multiple < multiple);
        let there = |wanted: &Wanted| wanted.multiple == multiple;
        if self.is_known.contains(multiple) || self.wanted.get(place).is_some_and(there) {
            return;
        }
        let mut wanted = Wanted::new(multiple);
        for &known in &self.known {
            let others = Others::new(multiple, known, self.most);
            wanted.insert_all(&others, &self.is_known, &mut self.candidates);
        }
        // The sum of a multiple with itself, shifted.
        let mut shift = 1;
        while shift < CONSTANT_BITS && (1 << shift) - 1 <= multiple {
            for factor in [(1 << shift) - 1, (1 << shift) + 1] {
                if factor > 1 && multiple % factor == 0 {
                    let other = multiple / factor;
                    wanted.insert(other, &self.is_known, &mut self.candidates);
                }
            }
            shift += 1;
        }
        self.wanted.insert(place, wanted);
    }

    /// Marks the multiples that are one sum away from the known ones.
    fn reach(&mut self) {
        while self.reached < self.known.len() {
            self.reached += 1;
            self.reach_from(self.reached - 1);
        }
    }

    /// Marks the multiples that are one sum away from the one at `place` and those before it.
    fn reach_from(&mut self, place: usize) {
        let multiple = self.known[place];
        let (most, candidates) = (self.most, &mut self.candidates);
        let mut reached = |factor: i64| {
            if factor <= most {
                candidates.reach(factor);
            }
        };
        for &known in &self.known[..=place] {
            // Without a shift two odd numbers make an even one, and with a shift an odd one. `partners`
            // finds a sum by its multiple with zeros below, which is at most `most`.
            if multiple + known <= most {
                reached(odd_part(multiple + known));
            }
            if multiple != known {
                reached(odd_part(distance(multiple, known)));
            }
            for (fixed, shifted) in [(known, multiple), (multiple, known)] {
                let mut shift = 1;
                while shift < CONSTANT_BITS && shifted << shift <= most {
                    reached((shifted << shift) + fixed);
                    reached(distance(shifted << shift, fixed));
                    shift += 1;
                }
            }
        }
    }

    fn add(&mut self, multiple: i64) -> Option<(i64, Sum)> {
        let mut best: Option<(i32, Sum)> = None;
        for &known in &self.known {
            partners(multiple, known, self.most, &self.is_known, |partner| {
                let sum = partner.sum();
                let price = sum.price(multiple);
                if best.is_none_or(|(least, _)| price < least) {
                    best = Some((price, sum));
                }
            });
        }
        debug_assert!(best.is_some(), "{multiple} is no sum of {:?}", self.known);
        self.known.push(multiple);
        self.is_known.insert(multiple);
        let own = |wanted: &Wanted| wanted.multiple == multiple;
        if let Some(place) = self.wanted.iter().position(own) {
            self.wanted.remove(place).leave(&mut self.candidates);
        }
        for wanted in &mut self.wanted {
            if wanted.is_near {
                continue;
            }
            if wanted.from.contains(multiple) {
                wanted.is_near = true;
                wanted.leave(&mut self.candidates);
                continue;
            }
            let others = Others::new(wanted.multiple, multiple, self.most);
            wanted.insert_all(&others, &self.is_known, &mut self.candidates);
        }
        best.map(|(_, sum)| (multiple, sum))
    }

    fn step(&mut self) -> Option<(i64, Sum)> {
        loop {
            if let Some(there) = self.wanted.iter().find(|wanted| wanted.is_near) {
                return self.add(there.multiple);
            }
            if self.wanted.is_empty() {
                return None;
            }
            if let Some(between) = self.between() {
                return self.add(between);
            }
            // No multiple that is one sum away helps: a helpful multiple with the fewest digits is
            // wanted, too.
            let (mut fewest, mut simplest) = (u32::MAX, Vec::new());
            for wanted in &self.wanted {
                let from = &wanted.from;
                let mut next = 0;
                while next < from.held {
                    let other = from.all[next];
                    if other <= self.most && digits(other) <= fewest {
                        if digits(other) < fewest {
                            fewest = digits(other);
                            simplest.clear();
                        }
                        simplest.push(other);
                    }
                    next += 1;
                }
            }
            // Takes the least of the multiples that help the most wanted ones.
            simplest.sort_unstable();
            let (mut most, mut next) = (0, None);
            for run in simplest.chunk_by(i64::eq) {
                if run.len() > most {
                    (most, next) = (run.len(), Some(run[0]));
                }
            }
            let next = next?;
            self.want(next);
        }
    }

    /// Returns the multiple, one sum away, from which the most wanted ones are one sum.
    fn between(&mut self) -> Option<i64> {
        self.reach();
        let (most, best) = self.candidates.most_helpful();
        if most == self.wanted.len() || best.is_empty() {
            return best.first().copied();
        }
        // Estimates the remaining work of the others by the digits of the simplest multiple that
        // would help.
        let mut least: Option<(u32, i64)> = None;
        for &between in best.iter().take(COMPARED) {
            let mut left = 0;
            for wanted in &self.wanted {
                if least.is_some_and(|(fewest, _)| left >= fewest) {
                    break;
                }
                if !wanted.from.contains(between) {
                    let others = Others::new(wanted.multiple, between, self.most);
                    let (mut fewest, mut next) = (u32::MAX, 0);
                    while next < others.count {
                        let own = digits(others.numbers[next]);
                        if own < fewest {
                            fewest = own;
                        }
                        next += 1;
                    }
                    left += fewest;
                }
            }
            if least.is_none_or(|(fewest, _)| left < fewest) {
                least = Some((left, between));
            }
        }
        least.map(|(_, between)| between)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Checks each sum against the multiples made before it, and returns the number of sums.
    fn checked(wanted: &[i64]) -> usize {
        let products: Vec<(i64, u32)> = wanted.iter().map(|&factor| (factor, 0)).collect();
        let multiples = Multiples::new(&products).unwrap();
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
                .all(|&wanted| made.contains(&Term::from_number(wanted).factor))
        );
        multiples.sums().len()
    }

    #[test]
    fn constants_share_sums() {
        assert_eq!(checked(&[45]), 2);
        assert_eq!(checked(&[45, 361]), 3);
        assert_eq!(checked(&[3]), 1);
        assert_eq!(checked(&[]), 0);
        assert_eq!(checked(&[1, 4, 6, 3]), 1);
        // A sum of two intermediate multiples, both at most four times the greatest constant, can
        // exceed that bound.
        let wanted = [3_812_379, 1_824_933, 1_168_737, 37_648, 8_853_035];
        assert!(checked(&wanted) <= 20);
        for wrong in [0, -3, 1 << 40] {
            assert_eq!(Multiples::new(&[(3, 0), (wrong, 0)]), None);
        }
        // Signed digits would take 24 additions.
        assert!(checked(&[160_563, 155_959, 82_957, 40_649]) <= 12);
    }

    /// Without the search, a product takes the additions of its signed digits alone.
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

    #[test]
    fn many_constants_share_more_sums_than_few() {
        let constants: Vec<i64> = (1..257).map(|n| (n * n * 7919) % (1 << 20)).collect();
        let together = checked(&constants);
        let apart: usize = constants.chunks(48).map(checked).sum();
        assert!(4 * together < 3 * apart, "{together} and {apart}");
    }

    #[test]
    fn sums_are_the_same_wherever_they_are_searched_for() {
        // Enough constants for sets of thousands, in memory that other searches have left.
        let products: Vec<Box<[(i64, u32)]>> = (0..64)
            .map(|set| (1..13).map(|n| ((set * 131 + n) * 7_919 * n, 0)).collect())
            .collect();
        let all = Multiples::all(&products, &mut KnownSums::default(), Cores::All);
        for (products, found) in products.iter().zip(all) {
            assert_eq!(Multiples::new(products), found);
        }
    }

    proptest! {
        #[test]
        fn any_constants_are_reached(wanted in proptest::collection::vec(
            prop_oneof![1_i64..1 << 24, 1_i64..1 << CONSTANT_BITS], 1..8,
        )) {
            let by_digits: u32 = wanted.iter().map(|&n| digits(n) - 1).sum();
            let sums = checked(&wanted);
            prop_assert!(sums <= by_digits as usize, "{sums} {by_digits}");
        }
    }
}
