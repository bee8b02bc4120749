//! Tables read in all lanes.

use super::lane::{Lane, Row, Slots};

/// Largest number of entries of a table of numbers that is read by comparing the address with each.
/// Vectors make about this many comparisons in the time in which the lanes load one entry after the
/// other.
const FEW: usize = 16;

/// Largest number of entries of a table of truths that is kept in words of 32.
const TRUTHS: usize = 256;

/// Creates a table of numbers, 0 beyond its entries. A short table is filled up to 2, 4, 8 or 16
/// entries.
pub(super) fn numbers<K: Lane>(entries: impl Iterator<Item = K>) -> Box<[K]> {
    let mut table: Vec<K> = entries.collect();
    if table.len() <= FEW {
        let full = table.len().next_power_of_two().max(2);
        table.resize(full, K::default());
    }
    table.into()
}

/// Creates a table of truths as bits of 1, 2, 4 or 8 words, if it is short enough.
pub(super) fn truths(entries: &[i64]) -> Option<Box<[u32]>> {
    let words = entries.len().div_ceil(32).next_power_of_two();
    let mut bits = vec![0; words];
    for (place, entry) in entries.iter().enumerate() {
        bits[place / 32] |= ((entry & 1) as u32) << (place % 32);
    }
    (entries.len() <= TRUTHS).then(|| bits.into())
}

/// Looks up the entry at each lane's address, 0 beyond the table.
#[inline(always)]
pub(super) fn look_up<K: Lane>(t: &mut Row<K>, address: &Row<i32>, table: &[K]) {
    match table.len() {
        2 => look_up_few::<K, 2>(t, address, table),
        4 => look_up_few::<K, 4>(t, address, table),
        8 => look_up_few::<K, 8>(t, address, table),
        FEW => look_up_few::<K, FEW>(t, address, table),
        _ => {
            for (t, address) in t.0.iter_mut().zip(&address.0) {
                *t = table.get(*address as usize).copied().unwrap_or_default();
            }
        }
    }
}

#[inline(always)]
fn look_up_few<K: Lane, const N: usize>(t: &mut Row<K>, address: &Row<i32>, table: &[K]) {
    let Some(table) = table.first_chunk::<N>() else {
        return;
    };
    for (t, address) in t.0.iter_mut().zip(&address.0) {
        let mut found = K::default();
        for (place, entry) in table.iter().enumerate() {
            // A mask, because the compiler would turn a sequence of choices into a jump.
            let here = K::cut(-i64::from(*address == place as i32));
            found = found.xor(entry.and(here));
        }
        *t = found;
    }
}

/// Looks up the truth at each lane's address, 0 beyond the table.
#[inline(always)]
pub(super) fn look_up_truth(slots: &Slots, t: &mut Row<u8>, address: u32, table: &[u32]) {
    let address = &slots.ints[address as usize];
    match *table {
        [a] => truth(t, address, [a]),
        [a, b] => truth(t, address, [a, b]),
        [a, b, c, d] => truth(t, address, [a, b, c, d]),
        [a, b, c, d, e, f, g, h] => truth(t, address, [a, b, c, d, e, f, g, h]),
        _ => {}
    }
}

#[inline(always)]
fn truth<const N: usize>(t: &mut Row<u8>, address: &Row<i32>, table: [u32; N]) {
    for (t, address) in t.0.iter_mut().zip(&address.0) {
        let address = address.cast_unsigned();
        let mut word = 0;
        for (place, bits) in table.into_iter().enumerate() {
            word = if address >> 5 == place as u32 {
                bits
            } else {
                word
            };
        }
        *t = (word >> (address & 31) & 1) as u8;
    }
}
