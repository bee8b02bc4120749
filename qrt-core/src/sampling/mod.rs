//! Where a path's random numbers come from: sequences that map a path index to cells of the unit
//! square, one square per ray.
//!
//! The integral over paths is the mean over `R = 2^path_bits` path indices. Ray `k` of path `id`
//! takes its coordinates `(u, v)` from dimensions `2k` and `2k + 1`; each is the index of one of
//! `2^bits` cells and stands for its centre ([`cell_centre`]). Both sequences are linear over
//! GF(2), up to the pixel's shift:
//!
//! `index_d(id) = shift_d ^ XOR_b id_b column_d(b)`,
//!
//! bit 0 of path indices `id` and of sample indices being the least significant. So in a circuit
//! they cost CNOTs and Xs and not one Toffoli.
//!
//! * [`DigitalNet`]: every bit of the path index acts on every coordinate; the error falls almost
//!   as `1/R`.
//! * [`ProductLattice`]: the paper's; each coordinate has bits of the path index of its own.

mod joe_kuo;
mod lattice;
mod linear;
pub mod maps;
mod net;
#[cfg(test)]
mod tests;

pub use crate::scene::MAX_PATH_BITS;
pub use lattice::ProductLattice;
pub use net::{DigitalNet, MAX_DIMENSIONS, pixel_shift};

use crate::scene::{Sampling, Sequence};
use linear::LinearMap;
use std::fmt;

/// Most bits of one coordinate's index.
pub const MAX_COORDINATE_BITS: u32 = 32;

/// The sampling points of all paths of a pixel, as the scene's `sampling` block asks for them.
///
/// ```
/// use qrt_core::sampling::{PathPoints, cell_centre};
/// use qrt_core::scene::{DepthSampling, Map, Sampling, Sequence};
/// let depths = vec![DepthSampling { bits: [8, 8], map: Map::Auto }; 3];
/// let sampling = Sampling { sequence: Sequence::DigitalNet, path_bits: 12, depths };
/// let points = PathPoints::new(&sampling)?;
/// // u of the second ray, for all paths of pixel (3, 5):
/// let shift = points.shift(1, 3, 5, PathPoints::dimension(1, 0));
/// let mut u = vec![0; 1 << points.path_bits()];
/// points.indices(1, 0, 0, shift, &mut u);
/// let mean = u.iter().map(|&k| cell_centre(k, 8)).sum::<f64>() / u.len() as f64;
/// assert_eq!(mean, 0.5);
/// # Ok::<(), qrt_core::sampling::SamplingError>(())
/// ```
#[derive(Clone, Debug)]
pub struct PathPoints {
    sequence: Sequence,
    path_bits: u32,
    coordinates: Vec<Coordinate>,
}

#[derive(Clone, Debug)]
struct Coordinate {
    bits: u32,
    map: LinearMap,
}

impl PathPoints {
    /// The points that `sampling` asks for.
    ///
    /// # Errors
    /// Sizes beyond the stated limits, or, for the product lattice, `path_bits` other than the sum
    /// of all bits. A [`crate::valid::ValidScene`]'s sampling has none of these.
    pub fn new(sampling: &Sampling) -> Result<Self, SamplingError> {
        let bits: Vec<[u32; 2]> = sampling.depths.iter().map(|depth| depth.bits).collect();
        for (dimension, &bits) in bits.iter().flatten().enumerate() {
            if bits > MAX_COORDINATE_BITS {
                return Err(SamplingError::CoordinateBits { dimension, bits });
            }
        }
        let path_bits = sampling.path_bits;
        let maps: Vec<LinearMap> = match sampling.sequence {
            Sequence::DigitalNet => {
                let net = DigitalNet::new(2 * bits.len(), path_bits)?;
                let map = |(d, &bits)| {
                    let column = |b| net::top(net.column(d, b), bits) as u32;
                    LinearMap::new((0..path_bits).map(column))
                };
                bits.iter().flatten().enumerate().map(map).collect()
            }
            Sequence::ProductLattice => {
                let lattice = ProductLattice::new(&bits)?;
                let sum = lattice.path_bits();
                if sum != path_bits {
                    return Err(SamplingError::LatticeBits { path_bits, sum });
                }
                let map = |d| LinearMap::new((0..sum).map(|b| lattice.column(d, b) as u32));
                (0..lattice.dimensions()).map(map).collect()
            }
        };
        let coordinates = maps
            .into_iter()
            .zip(bits.iter().flatten())
            .map(|(map, &bits)| Coordinate { bits, map })
            .collect();
        Ok(Self {
            sequence: sampling.sequence,
            path_bits,
            coordinates,
        })
    }

