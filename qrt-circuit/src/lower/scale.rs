//! Products with a constant.
//!
//! The factor is written in signed digits, no two of them next to each other (the canonical form,
//! which has the fewest). The product is then a sum of shifted copies, added or subtracted from the
//! lowest up. Out of place, an addition has a cost only where the copies overlap. In place, it
//! takes twice the Toffolis.

use super::super::multiples::{Multiples, Term};
use super::super::{Op, RegisterId, Style, Word};
use super::multiply::Landing;
use super::{GateSink, Lowering, Qubit, Wire, extended, invert, qubits};

/// The addition of a shifted copy.
pub(super) struct Row {
    /// The lowest bit that the row changes.
    pub(super) place: usize,
    pub(super) subtract: bool,
    /// Number of bits of the partial sum before and after the row, and whether the top one is a
    /// sign.
    pub(super) before: (usize, bool),
    pub(super) after: (usize, bool),
}

/// The rows of a product with a constant.
pub(super) struct Rows {
    /// Number of zeros below the product's bits.
    pub(super) shift: u32,
    /// True if the lowest digit is -1.
    pub(super) negative: bool,
    /// The extent of the first partial sum, a or -a.
    pub(super) first: (usize, bool),
    pub(super) added: Vec<Row>,
}

impl Rows {
    pub(super) fn new(a: Word, factor: i64) -> Self {
        let zeros = factor.trailing_zeros() % 64;
        let range = Word { shift: 0, ..a }.range();
        let mut rest = i128::from(factor) >> zeros;
        let mut sum = 0_i128;
        let mut place = 0;
        let mut digits = Vec::new();
        while rest != 0 {
            if rest & 1 == 1 {
                let digit = if rest & 3 == 3 { -1 } else { 1 };
                sum += digit << place;
                digits.push((place, digit < 0, extent(range, sum)));
                rest -= digit;
            }
            rest >>= 1;
            place += 1;
        }
        let mut digits = digits.into_iter();
        let (_, negative, first) = digits.next().unwrap_or((0, false, (1, false)));
        let mut before = first;
        let row = |(place, subtract, after)| {
            let row = Row {
                place,
                subtract,
                before,
                after,
            };
            before = after;
            row
        };
        Self {
            shift: a.shift + zeros,
            negative,
            first,
            added: digits.map(row).collect(),
        }
    }

    /// Returns the number of bits of the product, and whether the top one is a sign.
    pub(super) fn extent(&self) -> (usize, bool) {
        self.added.last().map_or(self.first, |row| row.after)
    }

    /// Returns the number of bits of the sum of the rows that begin below `needed`, and whether the
    /// top one is a sign.
    fn reached(&self, needed: usize) -> (usize, bool) {
        let beyond = self.added.iter().find(|row| row.place >= needed);
        beyond.map_or(self.extent(), |row| row.before)
    }

    /// True if the lowest digit, -1, and the next, +1, become one subtraction.
    pub(super) fn fused(&self, needed: usize) -> bool {
        let adds = |row: &Row| !row.subtract && row.place < needed;
        self.negative && self.added.first().is_some_and(adds)
    }
}

/// Returns a lower bound on the Toffolis of an operation, without its gates. It is useful for
/// out-of-place products with a constant, and 0 for all other operations.
pub fn least_toffoli(op: &Op, width: impl Fn(RegisterId) -> u32) -> u64 {
    let &Op::Scale {
        a,
        factor,
        drop,
        style: Style::OutOfPlace,
        target,
        ..
    } = op
    else {
        return 0;
    };
    let rows = Rows::new(a, factor);
    let (bits, signed) = rows.extent();
    let target = vec![0; width(target) as usize];
    let needed = Landing::new(rows.shift, drop, &target).needed(bits, signed);
    let own = a.width as usize;
    // One for each carry out of a bit of the longer number, except for the first carry, which may
    // be free, and the last, where the two top bits may be one.
    let mut least = if rows.negative && !rows.fused(needed) {
        own.min(rows.first.0.min(needed)).saturating_sub(2)
    } else {
        0
    };
    for (index, row) in rows.added.iter().enumerate() {
        let end = row.after.0.min(needed);
        if index == 0 && rows.fused(needed) {
            // There may be nothing but constants between the two copies.
            least += (own.min(row.place) + own.min(end - row.place)).saturating_sub(3);
        } else if row.place < row.before.0.min(end) {
            let longer = own.max(row.before.0 - row.place);
            let bits = end - row.place;
            least += if a.signed || row.before.1 {
                longer.min(bits).saturating_sub(2)
            } else {
                longer.min(bits - 1)
            };
        }
    }
    least as u64
}

