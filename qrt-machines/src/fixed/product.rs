//! Products that need more bits than their factors' lanes have.

use super::arith::Wrap;
use super::lane::{Kind, Lane, Row, Slots, Spares};
use super::seen::Seen;
use pulp::bytemuck;

/// A second factor.
#[derive(Clone, Copy, Debug)]
pub(super) enum Factor {
    Row(u32),
    Splat(i64),
}

/// Method by which wide products are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum How {
    /// Factors of 16 bits, in 32.
    Short,
    /// Factors of 32 bits, in 64.
    Int,
    /// Any factor, and one in -2^31 .. 2^31: multiplies the halves of the first by the second.
    Half,
    /// Factors in -2^62 .. 2^62: multiplies halves by halves.
    Halves,
    /// Any factors, in 128 bits.
    Whole,
}

impl How {
    pub(super) fn factors(self) -> Kind {
        match self {
            Self::Short => Kind::Short,
            Self::Int => Kind::Int,
            Self::Half | Self::Halves | Self::Whole => Kind::Long,
        }
    }

    /// The narrowest and the widest kind in which a product can be left.
    pub(super) fn results(self) -> [Kind; 2] {
        match self {
            Self::Short => [Kind::Short, Kind::Int],
            Self::Int => [Kind::Int, Kind::Long],
            Self::Half | Self::Halves | Self::Whole => [Kind::Long, Kind::Long],
        }
    }

    /// Method for Long factors within these bounds.
    pub(super) fn long(a: [i64; 2], b: [i64; 2]) -> Self {
        let within = |[low, high]: [i64; 2], bits: u32| low >= -1 << bits && high < 1 << bits;
        if within(b, 31) {
            Self::Half
        } else if within(a, 62) && within(b, 62) {
            Self::Halves
        } else {
            Self::Whole
        }
    }
}

/// `t = a b >> drop`
#[derive(Clone, Debug)]
pub(super) struct Product {
    pub(super) how: How,
    pub(super) a: u32,
    pub(super) b: Factor,
    pub(super) drop: u32,
    pub(super) wrap: Wrap<i64>,
    /// The register's width and whether its top bit is a sign, if the product has the register's
    /// kind.
    pub(super) shape: Option<(u32, bool)>,
    pub(super) to: (Kind, u32),
}

/// The lowest 32 bits.
const LOW: i64 = 0xffff_ffff;

/// Returns the lanes two by two, the even ones in the lower halves.
#[inline(always)]
fn pairs(row: &Row<i32>) -> &[i64] {
    bytemuck::cast_slice(&row.0)
}

/// Computes the bits of `a b` above `drop` and below `drop + width`, of Ints. It takes two lanes at
/// a time, because there are instructions that multiply every other lane, and none that store half
/// of each result. The two shifts of `cut` drop the bits below, and also cut and extend the rest.
#[inline(always)]
fn ints(t: &mut Row<i32>, factors: impl Iterator<Item = [i64; 2]>, cut: impl Fn(i64) -> i64) {
    let t: &mut [i64] = bytemuck::cast_slice_mut(&mut t.0);
    for (t, [a, b]) in t.iter_mut().zip(factors) {
        let low = cut(i64::from(a as i32) * i64::from(b as i32));
        let high = cut((a >> 32) * (b >> 32));
        *t = (low & LOW) | high << 32;
    }
}

/// `floor(a b / 2^drop)` mod 2^64, for any `a`, b in -2^31 .. 2^31, and `drop` below 96.
///
/// Both products fit: that of the upper half is at most 2^62, that of the lower half at most 2^63 -
/// 2^31.
#[inline(always)]
fn half(a: i64, b: i64, drop: u32) -> i64 {
    let (high, low) = ((a >> 32).wrapping_mul(b), (a & LOW).wrapping_mul(b));
    if drop >= 32 {
        high.wrapping_add(low >> 32) >> (drop - 32)
    } else {
        (high << (32 - drop)).wrapping_add(low >> drop)
    }
}

