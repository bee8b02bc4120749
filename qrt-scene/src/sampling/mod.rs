//! The source of a path's random numbers: sequences that map a path index to cells of the unit
//! square, one square per ray and per point on a lamp.
//!
//! The integral over paths is the mean over `R = 2^path_bits` path indices. Ray `k` of path `id`
//! takes its coordinates `(u, v)` from two dimensions of its own, after those of earlier rays.
//! Points on lamps have the dimensions after all rays, and the point on the lens has the last two
//! ([`Sampling::squares`]). Each coordinate is
//! the index of one of `2^bits` cells and stands for its centre ([`cell_centre`]). Both sequences
//! are linear over GF(2), up to the pixel's shift:
//!
//! `index_d(id) = shift_d ^ XOR_b id_b column_d(b)`,
//!
//! where bit 0 of path indices `id` and of sample indices is the least significant. So in a circuit
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

pub use crate::scene::{MAX_PATH_BITS, Square};
pub use lattice::ProductLattice;
pub use net::{DigitalNet, MAX_DIMENSIONS, pixel_shift};

use crate::scene::{Sampling, Sequence};
use linear::LinearMap;
use std::fmt;

/// Maximum number of bits of one coordinate's index.
pub const MAX_COORDINATE_BITS: u32 = 32;

/// The sampling points of all paths of a pixel, as the scene's `sampling` block defines them.
///
/// ```
/// use qrt_scene::sampling::{Coordinate, PathPoints, cell_centre};
/// use qrt_scene::{DepthSampling, Sampling};
/// let depths = vec![DepthSampling::of_bits([8, 8]); 3];
/// let sampling = Sampling { path_bits: 12, depths, ..Sampling::default() };
/// let points = PathPoints::new(&sampling)?;
/// // u of the second ray, for all paths of pixel (3, 5):
/// let u = Coordinate::u(1);
/// let shift = points.shift(1, 3, 5, u);
/// let mut indices = vec![0; 1 << points.path_bits()];
/// points.indices(u, 0, shift, &mut indices);
/// let mean = indices.iter().map(|&k| cell_centre(k, 8)).sum::<f64>() / indices.len() as f64;
/// assert_eq!(mean, 0.5);
/// # Ok::<(), qrt_scene::sampling::SamplingError>(())
/// ```
#[derive(Clone, Debug)]
pub struct PathPoints {
    sequence: Sequence,
    path_bits: u32,
    depths: usize,
    /// Bits and map of each coordinate, by dimension.
    dimensions: Vec<(u32, LinearMap)>,
    /// The first dimension of each square, by [`Coordinate::slot`] of its `u`, halved.
    squares: Vec<Option<usize>>,
}

/// A coordinate of a square.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axis {
    /// The first: the radial one of the built-in maps; to the right on the film.
    U,
    /// The second: the azimuthal one of the built-in maps; downwards on the film.
    V,
}

/// A sample coordinate of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Coordinate {
    /// The number of bounces before the ray that it belongs to: 0 for the primary ray.
    pub depth: usize,
    /// The square that it samples: of the ray, or of the point on a lamp to which the ray's start
    /// is connected.
    pub square: Square,
    /// The axis of the coordinate in its square.
    pub axis: Axis,
}

impl Coordinate {
    /// The first coordinate of the ray of this `depth`.
    pub const fn u(depth: usize) -> Self {
        let (square, axis) = (Square::Ray, Axis::U);
        Self {
            depth,
            square,
            axis,
        }
    }

    /// The second coordinate of the ray of this `depth`.
    pub const fn v(depth: usize) -> Self {
        Self::u(depth).with_axis(Axis::V)
    }

    /// The first coordinate of the point on a lamp to which the start of the ray of this `depth` is
    /// connected.
    pub const fn light_u(depth: usize) -> Self {
        let (square, axis) = (Square::Light, Axis::U);
        Self {
            depth,
            square,
            axis,
        }
    }