/// Returns the number of bits of the numbers in `range` times `factor`, and whether the top one is
/// a sign.
fn extent(range: [i64; 2], factor: i128) -> (usize, bool) {
    let ends = range.map(|end| i128::from(end) * factor);
    let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    let bits = |number: i128| 128 - number.leading_zeros() as usize;
    if low < 0 {
        (1 + bits(!low).max(bits(high)), true)
    } else {
        (bits(high).max(1), false)
    }
}

/// A multiple of a number that is in wires.
struct KnownMultiple {
    factor: i64,
    wires: Vec<Wire>,
    /// True if the top wire is a sign.
    signed: bool,
}

/// Returns the multiple `factor`, which is in `known`.
fn multiple_of(known: &[KnownMultiple], factor: i64) -> &KnownMultiple {
    let mut place = 0;
    while known[place].factor != factor {
        place += 1;
    }
    &known[place]
}

pub(super) fn top(wires: &[Wire], signed: bool) -> Wire {
    match wires.last() {
        Some(top) if signed => *top,
        _ => Wire::ZERO,
    }
}

impl Lowering {
    pub(super) fn scale(
        &mut self,
        a: Word,
        factor: i64,
        drop: u32,
        style: Style,
        target: &[Qubit],
    ) {
        let rows = Rows::new(a, factor);
        let landing = Landing::new(rows.shift, drop, target);
        let (bits, signed) = rows.extent();
        let needed = landing.needed(bits, signed);
        if needed == 0 {
            return;
        }
        let own = self.word(Word { shift: 0, ..a }, a.width as usize);
        let product = match style {
            Style::OutOfPlace => self.scale_rows(a, &own, &rows, needed, &landing),
            Style::InPlace => self.scale_rows_into(a, &own, &rows, needed, &landing),
        };
        if signed && needed == bits {
            self.extend_sign(&landing, product, needed);
        }
    }

    /// Computes all sums as garbage, and copies them to the targets.
    pub(super) fn multiples(&mut self, a: Word, products: &Multiples, targets: &[Vec<Qubit>]) {
        let number = Word { shift: 0, ..a };
        let range = number.range();
        let own = self.word(number, a.width as usize);
        let mut known = vec![KnownMultiple {
            factor: 1,
            wires: own,
            signed: a.signed,
        }];
        for &(multiple, sum) in products.sums() {
            let (bits, signed) = extent(range, i128::from(multiple) << sum.zeros);
            let [a, mut b] = [sum.a, sum.b].map(|term| {
                let own = multiple_of(&known, term.factor);
                let mut shifted = vec![Wire::ZERO; term.shift as usize];
                shifted.extend_from_slice(&own.wires);
                extended(&shifted, top(&own.wires, own.signed), bits)
            });
            // Below the overlap there is one term alone.
            let (alone, below) = match (sum.a.shift, sum.b.shift) {
                (shift, 0) if !sum.subtract => (shift as usize, &b),
                (_, shift) => (shift as usize, &a),
            };
            let mut whole = below[..alone.min(bits)].to_vec();
            invert(&mut b, sum.subtract);
            let t = self.allocate_garbage(bits - whole.len());
            let from = whole.len();
            self.add(&a[from..], &b[from..], Wire::constant(sum.subtract), &t);
            whole.extend(qubits(&t));
            known.push(KnownMultiple {
                factor: multiple,
                wires: whole.split_off(sum.zeros as usize),
                signed,
            });
        }
        for (&(factor, drop), target) in products.products().iter().zip(targets) {
            let multiple = Term::from_number(factor);
            let KnownMultiple {
                wires: own, signed, ..
            } = multiple_of(&known, multiple.factor);
            let zeros = (a.shift + multiple.shift) as usize;
            for (place, target) in target.iter().enumerate() {
                let wire = match (place + drop as usize).checked_sub(zeros) {
                    None => Wire::ZERO,
                    Some(place) => own.get(place).copied().unwrap_or(top(own, *signed)),
                };
                self.copy(wire, *target);
            }
        }
    }

