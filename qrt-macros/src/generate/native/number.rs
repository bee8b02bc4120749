//! Numbers, in the narrowest lanes that their ranges allow.

use super::Coder;
use super::range::Range;

/// A number in a variable: in lanes of 32 bits if its range fits them, else of 64.
#[derive(Clone, Debug)]
pub(super) struct Number {
    pub(super) text: String,
    pub(super) range: Range,
}

impl Coder<'_> {
    /// Returns the same number in all lanes.
    pub(super) fn constant(value: i64) -> Number {
        let range = Range::new(value, value);
        let lanes = if range.narrow() { "ints" } else { "longs" };
        Number {
            text: format!("v.{lanes}({value})"),
            range,
        }
    }

    /// Binds numbers of 32 bits a lane, which their range fits.
    pub(super) fn of_ints(&mut self, range: Range, value: &str) -> Number {
        let text = self.bind(value);
        Number { text, range }
    }

    /// Binds numbers of 64 bits a lane, narrowed to 32 bits if their range fits.
    pub(super) fn of_longs(&mut self, range: Range, value: String) -> Number {
        let value = if range.narrow() {
            format!("v.narrow({value})")
        } else {
            value
        };
        let text = self.bind(&value);
        Number { text, range }
    }

    /// Returns the variable of a number's lowest 32 bits, in lanes of 32 bits.
    pub(super) fn ints(&mut self, a: &Number) -> String {
        if a.range.narrow() {
            a.text.clone()
        } else {
            self.bind(&format!("v.narrow({})", a.text))
        }
    }

    pub(super) fn longs(&mut self, a: &Number) -> String {
        if a.range.narrow() {
            self.bind(&format!("v.widen({})", a.text))
        } else {
            a.text.clone()
        }
    }

    /// Returns the number times `2^by`.
    pub(super) fn left(&mut self, a: Number, by: u32) -> Number {
        if by == 0 {
            return a;
        }
        let range = a.range.left(by);
        if range.narrow() {
            return self.of_ints(range, &format!("{}.left({by})", a.text));
        }
        let longs = self.longs(&a);
        self.of_longs(range, format!("{longs}.left({by})"))
    }

    /// `floor(a / 2^by)`
    pub(super) fn right(&mut self, a: Number, by: u32) -> Number {
        if by == 0 {
            return a;
        }
        let range = a.range.right(by);
        if a.range.narrow() {
            let by = by.min(31);
            return self.of_ints(range, &format!("{}.right({by})", a.text));
        }
        let by = by.min(63);
        self.of_longs(range, format!("{}.right({by})", a.text))
    }

    /// Returns the lowest `width` bits, extended by zeros or copies of the top one.
    pub(super) fn cut(&mut self, a: Number, width: u32, signed: bool) -> Number {
        let range = Range::of_width(width, signed);
        if a.range.within(range) {
            return a;
        }
        let (lanes, text) = if range.narrow() {
            (32, self.ints(&a))
        } else {
            (64, self.longs(&a))
        };
        let above = lanes - width;
        let value = match (above, signed) {
            (0, _) => text,
            (_, true) => format!("{text}.left({above}).right({above})"),
            (_, false) => format!("{text}.lowest({width})"),
        };
        let text = self.bind(&value);
        Number { text, range }
    }

    /// Returns code for a truth per lane: whether bit `index` of the number is set.
    pub(super) fn number_bit(&mut self, a: &Number, index: u32) -> String {
        let sign = a.range.right(index).within(Range::new(-1, 0));
        let narrow = a.range.narrow();
        let value = match (sign, narrow) {
            (true, true) => format!("{}.less(v.ints(0))", a.text),
            (true, false) => format!("{}.less(v.longs(0))", a.text),
            (false, true) => format!("{}.has({})", a.text, 1_u64 << index.min(31)),
            (false, false) => {
                let bit = (1_u64 << index.min(63)).cast_signed();
                format!("{}.has({bit})", a.text)
            }
        };
        self.bind(&value)
    }

    /// Returns two numbers in lanes of one kind: narrow ones if both are narrow.
    fn alike(&mut self, a: &Number, b: &Number) -> [String; 2] {
        if a.range.narrow() && b.range.narrow() {
            [a.text.clone(), b.text.clone()]
        } else {
            [self.longs(a), self.longs(b)]
        }
    }

    /// `a < b`
    pub(super) fn less(&mut self, a: &Number, b: &Number) -> String {
        let [a, b] = self.alike(a, b);
        self.bind(&format!("{a}.less({b})"))
    }

    /// Returns a where `when` holds, b elsewhere.
    pub(super) fn choose(&mut self, a: &Number, when: &str, b: &Number) -> Number {
        let range = a.range.union(b.range);
        let [a, b] = self.alike(a, b);
        let text = self.bind(&format!("{a}.choose({when}, {b})"));
        Number { text, range }
    }

    /// Returns `a + b` or `a - b`; only its lowest 32 bits if the caller needs at most 32 `bits`.
    pub(super) fn added(&mut self, a: &Number, b: &Number, subtract: bool, bits: u32) -> Number {
        let (range, operation) = if subtract {
            (a.range.sub(b.range), "sub")
        } else {
            (a.range.add(b.range), "add")
        };
        if range.narrow() || bits <= 32 {
            let (a, b) = (self.ints(a), self.ints(b));
            return self.of_ints(range.cut(), &format!("{a}.{operation}({b})"));
        }
        let (a, b) = (self.longs(a), self.longs(b));
        self.of_longs(range, format!("{a}.{operation}({b})"))
    }

    /// Returns `floor(a b / 2^drop)`, or at least its lowest `bits` bits.
    pub(super) fn product(&mut self, a: &Number, b: &Number, drop: u32, bits: u32) -> Number {
        let product = a.range.mul(b.range);
        let range = product.right(drop);
        if !a.range.narrow() || !b.range.narrow() {
            let (a, b) = (self.longs(a), self.longs(b));
            // If the lowest 64 bits hold all the bits needed, they are enough.
            let value = if drop + bits <= 64 {
                format!("{a}.mul({b}).right({drop})")
            } else {
                format!("v.product_of_longs({a}, {b}, {drop})")
            };
            return self.of_longs(Range::ALL, value);
        }
        let (a, b) = (&a.text, &b.text);
        if product.narrow() || drop + bits <= 32 {
            let range = if product.narrow() { range } else { Range::INTS };
            let value = match drop.min(31) {
                0 => format!("{a}.mul({b})"),
                drop => format!("{a}.mul({b}).right({drop})"),
            };
            return self.of_ints(range, &value);
        }
        let drop = drop.min(63);
        if range.narrow() || bits <= 32 {
            return self.of_ints(range.cut(), &format!("v.product_above({a}, {b}, {drop})"));
        }
        self.of_longs(range, format!("v.product({a}, {b}).right({drop})"))
    }

    /// Returns `floor(sqrt(a))` of a number that is not negative.
    pub(super) fn root(&mut self, a: &Number) -> Number {
        let high = a.range.high.cast_unsigned();
        let bits = (64 - high.leading_zeros()).div_ceil(2).max(1);
        let range = Range::of_width(bits, false);
        if a.range.within(Range::of_width(23, false)) {
            return self.of_ints(range, &format!("v.root_single({})", a.text));
        }
        let how = if a.range.within(Range::of_width(52, false)) {
            "root_double"
        } else {
            "root_of_longs"
        };
        let longs = self.longs(a);
        self.of_longs(range, format!("v.{how}({longs})"))
    }
}
