//! The digital net: all path bits form one path index, here `id`, and coordinate `d` is `C_d id`
//! over GF(2).
//!
//! The matrices `C_d` are Sobol's with the direction numbers of Joe & Kuo: with `p(x) = x^s + a_1
//! x^(s-1) + ... + 1` the dimension's primitive polynomial and `V_i = m_i 2^-i`,
//!
//! `V_i = a_1 V_(i-1) ^ ... ^ a_(s-1) V_(i-s+1) ^ V_(i-s) ^ (V_(i-s) >> s)` for `i > s`.
//!
//! Column `b` of the matrix, the contribution of bit `b` of the path index, is `V_(b+1)`; bit 0 is
//! the least significant. Path indices run in natural order, not in Gray code: point `id` here is
//! point `n` of a generator in Gray code, with `id = n ^ (n >> 1)`. Any first `2^m` points are a
//! (t, m, s)-net.
//!
//! The point is XORed with a [`pixel_shift`], so that neighbouring pixels err independently, and
//! its top `bits` bits are the index `k` of its cell, whose centre `(k + 1/2) / 2^bits` is traced.
//! An XOR shift maps elementary intervals to elementary intervals: the net stays a net.

use super::SamplingError;
use super::joe_kuo::INITIAL;
use crate::scene::MAX_PATH_BITS;

/// Maximum number of dimensions of a net: two per ray, so paths of up to 64 rays.
pub const MAX_DIMENSIONS: usize = INITIAL.len() + 1;

/// A Sobol' net of `2^path_bits` points.
///
/// ```
/// use qrt_scene::sampling::DigitalNet;
/// let net = DigitalNet::new(2, 3)?;
/// // Three bits of dimension 0 are the path index's, reversed; dimension 1 visits every cell once too.
/// let index = |d| (0..8).map(|id| net.index(d, id, 0, 3)).collect::<Vec<_>>();
/// assert_eq!(index(0), [0, 4, 2, 6, 1, 5, 3, 7]);
/// assert_eq!(index(1), [0, 4, 6, 2, 5, 1, 3, 7]);
/// # Ok::<(), qrt_scene::sampling::SamplingError>(())
/// ```
#[derive(Clone, Debug)]
pub struct DigitalNet {
    dimensions: usize,
    path_bits: u32,
    /// Dimension by dimension, `path_bits` columns each, aligned to bit 63.
    columns: Vec<u64>,
}

impl DigitalNet {
    /// The net of `2^path_bits` points in `dimensions` dimensions.
    ///
    /// # Errors
    /// If there are more than [`MAX_DIMENSIONS`] dimensions or [`MAX_PATH_BITS`] bits.
    pub fn new(dimensions: usize, path_bits: u32) -> Result<Self, SamplingError> {
        if dimensions > MAX_DIMENSIONS {
            return Err(SamplingError::Dimensions { dimensions });
        }
        if path_bits > MAX_PATH_BITS {
            return Err(SamplingError::PathBits {
                path_bits: path_bits.into(),
            });
        }
        let columns = (0..dimensions)
            .flat_map(|d| direction_numbers(d, path_bits))
            .collect();
        Ok(Self {
            dimensions,
            path_bits,
            columns,
        })
    }

    /// Number of coordinates of a point.
    pub fn dimensions(&self) -> usize {
        self.dimensions
    }

    /// Number of bits of a path index.
    pub fn path_bits(&self) -> u32 {
        self.path_bits
    }

    /// Returns the bits of the coordinate that bit `id_bit` of the path index flips, as a fraction
    /// aligned to bit 63; 0 for bits beyond `path_bits`.
    ///
    /// # Panics
    /// If `dimension` is not below [`Self::dimensions`].
    pub fn column(&self, dimension: usize, id_bit: u32) -> u64 {
        assert!(
            dimension < self.dimensions,
            "dimension {dimension} of {}",
            self.dimensions
        );
        if id_bit < self.path_bits {
            self.columns[dimension * self.path_bits as usize + id_bit as usize]
        } else {
            0
        }
    }

    /// The cell of coordinate `dimension` of point `id`: the top `bits` (0 to 64) bits of
    /// `C_d id ^ shift`. Bits of `id` beyond `path_bits` do not matter.
    ///
    /// # Panics
    /// If `dimension` is not below [`Self::dimensions`].
    pub fn index(&self, dimension: usize, id: u64, shift: u64, bits: u32) -> u64 {
        let point = (0..self.path_bits)
            .filter(|b| id >> b & 1 == 1)
            .fold(shift, |point, b| point ^ self.column(dimension, b));
        top(point, bits)
    }
}

/// The top `bits` bits of a fraction.
pub(super) fn top(fraction: u64, bits: u32) -> u64 {
    fraction.checked_shr(64 - bits.min(64)).unwrap_or(0)
}

fn direction_numbers(dimension: usize, count: u32) -> Vec<u64> {
    let mut v = Vec::<u64>::with_capacity(count as usize);
    let initial = dimension.checked_sub(1).map(|d| INITIAL[d]);
    for i in 0..count as usize {
        v.push(match initial {
            None => 1 << (63 - i),
            Some((_, m)) if i < m.len() => u64::from(m[i]) << (63 - i),
            Some((polynomial, m)) => {
                let s = m.len();
                let last = v[i - s] ^ (v[i - s] >> s);
                (1..s)
                    .filter(|k| polynomial >> (s - k) & 1 == 1)
                    .fold(last, |x, k| x ^ v[i - k])
            }
        });
    }
    v
}

/// The XOR shift of one coordinate in one pixel, a fraction aligned to bit 63: all 64 bits are
/// uniform. `x` counts from the left, `y` from the top.
///
/// It is output number `dimension` of the SplitMix64 generator (Steele, Lea & Flood 2014) whose
/// state is `first(first(seed) ^ (y << 32 | x))`, where `first(s)` is the first output from state
/// `s`. It is part of the guarantee of a seed: it does not change between versions, machines or
/// thread counts.
pub fn pixel_shift(seed: u64, x: u32, y: u32, dimension: usize) -> u64 {
    let pixel = u64::from(y) << 32 | u64::from(x);
    split_mix(split_mix(split_mix(seed, 0) ^ pixel, 0), dimension as u64)
}

/// Output `n` of SplitMix64 from state `state`.
pub(super) fn split_mix(state: u64, n: u64) -> u64 {
    const GAMMA: u64 = 0x9e37_79b9_7f4a_7c15;
    let z = state.wrapping_add(GAMMA.wrapping_mul(n.wrapping_add(1)));
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
