//! Look-ups: tables, linear maps over GF(2), and the pixel's classical parameters.

use super::number::Number;
use super::range::Range;
use super::{Coder, signed};
use qrt_circuit::{Bit, RegisterId, Word};
use std::fmt::Write as _;

impl Coder<'_> {
    /// Returns a classical parameter, as the register's type reads its lowest bits.
    pub(super) fn classical(&mut self, parameter: u32, target: RegisterId) -> Number {
        let register = self.register(target);
        let (width, signed) = (register.width, signed(register.ty));
        let range = Range::of_width(width, signed);
        let word = format!("word(words, {parameter}, {width}, {signed})");
        let value = if range.narrow() {
            format!("v.ints({word} as i32)")
        } else {
            format!("v.longs({word})")
        };
        let text = self.bind(&value);
        Number { text, range }
    }

    /// Computes the XOR of the columns whose places are set bits of the source, and of a word of
    /// the pixel.
    pub(super) fn parity(
        &mut self,
        source: RegisterId,
        columns: &[u64],
        parameter: Option<u32>,
        target: RegisterId,
    ) {
        let width = self.register(target).width;
        let source = self.content(source);
        let shift = parameter.map(|parameter| self.classical(parameter, target));
        let low = self.image(&source, columns);
        let mut sum = Number {
            text: low,
            range: Range::INTS,
        };
        if width > 32 {
            let high: Vec<u64> = columns.iter().map(|column| column >> 32).collect();
            let high = self.image(&source, &high);
            let low = self.cut(sum, 32, false);
            let low = self.longs(&low);
            let both = format!("v.widen({high}).left(32).xor({low})");
            sum = self.of_longs(Range::ALL, both);
        }
        if let Some(shift) = shift {
            let (range, [sum_lanes, shift]) = if width > 32 {
                (Range::ALL, [self.longs(&sum), self.longs(&shift)])
            } else {
                (Range::INTS, [self.ints(&sum), self.ints(&shift)])
            };
            let text = self.bind(&format!("{sum_lanes}.xor({shift})"));
            sum = Number { text, range };
        }
        let fits = columns.iter().all(|column| column >> (width - 1) <= 1);
        let unsigned = Range::of_width(width, false);
        if fits && unsigned.narrow() && !signed(self.register(target).ty) {
            sum.range = unsigned;
        }
        self.set(target, sum);
    }

    /// Returns the lowest 32 bits of the XOR of the columns whose places are set bits of the
    /// source: four columns at a time, by a table of their sums.
    fn image(&mut self, source: &Number, columns: &[u64]) -> String {
        let mut sum: Option<String> = None;
        for (digit, four) in columns.chunks(4).enumerate() {
            let sums = (0..16_usize).map(|bits| {
                let places = four.iter().enumerate();
                let set = places.filter(|(place, _)| bits >> place & 1 == 1);
                set.fold(0, |sum, (_, column)| sum ^ column) as i32
            });
            let sums: Vec<i32> = sums.collect();
            let bits = self.right(source.clone(), 4 * digit as u32);
            let bits = self.ints(&bits);
            let part = self.bind(&format!("v.table16(&{sums:?}, {bits})"));
            sum = Some(match sum {
                Some(sum) => self.bind(&format!("{sum}.xor({part})")),
                None => part,
            });
        }
        sum.unwrap_or_else(|| "v.ints(0)".to_owned())
    }

    pub(super) fn table(
        &mut self,
        address: &[Bit],
        columns: &[Box<[i64]>],
        targets: &[RegisterId],
    ) {
        let index = self.index(address);
        for (column, target) in columns.iter().zip(targets) {
            self.look_up(&index, address.len() as u32, column, *target);
        }
    }

    /// Returns the number whose digits are the bits of `address`.
    fn index(&mut self, address: &[Bit]) -> String {
        if let Some(word) = neighbours(address) {
            let bits = self.bits(word);
            return self.ints(&bits);
        }
        let mut index = "v.ints(0)".to_owned();
        for (place, bit) in address.iter().enumerate() {
            let bit = self.bit(*bit);
            let digit = self.bind(&format!("{index}.add(v.ints({}))", 1_u64 << place));
            index = self.bind(&format!("{digit}.choose({bit}, {index})"));
        }
        index
    }

    /// Looks `index` up in a column; beyond the column's end, the entry is 0.
    fn look_up(&mut self, index: &str, bits: u32, column: &[i64], target: RegisterId) {
        let register = self.register(target);
        let (width, signed) = (register.width, signed(register.ty));
        let range = Range::of_width(width, signed);
        if width == 1 && !signed && bits <= 5 {
            let entries = column.iter().take(32).enumerate();
            let marks = entries.fold(0_u32, |marks, (place, entry)| {
                marks | ((entry & 1) as u32) << place
            });
            let truths = self.bind(&format!("v.marks({marks}, {index})"));
            return self.set_truths(target, truths);
        }
        let length = 1_usize << bits.max(4);
        let cut = |entry: i64| {
            Word {
                signed,
                ..Word::unsigned((), 0, width)
            }
            .read(entry.cast_unsigned())
        };
        let entries = (0..length).map(|place| column.get(place).map_or(0, |entry| cut(*entry)));
        let entries: Vec<i64> = entries.collect();
        let (kind, how) = match (range.narrow(), bits) {
            (false, _) => ("i64", "wide_table"),
            (true, 0..=4) => ("i32", "table16"),
            (true, 5) => ("i32", "table32"),
            (true, _) => ("i32", "table"),
        };
        let table = format!("N{}", target.0);
        let _ = writeln!(
            self.statics,
            "static {table}: [{kind}; {length}] = {entries:?};"
        );
        let text = self.bind(&format!("v.{how}(&{table}, {index})"));
        self.set(target, Number { text, range });
    }
}

/// Returns the word of these bits, if they stand side by side in one register.
fn neighbours(address: &[Bit]) -> Option<Word> {
    let first = address.first()?;
    let in_order = address.iter().enumerate().all(|(place, bit)| {
        !bit.inverted && bit.register == first.register && bit.index == first.index + place as u32
    });
    let width = address.len() as u32;
    in_order.then(|| Word::unsigned(first.register, first.index, width))
}
