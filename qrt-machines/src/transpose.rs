//! Transposition of squares of bits: from one word per state to one word per qubit, and back.

/// Swaps bit i of word j with bit j of word i (Warren, Hacker's Delight, 7-3).
pub(crate) fn transpose(square: &mut [u64; 64]) {
    let mut half = 32;
    let mut mask = u64::MAX >> 32;
    while half != 0 {
        let mut k = 0;
        while k < 64 {
            let swapped = (square[k] >> half ^ square[k + half]) & mask;
            square[k] ^= swapped << half;
            square[k + half] ^= swapped;
            k = (k + half + 1) & !half;
        }
        half >>= 1;
        mask ^= mask << half;
    }
}
