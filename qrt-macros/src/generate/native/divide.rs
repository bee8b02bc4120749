//! Quotients.

use super::Coder;
use super::number::Number;
use super::range::Range;

impl Coder<'_> {
    /// Returns `floor(a / b)`, and whether `a < b 2^width`. The quotient is 0 where that does not
    /// hold, but `2^width - 1` where b is 0. `a` and `b` are numbers that are not negative, each
    /// with its number of zeros below it.
    pub(super) fn divided(
        &mut self,
        a: (Number, u32),
        b: (Number, u32),
        width: u32,
    ) -> (Number, String) {
        let range = Range::of_width(width, false);
        let all = Self::constant(range.high);
        let small = Range::of_width(24, false);
        let plain = a.0.range.within(small) && b.0.range.within(small);
        let up = a.1.saturating_sub(b.1);
        if plain && a.1 >= b.1 && up < 100 && width <= 24 {
            let (value, fits) = self.single(&a.0, &b.0, up, width);
            let none = self.less(&b.0, &Self::constant(1));
            return (self.choose(&all, &none, &value), fits);
        }
        let (a, b) = (self.left(a.0, a.1), self.left(b.0, b.1));
        let high = self.right(a.clone(), width);
        let fits = self.less(&high, &b);
        let none = self.less(&b, &Self::constant(1));
        let rest = self.choose(&a, &fits, &Self::constant(0));
        let divisor = self.choose(&Self::constant(1), &none, &b);
        let (rest, divisor) = (self.longs(&rest), self.longs(&divisor));
        let doubles = Range::of_width(52, false);
        let how = if a.range.within(doubles) && b.range.within(doubles) {
            "quotient_double"
        } else {
            "quotient_of_longs"
        };
        let value = self.of_longs(range, format!("v.{how}({rest}, {divisor})"));
        (self.choose(&all, &none, &value), fits)
    }

    /// Divides `a 2^up` by b, where a, b and the quotient fit 24 bits and b is not 0.
    ///
    /// A quotient below 2^24, rounded to 24 bits, is neither below the floor of the exact quotient
    /// nor beyond the next integer, since both are numbers of 24 bits. So its own floor q is the
    /// right one or one more. The sign of `a 2^up - q b` decides which. Lanes hold its lowest 32
    /// bits, which are enough, since it is between -b and b.
    fn single(&mut self, a: &Number, b: &Number, up: u32, width: u32) -> (Number, String) {
        // a 2^up < b 2^width, with the smaller power of two cancelled.
        let fits = if up <= width {
            let high = self.right(a.clone(), width - up);
            self.less(&high, b)
        } else {
            // Beyond 2^24, every power distinguishes only whether b is 0.
            let rest = (up - width).min(30);
            let round = Self::constant((1 << rest) - 1);
            let raised = self.added(b, &round, false, 64);
            let raised = self.right(raised, rest);
            self.less(a, &raised)
        };
        let rest = self.choose(a, &fits, &Self::constant(0));
        let (rest, b) = (&rest.text, &b.text);
        let near = self.bind(&format!("v.quotient_single({rest}, {b}, {up})"));
        let product = self.bind(&format!("{near}.mul({b})"));
        let beyond = if up < 32 {
            let remainder = self.bind(&format!("{rest}.left({up}).sub({product})"));
            self.bind(&format!("{remainder}.less(v.ints(0))"))
        } else {
            self.bind(&format!("v.ints(0).less({product})"))
        };
        let value = format!("{near}.sub(v.ints(1)).choose({beyond}, {near})");
        (self.of_ints(Range::of_width(width, false), &value), fits)
    }
}