/// As [`half`], for factors in -2^62 .. 2^62, so that the middle sum fits, and `drop` below 128.
#[inline(always)]
fn halves(a: i64, b: i64, drop: u32) -> i64 {
    let ((ah, al), (bh, bl)) = ((a >> 32, a & LOW), (b >> 32, b & LOW));
    let low = al.wrapping_mul(bl);
    let carried = (low.cast_unsigned() >> 32).cast_signed();
    let middle = ah.wrapping_mul(bl).wrapping_add(al.wrapping_mul(bh));
    let middle = middle.wrapping_add(carried);
    // a b = top 2^64 + (middle's lowest half) 2^32 + low's lowest half
    let top = ah.wrapping_mul(bh).wrapping_add(middle >> 32);
    if drop >= 64 {
        top >> (drop - 64)
    } else if drop >= 32 {
        (top << (64 - drop)).wrapping_add((middle & LOW) >> (drop - 32))
    } else {
        let upper = (top << 32).wrapping_add(middle & LOW);
        (upper << (32 - drop)).wrapping_add((low & LOW) >> drop)
    }
}

#[inline(always)]
fn each<A: Lane + Into<i64>, T: Lane>(
    slots: &Slots,
    t: &mut Row<T>,
    (a, b): (u32, Factor),
    wrap: Wrap<i64>,
    f: impl Fn(A, A) -> i64,
) {
    let wrap = Wrap {
        mask: T::cut(wrap.mask),
        half: T::cut(wrap.half),
    };
    let all = A::rows(slots);
    let lanes = t.0.iter_mut().zip(&all[a as usize].0);
    match b {
        Factor::Row(b) => {
            let lanes = lanes.zip(&all[b as usize].0);
            lanes.for_each(|((t, a), b)| *t = wrap.apply(T::cut(f(*a, *b))));
        }
        Factor::Splat(b) => {
            let b = A::cut(b);
            lanes.for_each(|(t, a)| *t = wrap.apply(T::cut(f(*a, b))));
        }
    }
}

impl Product {
    /// Computes into a spare row and swaps it into its slot.
    #[inline(always)]
    pub(super) fn compute(&self, slots: &mut Slots, spares: &mut Spares) {
        let Self {
            how,
            a,
            b,
            drop,
            wrap,
            shape,
            to: (to, t),
        } = *self;
        let (factors, t) = ((a, b), t as usize);
        let short = |a: i16, b: i16| i64::from((i32::from(a) * i32::from(b)) >> drop);
        let int = |a: i32, b: i32| (i64::from(a) * i64::from(b)) >> drop;
        match (how, to) {
            (How::Short, Kind::Short) => {
                each(slots, &mut spares.short, factors, wrap, short);
                std::mem::swap(&mut spares.short, &mut slots.shorts[t]);
            }
            (How::Short, _) => {
                each(slots, &mut spares.int, factors, wrap, short);
                std::mem::swap(&mut spares.int, &mut slots.ints[t]);
            }
            (How::Int, Kind::Int)
                if let Some((width, signed)) = shape
                    && drop + width <= 64 =>
            {
                let (left, right) = (64 - drop - width, 64 - width);
                let row = &mut spares.int;
                let a = pairs(&slots.ints[a as usize]).iter();
                let signed_cut = |product: i64| product << left >> right;
                let cut = |product: i64| ((product << left).cast_unsigned() >> right).cast_signed();
                match (b, signed) {
                    (Factor::Row(b), true) => {
                        let b = pairs(&slots.ints[b as usize]);
                        ints(row, a.zip(b).map(|(a, b)| [*a, *b]), signed_cut);
                    }
                    (Factor::Row(b), false) => {
                        let b = pairs(&slots.ints[b as usize]);
                        ints(row, a.zip(b).map(|(a, b)| [*a, *b]), cut);
                    }
                    (Factor::Splat(b), true) => {
                        let b = b << 32 | b & LOW;
                        ints(row, a.map(|a| [*a, b]), signed_cut);
                    }
                    (Factor::Splat(b), false) => {
                        let b = b << 32 | b & LOW;
                        ints(row, a.map(|a| [*a, b]), cut);
                    }
                }
                std::mem::swap(&mut spares.int, &mut slots.ints[t]);
            }
            (How::Int, Kind::Int) => {
                each(slots, &mut spares.int, factors, wrap, int);
                std::mem::swap(&mut spares.int, &mut slots.ints[t]);
            }
            (How::Int, _) => {
                each(slots, &mut spares.long, factors, wrap, int);
                std::mem::swap(&mut spares.long, &mut slots.longs[t]);
            }
            _ => {
                let row = &mut spares.long;
                // One loop for each direction of the shifts.
                match (how, drop) {
                    (How::Half, 0..32) => each(slots, row, factors, wrap, |a, b| half(a, b, drop)),
                    (How::Half, _) => {
                        let drop = drop.clamp(32, 95);
                        each(slots, row, factors, wrap, |a, b| half(a, b, drop));
                    }
                    (How::Halves, 0..32) => {
                        each(slots, row, factors, wrap, |a, b| halves(a, b, drop));
                    }
                    (How::Halves, 32..64) => {
                        let drop = drop.clamp(32, 63);
                        each(slots, row, factors, wrap, |a, b| halves(a, b, drop));
                    }
                    (How::Halves, _) => {
                        let drop = drop.clamp(64, 127);
                        each(slots, row, factors, wrap, |a, b| halves(a, b, drop));
                    }
                    _ => each(slots, row, factors, wrap, |a: i64, b: i64| {
                        ((i128::from(a) * i128::from(b)) >> drop) as i64
                    }),
                }
                std::mem::swap(&mut spares.long, &mut slots.longs[t]);
            }
        }
    }

