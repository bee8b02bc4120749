//! Products.
//!
//! There are two methods; the cheaper one is used.
//!
//! *Plain rows*: row i is `a_i b`, n ANDs, added at bit i.
//!
//! *Signed digits*: digits d = 2 a_i - 1 of either sign take the place of the bits, and the top one
//! is negated since it is the sign's. Then `2a + 1 = sum d_i 2^i`, so
//! `a b = -(not a_0) b + sum_{i > 0} d_i 2^(i - 1) b`. The first term takes n ANDs and a negation.
//! Each other term is an addition or a subtraction, as the row's bit decides: CNOTs from that bit
//! complement b, and that bit is also the carry in. No row needs ANDs of its own, and the product
//! takes about one Toffoli for each pair of bits. (This is Booth's idea of signed digits, without
//! the digit 0.)
//!
//! Out of place, each row's partial sum is n + 2 new bits, the lowest of which is the product's. In
//! place, rows are added within the product's bits.

use super::super::{Style, Word};
use super::{GateSink, Lowering, Qubit, Wire, extended, invert, qubits};

/// The places of a result's bits: those from `drop` on are in the target, those below in the
/// garbage.
pub(super) struct Landing<'a> {
    pub(super) drop: usize,
    pub(super) target: &'a [Qubit],
}

impl<'a> Landing<'a> {
    /// Creates the landing of a result with `shift` zeros below, of which `drop` bits are dropped.
    pub(super) fn new(shift: u32, drop: u32, target: &'a [Qubit]) -> Self {
        let zeros = (shift.saturating_sub(drop) as usize).min(target.len());
        Self {
            drop: drop.saturating_sub(shift) as usize,
            target: &target[zeros..],
        }
    }

    /// Number of bits that are computed of a result of `bits` bits: those of the target, and those
    /// below.
    pub(super) fn needed(&self, bits: usize, signed: bool) -> usize {
        if self.target.is_empty() || (self.drop >= bits && !signed) {
            0
        } else {
            bits.min(self.drop + self.target.len())
        }
    }

    /// Returns the target's bit for bit `place` of the result, if the target has it.
    pub(super) fn at(&self, place: usize) -> Option<Qubit> {
        let place = place.checked_sub(self.drop)?;
        self.target.get(place).copied()
    }
}

/// The shape of a product, which determines its cost.
pub(super) struct Product {
    /// Number of bits of a. The next field is true if the top one is a sign.
    pub(super) rows: usize,
    pub(super) a_signed: bool,
    /// Number of bits of b. The next field is true if the top one is a sign.
    pub(super) row: usize,
    pub(super) b_signed: bool,
    /// Number of bits of the product.
    bits: usize,
    /// Number of bits that are computed.
    pub(super) needed: usize,
}

impl Product {
    pub(super) fn new(a: Word, b: Word, landing: &Landing) -> Self {
        let (rows, row) = (a.width as usize, b.width as usize);
        let bits = if rows == 1 && !a.signed {
            row
        } else {
            rows + row
        };
        Self {
            rows,
            a_signed: a.signed,
            row,
            b_signed: b.signed,
            bits,
            needed: landing.needed(bits, a.signed || b.signed),
        }
    }

    /// Number of digits of a. An unsigned number has one more, for its sign.
    pub(super) fn digits(&self) -> usize {
        self.rows + usize::from(!self.a_signed)
    }

    /// Number of Toffolis in plain rows.
    fn plain(&self, style: Style) -> u64 {
        let (row, needed) = (self.row, self.needed);
        let negated = if self.rows == 1 && self.a_signed {
            negation((row + 1).min(needed))
        } else {
            0
        };
        let rows = (1..self.rows.min(needed)).map(|place| {
            let bits = (row + 1).min(needed - place);
            let carries = bits - 1;
            match style {
                Style::OutOfPlace if row == 1 && place == 1 && !self.b_signed => 1,
                Style::OutOfPlace => row.min(bits) + carries,
                Style::InPlace => 2 * carries + bits,
            }
        });
        let negated = carried(negated, style);
        (row.min(needed) + negated + rows.sum::<usize>()) as u64
    }

    /// Number of Toffolis in rows of signed digits. A single digit has no rows and is never chosen.
    fn signed(&self, style: Style) -> u64 {
        let (row, needed) = (self.row, self.needed);
        if self.digits() == 1 {
            return u64::MAX;
        }
        let rows = 1..self.digits().min(needed + 1);
        let carries = rows.map(|place| (row + 2).min(needed + 1 - place) - 1);
        let carries = negation((row + 1).min(needed)) + carries.sum::<usize>();
        (row.min(needed) + carried(carries, style)) as u64
    }
}

/// Number of Toffolis of a sum of `bits` bits whose first carry follows from the wires, as in a
/// negation.
fn negation(bits: usize) -> usize {
    bits.saturating_sub(2)
}

