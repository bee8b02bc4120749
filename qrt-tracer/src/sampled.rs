//! Functions of one sample coordinate: tables where that is possible.

use qrt_scene::sampling::cell_centre;
use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

/// Most index bits of a function whose table is stored.
pub(super) const TABLE_BITS: u32 = 14;

/// Most index bits of a function whose values are kept, each as it is first asked for. Machines evaluate functions of
/// more bits each time.
pub(super) const KEPT_BITS: u32 = 18;

/// A function of one sample coordinate's index.
#[derive(Clone)]
pub struct Sampled {
    bits: u32,
    table: Arc<[f64]>,
    /// The values that were asked for; none if they are not kept.
    evaluated: Option<Arc<Evaluated>>,
    function: Arc<dyn Fn(u32) -> f64 + Send + Sync>,
}

impl Sampled {
    /// A function of the index, `0..2^bits`.
    pub(crate) fn of_index(
        bits: u32,
        function: impl Fn(u32) -> f64 + Send + Sync + 'static,
    ) -> Self {
        Self::stored(bits, KEPT_BITS, function)
    }

    /// The same, of which no value is stored or kept if it has more index bits than `most`.
    pub(super) fn stored(
        bits: u32,
        most: u32,
        function: impl Fn(u32) -> f64 + Send + Sync + 'static,
    ) -> Self {
        let has_table = bits <= most.min(TABLE_BITS);
        let is_kept = !has_table && bits <= most.min(KEPT_BITS);
        let entries = if has_table { 1 << bits } else { 0 };
        let table = (0..entries).map(&function).collect();
        Self {
            bits,
            table,
            evaluated: is_kept.then(Arc::default),
            function: Arc::new(function),
        }
    }

    /// A function of the cell centre `(index + 1/2) / 2^bits`.
    pub(crate) fn of_centre(
        bits: u32,
        function: impl Fn(f64) -> f64 + Send + Sync + 'static,
    ) -> Self {
        Self::of_index(bits, move |index| function(cell_centre(index, bits)))
    }

    /// Number of bits of the index.
    pub fn bits(&self) -> u32 {
        self.bits
    }

    /// All values by index, if they are stored.
    #[inline(always)]
    pub fn table(&self) -> Option<&[f64]> {
        (!self.table.is_empty()).then_some(&*self.table)
    }

    /// The value at `index`.
    pub fn at(&self, index: u32) -> f64 {
        match (self.table(), &self.evaluated) {
            (Some(table), _) => table[index as usize],
            (None, Some(evaluated)) => evaluated.at(1 << self.bits, index, &*self.function),
            (None, None) => (self.function)(index),
        }
    }

    /// True if both are stored, and equal.
    pub(super) fn same(&self, other: &Self) -> bool {
        self.bits == other.bits && !self.table.is_empty() && self.table == other.table
    }
}

/// The values of a function that were asked for, by index.
#[derive(Default)]
struct Evaluated {
    /// The inverted bits of each value; 0 if it was not asked for, or is the NaN whose bits are all 1. Threads that
    /// evaluate a value at the same time keep the same bits.
    values: OnceLock<Box<[AtomicU64]>>,
}

impl Evaluated {
    /// Returns the value of `function` at `index`, which is below `entries`.
    fn at(&self, entries: usize, index: u32, function: impl Fn(u32) -> f64) -> f64 {
        let none = || (0..entries).map(|_| AtomicU64::new(0)).collect();
        let kept = &self.values.get_or_init(none)[index as usize];
        match kept.load(Ordering::Relaxed) {
            0 => {
                let value = function(index);
                kept.store(!value.to_bits(), Ordering::Relaxed);
                value
            }
            bits => f64::from_bits(!bits),
        }
    }
}

impl fmt::Debug for Sampled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Sampled")
            .field("bits", &self.bits)
            .field("table", &self.table)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicU32;

    /// Wide coordinates are evaluated once, and narrow ones when the table is made.
    #[test]
    fn values_are_those_of_the_function_and_evaluated_once() {
        for (bits, most) in [(14, 18), (15, 18), (18, 20), (19, 20), (14, 13), (16, 14)] {
            let calls = Arc::new(AtomicU32::new(0));
            let counted = Arc::clone(&calls);
            let sampled = Sampled::stored(bits, most, move |index| {
                counted.fetch_add(1, Ordering::Relaxed);
                // The least of these is 0, and one is not a number.
                if index == 1 {
                    f64::NAN
                } else {
                    f64::from(index).sqrt()
                }
            });
            let made = calls.swap(0, Ordering::Relaxed);
            let has_table = bits <= TABLE_BITS && bits <= most;
            assert_eq!(made, if has_table { 1 << bits } else { 0 });
            for index in [0, 1, 2, (1 << bits) - 1] {
                let values = [(); 3].map(|()| sampled.clone().at(index).to_bits());
                let expected = if index == 1 {
                    f64::NAN
                } else {
                    f64::from(index).sqrt()
                };
                assert_eq!(values, [expected.to_bits(); 3]);
            }
            let expected = match (bits, most) {
                (14, 18) => 0,
                (15 | 18, _) => 4,
                _ => 12,
            };
            assert_eq!(calls.load(Ordering::Relaxed), expected, "{bits} bits");
        }
    }
}