    fn scale_rows(
        &mut self,
        a: Word,
        own: &[Wire],
        rows: &Rows,
        needed: usize,
        landing: &Landing,
    ) -> Wire {
        let a_top = top(own, a.signed);
        let mut sum = own.to_vec();
        let next = |index: usize| rows.added.get(index).map_or(needed, |row| row.place);
        if rows.negative && !rows.fused(needed) {
            let bits = rows.first.0.min(needed);
            let t = self.partial(landing, 0, bits, next(0));
            let mut number = extended(own, a_top, bits);
            invert(&mut number, true);
            self.add(&vec![Wire::ZERO; bits], &number, Wire::ONE, &t);
            sum = qubits(&t);
        }
        for (index, row) in rows.added.iter().enumerate() {
            if row.place >= needed {
                break;
            }
            let bits = row.after.0.min(needed);
            let fused = index == 0 && rows.fused(needed);
            let Operands {
                first: from,
                a: rest,
                b: mut number,
            } = operands(&sum, own, a_top, row, fused, bits);
            let subtract = fused || row.subtract;
            invert(&mut number, subtract);
            let t = self.partial(landing, from, bits - from, next(index + 1) - from);
            self.add(&rest, &number, Wire::constant(subtract), &t);
            sum = extended(&sum, top(&sum, row.before.1), from);
            sum.extend(qubits(&t));
        }
        let sum = extended(&sum, top(&sum, rows.reached(needed).1), needed);
        for (place, wire) in sum.iter().enumerate() {
            if let Some(t) = landing.at(place).filter(|t| *wire != Wire::qubit(*t)) {
                self.copy(*wire, t);
            }
        }
        sum[needed - 1]
    }

    fn scale_rows_into(
        &mut self,
        a: Word,
        own: &[Wire],
        rows: &Rows,
        needed: usize,
        landing: &Landing,
    ) -> Wire {
        let product = self.lands(landing, 0, needed);
        let a_top = top(own, a.signed);
        let bits = rows.first.0.min(needed);
        self.copies(&extended(own, a_top, bits), &product);
        if rows.negative {
            let window = &product[..bits];
            self.flips(Wire::ONE, window);
            self.add_into(&super::constant(1, bits), false, Wire::ONE, window);
        }
        for row in &rows.added {
            if row.place >= needed {
                break;
            }
            let bits = row.after.0.min(needed);
            let (before, signed) = row.before;
            for place in before..bits {
                if signed {
                    self.cx(product[before - 1], product[place]);
                }
            }
            let window = &product[row.place..bits];
            let number = extended(own, a_top, window.len());
            let sign = Wire::constant(row.subtract);
            self.flips(sign, window);
            self.add_into(&number, false, Wire::ONE, window);
            self.flips(sign, window);
        }
        let (bits, signed) = rows.reached(needed);
        for place in bits..needed {
            if signed {
                self.cx(product[bits - 1], product[place]);
            }
        }
        Wire::qubit(product[needed - 1])
    }
}

/// The operands of the addition or subtraction of a row.
pub(super) struct Operands {
    /// The lowest bit of the sum that the row changes.
    pub(super) first: usize,
    /// The bits of the sum so far, from there.
    pub(super) a: Vec<Wire>,
    /// The number that is added or subtracted.
    pub(super) b: Vec<Wire>,
}

/// Returns the operands of the addition or subtraction of a row.
pub(super) fn operands(
    sum: &[Wire],
    own: &[Wire],
    a_top: Wire,
    row: &Row,
    fused: bool,
    bits: usize,
) -> Operands {
    if fused {
        let mut shifted = vec![Wire::ZERO; row.place];
        shifted.extend_from_slice(own);
        let shifted = extended(&shifted, a_top, bits);
        return Operands {
            first: 0,
            a: shifted,
            b: extended(own, a_top, bits),
        };
    }
    let above = top(sum, row.before.1);
    let rest = extended(
        sum.get(row.place..).unwrap_or_default(),
        above,
        bits - row.place,
    );
    Operands {
        first: row.place,
        a: rest,
        b: extended(own, a_top, bits - row.place),
    }
}