    /// The dimension of coordinate `axis` (0: u, 1: v) of ray `depth`: `2 depth + axis`.
    pub fn dimension(depth: usize, axis: usize) -> usize {
        2 * depth + axis
    }

    /// How many bits a path index has: path indices are `0 .. 2^path_bits`.
    pub fn path_bits(&self) -> u32 {
        self.path_bits
    }

    /// How many rays a path has: one more than its bounces.
    pub fn depths(&self) -> usize {
        self.coordinates.len() / 2
    }

    /// Bits of the indices of coordinate `axis` (0: u, 1: v) of ray `depth`.
    ///
    /// # Panics
    /// If `depth` or `axis` is out of range.
    pub fn bits(&self, depth: usize, axis: usize) -> u32 {
        self.coordinate(depth, axis).bits
    }

    /// The bits of the sample index that bit `id_bit` of the path index flips.
    ///
    /// # Panics
    /// If `depth` or `axis` is out of range.
    pub fn column(&self, depth: usize, axis: usize, id_bit: u32) -> u32 {
        self.coordinate(depth, axis).map.column(id_bit)
    }

    /// The shift of a dimension in pixel (`x` from the left, `y` from the top): [`pixel_shift`]
    /// for the digital net, 0 for the lattice. Its top bits are XORed with the indices.
    pub fn shift(&self, seed: u64, x: u32, y: u32, dimension: usize) -> u64 {
        match self.sequence {
            Sequence::DigitalNet => pixel_shift(seed, x, y, dimension),
            Sequence::ProductLattice => 0,
        }
    }

    /// Whether pixels shift their points.
    pub fn shifts(&self) -> bool {
        self.sequence == Sequence::DigitalNet
    }

    /// The sample index of coordinate `axis` of ray `depth` on path `id`.
    ///
    /// # Panics
    /// If `depth` or `axis` is out of range.
    pub fn index(&self, depth: usize, axis: usize, id: u64, shift: u64) -> u32 {
        let Coordinate { bits, map } = self.coordinate(depth, axis);
        map.index(id) ^ net::top(shift, *bits) as u32
    }

    /// The sample indices of coordinate `axis` of ray `depth` on the paths `first_id ..`, as many
    /// as `out` holds. One XOR and one store per path, best for runs of 256 paths or more.
    ///
    /// # Panics
    /// If `depth` or `axis` is out of range.
    pub fn indices(&self, depth: usize, axis: usize, first_id: u64, shift: u64, out: &mut [u32]) {
        let Coordinate { bits, map } = self.coordinate(depth, axis);
        map.indices(first_id, net::top(shift, *bits) as u32, out);
    }

    fn coordinate(&self, depth: usize, axis: usize) -> &Coordinate {
        assert!(axis < 2, "axis {axis}: 0 is u, 1 is v");
        &self.coordinates[Self::dimension(depth, axis)]
    }
}

/// The centre of cell `index` of `2^bits`: `(index + 1/2) / 2^bits`, exactly; `bits` is at most
/// [`MAX_COORDINATE_BITS`].
pub fn cell_centre(index: u32, bits: u32) -> f64 {
    (f64::from(index) + 0.5) / (1u64 << bits.min(MAX_COORDINATE_BITS)) as f64
}

/// Why a sequence cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SamplingError {
    /// More coordinates than there are direction numbers.
    #[allow(missing_docs)]
    Dimensions { dimensions: usize },
    /// More path bits than a path index holds.
    #[allow(missing_docs)]
    PathBits { path_bits: u64 },
    /// A coordinate finer than an index holds.
    #[allow(missing_docs)]
    CoordinateBits { dimension: usize, bits: u32 },
    /// The product lattice's path bits are not the sum of its coordinates'.
    #[allow(missing_docs)]
    LatticeBits { path_bits: u32, sum: u32 },
}

impl fmt::Display for SamplingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Dimensions { dimensions } => write!(
                f,
                "{dimensions} coordinates per path; the digital net has {MAX_DIMENSIONS}, two per ray"
            ),
            Self::PathBits { path_bits } => {
                write!(f, "{path_bits} path bits; an id holds {MAX_PATH_BITS}")
            }
            Self::CoordinateBits { dimension, bits } => write!(
                f,
                "{bits} bits for {} of depth {}; a coordinate holds {MAX_COORDINATE_BITS}",
                ["u", "v"][dimension % 2],
                dimension / 2
            ),
            Self::LatticeBits { path_bits, sum } => write!(
                f,
                "{path_bits} path bits, but the product lattice's coordinates have {sum} in all"
            ),
        }
    }
}

impl std::error::Error for SamplingError {}