    /// The second coordinate of the point on a lamp to which the start of the ray of this `depth`
    /// is connected.
    pub const fn light_v(depth: usize) -> Self {
        Self::light_u(depth).with_axis(Axis::V)
    }

    /// The first coordinate of the point on the camera's lens.
    pub const fn lens_u() -> Self {
        Self::light_u(0)
    }

    /// The second coordinate of the point on the camera's lens.
    pub const fn lens_v() -> Self {
        Self::light_v(0)
    }

    const fn with_axis(self, axis: Axis) -> Self {
        Self { axis, ..self }
    }

    /// Returns a number that is unique to the coordinate, below `4 D`, whether or not the scene
    /// samples it.
    #[inline(always)]
    pub const fn slot(self) -> usize {
        4 * self.depth + 2 * self.square as usize + self.axis as usize
    }
}

impl fmt::Display for Coordinate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let axis = ["u", "v"][self.axis as usize];
        let light = match self.square {
            Square::Ray => "",
            Square::Light if self.depth == 0 => " of the point on the lens",
            Square::Light => " of the point on a lamp",
        };
        write!(f, "{axis}{light} of depth {}", self.depth)
    }
}

impl PathPoints {
    /// Creates the points that `sampling` defines.
    ///
    /// # Errors
    /// Sizes beyond the stated limits, or, for the product lattice, `path_bits` other than the sum
    /// of all bits. A [`crate::valid::ValidScene`]'s sampling has none of these.
    pub fn new(sampling: &Sampling) -> Result<Self, SamplingError> {
        let mut bits = Vec::new();
        let mut squares = vec![None; 2 * sampling.depths.len()];
        for (depth, square, [u, v]) in sampling.squares() {
            squares[2 * depth + square as usize] = Some(2 * bits.len());
            bits.push([u, v]);
            for (axis, bits) in [(Axis::U, u), (Axis::V, v)] {
                if bits > MAX_COORDINATE_BITS {
                    let coordinate = Coordinate {
                        depth,
                        square,
                        axis,
                    };
                    return Err(SamplingError::CoordinateBits { coordinate, bits });
                }
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
        Ok(Self {
            sequence: sampling.sequence,
            path_bits,
            depths: sampling.depths.len(),
            dimensions: bits.into_iter().flatten().zip(maps).collect(),
            squares,
        })
    }

    /// The dimension that a coordinate has in the sequence.
    ///
    /// # Panics
    /// If the scene does not sample `coordinate`.
    pub fn dimension(&self, coordinate: Coordinate) -> usize {
        let square = self.squares[2 * coordinate.depth + coordinate.square as usize];
        // Callers pass coordinates that the scene samples; no other has a dimension.
        #[allow(clippy::expect_used)]
        let first = square.expect("a coordinate that the scene samples");
        first + coordinate.axis as usize
    }

    /// The coordinates that the scene samples, in the order of their depths.
    pub fn coordinates(&self) -> impl Iterator<Item = Coordinate> + '_ {
        let sampled = |(number, first): (usize, &Option<usize>)| {
            let square = [Square::Ray, Square::Light][number % 2];
            let depth = number / 2;
            let of = |axis| Coordinate {
                depth,
                square,
                axis,
            };
            first.map(|_| [of(Axis::U), of(Axis::V)])
        };
        self.squares
            .iter()
            .enumerate()
            .filter_map(sampled)
            .flatten()
    }

    /// Number of bits of a path index: path indices are `0 .. 2^path_bits`.
    pub fn path_bits(&self) -> u32 {
        self.path_bits
    }

    /// Number of rays of a path: one more than its bounces.
    pub fn depths(&self) -> usize {
        self.depths
    }

    /// Number of bits of the indices of a coordinate.
    ///
    /// # Panics
    /// If the scene does not sample `coordinate`.
    pub fn bits(&self, coordinate: Coordinate) -> u32 {
        self.bits_and_map(coordinate).0
    }

    /// The bits of the sample index that bit `id_bit` of the path index flips.
    ///
    /// # Panics
    /// If the scene does not sample `coordinate`.
    pub fn column(&self, coordinate: Coordinate, id_bit: u32) -> u32 {
        self.bits_and_map(coordinate).1.column(id_bit)
    }

    /// The shift of a coordinate in pixel (`x` from the left, `y` from the top): [`pixel_shift`]
    /// of its dimension for the digital net, 0 for the lattice. Its top bits are XORed with the
    /// indices.
    ///
    /// # Panics
    /// If the scene does not sample `coordinate`.
    pub fn shift(&self, seed: u64, x: u32, y: u32, coordinate: Coordinate) -> u64 {
        match self.sequence {
            Sequence::DigitalNet => pixel_shift(seed, x, y, self.dimension(coordinate)),
            Sequence::ProductLattice => 0,
        }
    }

    /// True if pixels shift their points.
    pub fn shifts(&self) -> bool {
        self.sequence == Sequence::DigitalNet
    }

    /// The sample index of a coordinate on path `id`.
    ///
    /// # Panics
    /// If the scene does not sample `coordinate`.
    pub fn index(&self, coordinate: Coordinate, id: u64, shift: u64) -> u32 {
        let (bits, map) = self.bits_and_map(coordinate);
        map.index(id) ^ net::top(shift, *bits) as u32
    }

    /// Writes the sample indices of a coordinate on the paths `first_id ..` to `out`, one per
    /// element. It takes one XOR and one store per path, and is best for runs of 256 paths or more.
    ///
    /// # Panics
    /// If the scene does not sample `coordinate`.
    pub fn indices(&self, coordinate: Coordinate, first_id: u64, shift: u64, out: &mut [u32]) {
        let (bits, map) = self.bits_and_map(coordinate);
        map.indices(first_id, net::top(shift, *bits) as u32, out);
    }

    fn bits_and_map(&self, coordinate: Coordinate) -> &(u32, LinearMap) {
        &self.dimensions[self.dimension(coordinate)]
    }
}

/// The centre of cell `index` of `2^bits`: `(index + 1/2) / 2^bits`, exactly; `bits` is at most
/// [`MAX_COORDINATE_BITS`].
#[inline]
pub fn cell_centre(index: u32, bits: u32) -> f64 {
    (f64::from(index) + 0.5) / (1u64 << bits.min(MAX_COORDINATE_BITS)) as f64
}

/// The reason that a sequence cannot be made.
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
    CoordinateBits { coordinate: Coordinate, bits: u32 },
    /// The product lattice's path bits are not the sum of its coordinates'.
    #[allow(missing_docs)]
    LatticeBits { path_bits: u32, sum: u32 },
}

impl SamplingError {
    /// Converts the error to a problem of the scene.
    pub fn problem(self) -> qrt_syntax::Sampling {
        match self {
            Self::Dimensions { dimensions } => qrt_syntax::Sampling::Dimensions {
                dimensions,
                most: MAX_DIMENSIONS,
            },
            Self::PathBits { path_bits } => qrt_syntax::Sampling::PathBits {
                bits: path_bits,
                most: MAX_PATH_BITS,
            },
            Self::CoordinateBits { coordinate, bits } => qrt_syntax::Sampling::CoordinateBits {
                coordinate: coordinate.to_string(),
                bits,
                most: MAX_COORDINATE_BITS,
            },
            Self::LatticeBits { path_bits, sum } => qrt_syntax::Sampling::LatticeBits {
                path: path_bits,
                sum,
            },
        }
    }
}

impl fmt::Display for SamplingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Directly, not by way of all problems, whose words a caller may not need.
        self.problem().description().fmt(f)
    }
}

impl std::error::Error for SamplingError {}
