//! Functions of one sample coordinate: tables where that is possible.

use qrt_scene::sampling::cell_centre;
use std::fmt;
use std::sync::Arc;

/// Tables of more index bits than this are not stored: machines evaluate the function instead.
pub(super) const TABLE_BITS: u32 = 14;

/// A function of one sample coordinate's index.
#[derive(Clone)]
pub struct Sampled {
    bits: u32,
    table: Arc<[f64]>,
    function: Arc<dyn Fn(u32) -> f64 + Send + Sync>,
}

impl Sampled {
    /// A function of the index, `0..2^bits`.
    pub(crate) fn of_index(
        bits: u32,
        function: impl Fn(u32) -> f64 + Send + Sync + 'static,
    ) -> Self {
        Self::stored(bits, TABLE_BITS, function)
    }

    /// The same, whose table is not stored if it has more index bits than `most`.
    pub(super) fn stored(
        bits: u32,
        most: u32,
        function: impl Fn(u32) -> f64 + Send + Sync + 'static,
    ) -> Self {
        let entries = if bits <= most { 1 << bits } else { 0 };
        let table = (0..entries).map(&function).collect();
        Self {
            bits,
            table,
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
        match self.table() {
            Some(table) => table[index as usize],
            None => (self.function)(index),
        }
    }

    /// True if both are stored, and equal.
    pub(super) fn same(&self, other: &Self) -> bool {
        self.bits == other.bits && !self.table.is_empty() && self.table == other.table
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