/// Number of Toffolis of carries. Out of place the carries stay; in place the sum uncomputes them.
fn carried(carries: usize, style: Style) -> usize {
    match style {
        Style::OutOfPlace => carries,
        Style::InPlace => 2 * carries,
    }
}

impl Lowering {
    /// Returns a qubit for bit `place` of a result: the target's, or a garbage bit.
    pub(super) fn land(&mut self, landing: &Landing, place: usize) -> Qubit {
        landing.at(place).unwrap_or_else(|| self.garbage_bit())
    }

    pub(super) fn lands(&mut self, landing: &Landing, from: usize, bits: usize) -> Vec<Qubit> {
        let places = from..from + bits;
        places.map(|place| self.land(landing, place)).collect()
    }

    /// Allocates the bits of a partial sum at `from`, the lowest `last` of which are the result's.
    pub(super) fn partial(
        &mut self,
        landing: &Landing,
        from: usize,
        bits: usize,
        last: usize,
    ) -> Vec<Qubit> {
        let last = last.min(bits);
        let mut partial = self.lands(landing, from, last);
        partial.extend(self.allocate_garbage(bits - last));
        partial
    }

    /// Fills the target above the result's own bits with copies of the sign.
    pub(super) fn extend_sign(&mut self, landing: &Landing, sign: Wire, bits: usize) {
        for place in bits..landing.drop + landing.target.len() {
            if let Some(t) = landing.at(place) {
                self.copy(sign, t);
            }
        }
    }

    pub(super) fn multiply(&mut self, a: Word, b: Word, drop: u32, style: Style, target: &[Qubit]) {
        let landing = Landing::new(a.shift + b.shift, drop, target);
        let product = Product::new(a, b, &landing);
        if product.needed == 0 {
            return;
        }
        let plain = product.plain(style) <= product.signed(style);
        let mut a = self.word(Word { shift: 0, ..a }, product.rows);
        let b = self.word(Word { shift: 0, ..b }, product.row);
        let copies = self.detach(&mut a, &b);
        let result = match (style, plain) {
            (Style::OutOfPlace, true) => self.plain_rows(&product, &a, &b, &landing),
            (Style::OutOfPlace, false) => self.digit_rows(&product, &a, &b, &landing),
            (Style::InPlace, true) => self.plain_rows_into(&product, &a, &b, &landing),
            (Style::InPlace, false) => self.digit_rows_into(&product, &a, &b, &landing),
        };
        if (product.a_signed || product.b_signed) && product.needed == product.bits {
            self.extend_sign(&landing, result, product.needed);
        }
        self.attach(copies);
    }

    /// `t = bit b`
    fn row(&mut self, bit: Wire, b: &[Wire], target: &[Qubit]) {
        for (b, t) in b.iter().zip(target) {
            self.and(bit, *b, *t);
        }
    }

    /// Complements b's qubits where `sign` is 1, and returns the resulting wires. A second call
    /// restores b.
    pub(super) fn complement(&mut self, sign: Wire, b: &[Wire]) -> Vec<Wire> {
        if let Some(sign) = sign.source() {
            for qubit in b.iter().filter_map(|wire| wire.source()) {
                self.cx(sign, qubit);
            }
        }
        let complement = |wire: &Wire| match wire.source() {
            Some(_) => wire.xor(sign.inverted()),
            None => sign.xor(wire.inverted()),
        };
        b.iter().map(complement).collect()
    }

    /// Computes the negative of `y`, extended by `above`, in the bits of `target`.
    fn negative(&mut self, y: &[Wire], above: Wire, target: &[Qubit]) {
        let mut y = extended(y, above, target.len());
        invert(&mut y, true);
        let zeros = vec![Wire::ZERO; target.len()];
        self.add(&zeros, &y, Wire::ONE, target);
    }

    fn plain_rows(&mut self, p: &Product, a: &[Wire], b: &[Wire], landing: &Landing) -> Wire {
        let bits = p.row.min(p.needed);
        let alone = p.rows == 1;
        let last = if !alone {
            1
        } else if p.a_signed {
            0
        } else {
            bits
        };
        let first = self.partial(landing, 0, bits, last);
        self.row(a[0], b, &first);
        let above = |t: &[Qubit], signed: bool| match t.last() {
            Some(top) if signed => Wire::qubit(*top),
            _ => Wire::ZERO,
        };
        if alone {
            let above = above(&first, p.b_signed);
            if !p.a_signed {
                return above;
            }
            let target = self.lands(landing, 0, (p.row + 1).min(p.needed));
            self.negative(&qubits(&first), above, &target);
            return Wire::qubit(target[target.len() - 1]);
        }
        let mut sum = first;
        let bits = a.iter().enumerate().take(p.rows.min(p.needed));
        for (place, bit) in bits.skip(1) {
            let last = place + 1 == p.rows;
            let turned = last && p.a_signed;
            let bits = (p.row + 1).min(p.needed - place);
            let row = self.allocate_garbage(p.row.min(bits));
            self.row(*bit, b, &row);
            let row_top = above(&row, p.b_signed);
            let mut row = extended(&qubits(&row), row_top, bits);
            invert(&mut row, turned);
            let rest = extended(&qubits(&sum[1..]), above(&sum, p.b_signed), bits);
            let t = self.partial(landing, place, bits, if last { bits } else { 1 });
            self.add(&rest, &row, Wire::constant(turned), &t);
            sum = t;
        }
        Wire::qubit(sum[sum.len() - 1])
    }

