//! Quotients of shifted Ints.

use super::lane::{Kind, Lane, Row, Slots, Spares, floor_double};
use super::seen::Seen;

/// `floor(a 2^up / (b 2^up))`, with a shift of its own for each, and whether it fits, of numbers
/// that fit into 52 bits with the zeros below them. The step computes it entirely in `f64`, where
/// powers of two cost nothing. See [`super::lane::Float`] for why it is exact.
#[derive(Clone, Debug)]
pub(super) struct Quotient {
    pub(super) a: u32,
    pub(super) b: u32,
    /// Numbers of zeros below the dividend and below the divisor.
    pub(super) up: [u32; 2],
    /// Bits of the quotient.
    pub(super) width: u32,
    /// An Int or a Long.
    pub(super) to: (Kind, u32),
    /// A truth.
    pub(super) fits: u32,
}

/// 2^bits
fn power(bits: u32) -> f64 {
    (1_u64 << bits) as f64
}

impl Quotient {
    #[inline(always)]
    fn divide<T: Lane>(&self, slots: &Slots, quotient: &mut Row<T>, fits: &mut Row<u8>) {
        let [up_a, up_b] = self.up.map(power);
        let full = power(self.width);
        let operands = [self.a, self.b].map(|place| &slots.ints[place as usize].0);
        let operands = operands[0].iter().zip(operands[1]);
        let results = quotient.0.iter_mut().zip(&mut fits.0);
        for ((quotient, fits), (a, b)) in results.zip(operands) {
            let (a, b) = (f64::from(*a) * up_a, f64::from(*b) * up_b);
            let holds = a < b * full;
            let rest = if holds { a } else { 0.0 };
            let none = b == 0.0;
            let value = rest / if none { 1.0 } else { b };
            *quotient = T::cut(floor_double(if none { full - 1.0 } else { value }));
            *fits = u8::from(holds);
        }
    }

    /// Computes into spare rows and swaps them into their slots.
    #[inline(always)]
    pub(super) fn compute(&self, slots: &mut Slots, spares: &mut Spares) {
        let [fits, _] = &mut spares.truth;
        let t = self.to.1 as usize;
        if self.to.0 == Kind::Int {
            self.divide(slots, &mut spares.int, fits);
            std::mem::swap(&mut spares.int, &mut slots.ints[t]);
        } else {
            self.divide(slots, &mut spares.long, fits);
            std::mem::swap(&mut spares.long, &mut slots.longs[t]);
        }
        std::mem::swap(fits, &mut slots.truths[self.fits as usize]);
    }

    /// Calls `see` on its operands and its targets.
    pub(super) fn visit(&mut self, see: &mut impl FnMut(Seen<'_>)) {
        see(Seen::read(Kind::Int, &mut self.a));
        see(Seen::read(Kind::Int, &mut self.b));
        see(Seen::computed(self.to.0, &mut self.to.1));
        see(Seen::computed(Kind::Truth, &mut self.fits));
    }
}