    /// Calls `see` on its factors and its target.
    pub(super) fn visit(&mut self, see: &mut impl FnMut(Seen<'_>)) {
        let kind = self.how.factors();
        see(Seen::read(kind, &mut self.a));
        if let Factor::Row(b) = &mut self.b {
            see(Seen::read(kind, b));
        }
        see(Seen::computed(self.to.0, &mut self.to.1));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The ends of `-2^bits .. 2^bits`, their neighbours, and numbers at the seam of the halves.
    fn extremes(bits: u32) -> Vec<i64> {
        let end = 1_i128 << bits;
        let seam = [LOW - 1, LOW, LOW + 1, 1 << 31, (1 << 31) - 1].map(i128::from);
        let near = [-end, 1 - end, 2 - end, -1, 0, 1, end - 2, end - 1];
        let all = near.into_iter().chain(seam).chain(seam.map(|n| -n));
        let within = all.filter(|n| (-end..end).contains(n));
        within.map(|n| i64::try_from(n).unwrap()).collect()
    }

    fn exact(a: i64, b: i64, drop: u32) -> i64 {
        ((i128::from(a) * i128::from(b)) >> drop) as i64
    }

    #[test]
    fn half_products_are_exact_at_the_ends_of_their_factors() {
        for a in extremes(63) {
            for b in extremes(31) {
                assert_eq!(How::long([a, a], [b, b]), How::Half);
                for drop in 0..96 {
                    assert_eq!(half(a, b, drop), exact(a, b, drop), "{a} {b} >> {drop}");
                }
            }
        }
    }

    #[test]
    fn products_of_halves_are_exact_at_the_ends_of_their_factors() {
        for a in extremes(62) {
            for b in extremes(62) {
                for drop in 0..128 {
                    assert_eq!(halves(a, b, drop), exact(a, b, drop), "{a} {b} >> {drop}");
                }
            }
        }
        let wide = |n: i64| [n, n];
        let (inside, outside) = ((1 << 62) - 1, 1 << 62);
        assert_eq!(How::long(wide(inside), wide(-1 << 62)), How::Halves);
        assert_eq!(How::long(wide(outside), wide(inside)), How::Whole);
        assert_eq!(How::long(wide(inside), wide(outside)), How::Whole);
    }
}