    fn digit_rows(&mut self, p: &Product, a: &[Wire], b: &[Wire], landing: &Landing) -> Wire {
        let y = self.allocate_garbage(p.row.min(p.needed));
        self.row(a[0].xor(true), b, &y);
        let y = qubits(&y);
        let above = if p.b_signed {
            y[y.len() - 1]
        } else {
            Wire::ZERO
        };
        let mut sum = self.allocate_garbage((p.row + 1).min(p.needed));
        self.negative(&y, above, &sum);
        for place in 1..p.digits().min(p.needed + 1) {
            let (last, sign) = digit(a, p, place);
            let bits = (p.row + 2).min(p.needed + 1 - place);
            let row = self.complement(sign, b);
            let above = if p.b_signed { row[row.len() - 1] } else { sign };
            let row = extended(&row, above, bits);
            let rest = extended(&qubits(&sum), Wire::qubit(sum[sum.len() - 1]), bits);
            let t = self.partial(landing, place - 1, bits, if last { bits } else { 1 });
            self.add(&rest, &row, sign, &t);
            self.complement(sign, b);
            if t.len() == 1 {
                return Wire::qubit(t[0]);
            }
            sum = t[1..].to_vec();
        }
        Wire::qubit(sum[sum.len() - 1])
    }

    fn plain_rows_into(&mut self, p: &Product, a: &[Wire], b: &[Wire], landing: &Landing) -> Wire {
        let product = self.lands(landing, 0, p.needed);
        self.row(a[0], b, &product[..p.row.min(p.needed)]);
        if p.rows == 1 && p.a_signed {
            self.negate_in_place(&product, p.row, p.b_signed);
        }
        if p.rows > 1 && p.b_signed && p.row < p.needed {
            self.cx(product[p.row - 1], product[p.row]);
        }
        let rows = a.iter().enumerate().take(p.rows.min(p.needed));
        for (place, bit) in rows.skip(1) {
            let bits = (p.row + 1).min(p.needed - place);
            let window = &product[place..place + bits];
            if p.b_signed && bits > p.row {
                self.cx(window[p.row - 1], window[p.row]);
            }
            let sign = Wire::constant(p.a_signed && place + 1 == p.rows);
            let above = if p.b_signed { b[p.row - 1] } else { Wire::ZERO };
            self.flips(sign, window);
            self.add_into(&extended(b, above, bits), false, *bit, window);
            self.flips(sign, window);
        }
        Wire::qubit(product[p.needed - 1])
    }

    fn digit_rows_into(&mut self, p: &Product, a: &[Wire], b: &[Wire], landing: &Landing) -> Wire {
        let product = self.lands(landing, 0, p.needed);
        self.row(a[0].xor(true), b, &product[..p.row.min(p.needed)]);
        self.negate_in_place(&product, p.row, p.b_signed);
        for place in 1..p.digits().min(p.needed + 1) {
            let (_, sign) = digit(a, p, place);
            let bits = (p.row + 2).min(p.needed + 1 - place);
            let window = &product[place - 1..place - 1 + bits];
            if bits > p.row + 1 {
                self.cx(window[p.row], window[p.row + 1]);
            }
            let above = if p.b_signed { b[p.row - 1] } else { Wire::ZERO };
            self.flips(sign, window);
            self.add_into(&extended(b, above, bits), false, Wire::ONE, window);
            self.flips(sign, window);
        }
        Wire::qubit(product[p.needed - 1])
    }

    /// Negates the number in the lowest `bits` bits in place. The result has one bit more.
    pub(super) fn negate_in_place(&mut self, number: &[Qubit], bits: usize, signed: bool) {
        let window = &number[..(bits + 1).min(number.len())];
        if signed && window.len() > bits {
            self.cx(window[bits - 1], window[bits]);
        }
        self.flips(Wire::ONE, window);
        let one = super::constant(1, window.len());
        self.add_into(&one, false, Wire::ONE, window);
    }
}

/// Returns whether the digit is the last one, and the wire on which its row is subtracted.
fn digit(a: &[Wire], p: &Product, place: usize) -> (bool, Wire) {
    let top = place + 1 == p.digits();
    let bit = a.get(place).copied().unwrap_or(Wire::ZERO);
    (top || place == p.needed, bit.xor(!top))
}
