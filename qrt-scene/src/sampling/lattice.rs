//! The paper's product lattice: the path index, here `id`, is the concatenation of each depth's
//! bits.
//!
//! `id = id_0 | id_1 << n_0 | ...`, depth 0 lowest, and in each depth `id_k = i | j << bits_u`: `u`
//! below `v`, every field little-endian. Cell `i` of `2^bits` stands at its centre
//! `(i + 1/2) / 2^bits`. No pixel is shifted. It is the midpoint rule in every coordinate, with its
//! error of order `R^(-1/(2 D))` for discontinuous integrands of D rays.

use super::SamplingError;
use crate::scene::MAX_PATH_BITS;

/// The lattice of a path's coordinates.
///
/// ```
/// use qrt_scene::sampling::ProductLattice;
/// let lattice = ProductLattice::new(&[[2, 1], [0, 3]])?;
/// assert_eq!(lattice.path_bits(), 6);
/// // v of depth 1 is dimension 3: the three highest bits of the path index.
/// assert_eq!(lattice.index(3, 0b101_0_00), 0b101);
/// assert_eq!(lattice.index(0, 0b000_0_11), 0b11);
/// # Ok::<(), qrt_scene::sampling::SamplingError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProductLattice {
    /// Per dimension: the lowest bit of its field of the path index, and the field's width.
    fields: Vec<(u32, u32)>,
    path_bits: u32,
}

impl ProductLattice {
    /// The lattice with `bits[k] = [u, v]` bits for the coordinates of depth `k`.
    ///
    /// # Errors
    /// If the bits together exceed [`MAX_PATH_BITS`].
    pub fn new(bits: &[[u32; 2]]) -> Result<Self, SamplingError> {
        let path_bits = bits.iter().flatten().map(|&b| u64::from(b)).sum();
        if path_bits > u64::from(MAX_PATH_BITS) {
            return Err(SamplingError::PathBits { path_bits });
        }
        let mut lowest = 0;
        let fields = bits
            .iter()
            .flatten()
            .map(|&width| {
                let field = (lowest, width);
                lowest += width;
                field
            })
            .collect();
        Ok(Self {
            fields,
            path_bits: lowest,
        })
    }

    /// Number of coordinates of a point.
    pub fn dimensions(&self) -> usize {
        self.fields.len()
    }

    /// Number of bits of a path index: the sum of all coordinates' bits.
    pub fn path_bits(&self) -> u32 {
        self.path_bits
    }

    /// Returns the bit of the coordinate's sample index that bit `id_bit` of the path index sets,
    /// or 0 if that bit belongs to another coordinate.
    ///
    /// # Panics
    /// If `dimension` is not below [`Self::dimensions`].
    pub fn column(&self, dimension: usize, id_bit: u32) -> u64 {
        let (lowest, width) = self.fields[dimension];
        if (lowest..lowest + width).contains(&id_bit) {
            1 << (id_bit - lowest)
        } else {
            0
        }
    }

    /// The cell of coordinate `dimension` of path `id`: its field of the path index.
    ///
    /// # Panics
    /// If `dimension` is not below [`Self::dimensions`].
    pub fn index(&self, dimension: usize, id: u64) -> u64 {
        let (lowest, width) = self.fields[dimension];
        (id >> lowest) & ((1 << width) - 1)
    }
}
