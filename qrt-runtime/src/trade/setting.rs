//! What stands in a row: one value of every parameter.

use crate::named::named;
use crate::render::Model;
use qrt_core::oracle::DEFAULT_FRACTION;
use qrt_core::sampling::Square;
use qrt_core::scene::{
    Counting, DepthSampling, Estimator, Map, Nearest, Sampling, Sequence, Uncompute,
};
use qrt_core::valid::{Parameters, most_strata};

named! {
    /// Which parameter a row is about.
    pub enum Sweep {
        /// The scene as it is.
        Scene = "scene",
        /// Every estimator with registers of every size.
        Counting = "counting",
        /// Repetitions of a smaller register.
        Repetitions = "repetitions",
        /// How many strata of the comparator are counted one by one.
        Strata = "strata",
        /// The number of comparators.
        Comparator = "comparator",
        /// The width of numbers.
        Fraction = "fraction",
        /// Paths of either sequence.
        Paths = "paths",
        /// When registers are uncomputed, and how the nearest hit is kept.
        Circuit = "circuit",
        /// What traces the paths.
        Model = "model",
        /// The length of paths.
        Depth = "depth",
        /// The scene's estimator on the pixels on which it is held against rivals.
        BesideRivals = "beside-rivals",
        /// A rival of counting: so many random paths, averaged.
        RandomPaths = "random-paths",
        /// A rival of counting: all paths of a smaller net, averaged.
        ClassicalNet = "classical-net",
    }
}

impl Sweep {
    /// Whether its rows are of pictures that no circuit makes.
    pub fn is_rival(self) -> bool {
        matches!(self, Self::RandomPaths | Self::ClassicalNet)
    }

    /// Whether its errors are those of pixels that see no lamp, where there are any.
    pub(super) fn leaves_lamps_out(self) -> bool {
        self == Self::BesideRivals || self.is_rival()
    }
}

/// One value of every parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setting {
    /// The parameter that the row is about.
    pub sweep: Sweep,
    /// What traces the paths.
    pub model: Model,
    /// How good indices are counted.
    pub estimator: Estimator,
    /// t, of T = 2^t phases.
    pub phase_bits: u32,
    /// B, the runs of the counting circuit.
    pub repetitions: u32,
    /// Strata of the comparator that are counted one by one; none: as many as what is measured
    /// suggests.
    pub strata: Option<u32>,
    /// How path indices become points.
    pub sequence: Sequence,
    /// R = 2^path_bits.
    pub path_bits: u32,
    /// D, the rays of a path.
    pub depths: usize,
    /// Fraction bits of every number.
    pub fraction: u32,
    /// C = 2^comparator_bits.
    pub comparator_bits: u32,
    /// When registers are uncomputed.
    pub uncompute: Uncompute,
    /// How the nearest hit is kept.
    pub nearest: Nearest,
}

/// Columns of a setting.
pub(super) const KEY: [&str; 13] = [
    "sweep",
    "model",
    "estimator",
    "phase_bits",
    "repetitions",
    "sequence",
    "path_bits",
    "depths",
    "fraction",
    "comparator_bits",
    "uncompute",
    "nearest",
    "strata",
];

impl Setting {
    /// The parameters as the scene has them, on the fixed machine: the circuit's own numbers.
    pub(super) fn of(parameters: &Parameters) -> Self {
        Self {
            sweep: Sweep::Scene,
            model: Model::Fixed,
            estimator: parameters.counting.estimator,
            phase_bits: parameters.counting.phase_bits,
            repetitions: parameters.counting.repetitions,
            strata: parameters.counting.strata,
            sequence: parameters.sampling.sequence,
            path_bits: parameters.sampling.path_bits,
            depths: parameters.sampling.depths.len(),
            fraction: parameters.precision.fraction.unwrap_or(DEFAULT_FRACTION),
            comparator_bits: parameters.comparator.bits,
            uncompute: parameters.circuit.uncompute,
            nearest: parameters.circuit.nearest,
        }
    }

    /// Its values, as in [`KEY`].
    pub(super) fn values(&self) -> [String; KEY.len()] {
        [
            self.sweep.name().to_owned(),
            self.model.name().to_owned(),
            self.estimator.to_string(),
            self.phase_bits.to_string(),
            self.repetitions.to_string(),
            self.sequence.to_string(),
            self.path_bits.to_string(),
            self.depths.to_string(),
            self.fraction.to_string(),
            self.comparator_bits.to_string(),
            self.uncompute.to_string(),
            self.nearest.to_string(),
            (self.strata()).map_or_else(|| "auto".to_owned(), |strata| strata.to_string()),
        ]
    }

    /// As many strata as its estimator and its comparator have.
    fn strata(&self) -> Option<u32> {
        if self.estimator.counts_strata() {
            let most = most_strata(self.comparator_bits);
            self.strata.map(|strata| strata.min(most))
        } else {
            Some(1)
        }
    }

    /// The scene's parameters with these values.
    pub(super) fn parameters(&self, scene: &Parameters) -> Parameters {
        let mut parameters = scene.clone();
        parameters.sampling = self.sampling(&scene.sampling);
        parameters.precision.fraction = Some(self.fraction);
        parameters.comparator.bits = self.comparator_bits;
        parameters.counting = Counting {
            phase_bits: self.phase_bits,
            repetitions: self.repetitions,
            estimator: self.estimator,
            strata: self.strata(),
            // All others use their queries.
            error: (scene.counting.error).filter(|_| self.sweep == Sweep::Scene),
            ..scene.counting
        };
        parameters.circuit.uncompute = self.uncompute;
        parameters.circuit.nearest = self.nearest;
        parameters
    }

    fn sampling(&self, scene: &Sampling) -> Sampling {
        let depths = depths(scene, self.depths);
        match self.sequence {
            Sequence::DigitalNet => Sampling {
                sequence: self.sequence,
                path_bits: self.path_bits,
                depths,
                lights: scene.lights,
            },
            // The scene's own distribution of its bits, or an even one of others.
            Sequence::ProductLattice
                if scene.sequence == self.sequence
                    && scene.path_bits == self.path_bits
                    && scene.depths.len() == self.depths =>
            {
                scene.clone()
            }
            Sequence::ProductLattice => {
                let mut lattice = Sampling {
                    sequence: self.sequence,
                    path_bits: self.path_bits,
                    depths,
                    lights: scene.lights,
                };
                even(&mut lattice);
                lattice
            }
        }
    }
}

/// Bits of a coordinate where the scene's are those of a lattice, or where it has none.
pub(super) const FINE: u32 = 16;

/// Coordinates of a net: the scene's own, or fine ones where the scene has a lattice; paths beyond
/// the scene's length go on as its last ray does.
pub(super) fn depths(scene: &Sampling, count: usize) -> Vec<DepthSampling> {
    let last = scene.depths.last().cloned();
    let more = std::iter::repeat_n(last, count.saturating_sub(scene.depths.len())).flatten();
    let all = scene.depths.iter().cloned().chain(more).take(count);
    let mut depths: Vec<DepthSampling> = all.collect();
    if scene.sequence == Sequence::ProductLattice {
        for depth in &mut depths {
            depth.bits = [FINE; 2];
        }
    }
    // The primary ray has no map, but the ray after it may be its repetition.
    if let Some(first) = depths.first_mut() {
        first.map = Map::Auto;
    }
    depths
}

/// A lattice of so many bits, the first dimensions first.
fn even(lattice: &mut Sampling) {
    let squares: Vec<_> = lattice.squares().collect();
    let (bits, coordinates) = (lattice.path_bits, 2 * squares.len() as u32);
    let of = |k: u32| bits / coordinates + u32::from(k < bits % coordinates);
    for (k, (depth, square, _)) in (0..coordinates).step_by(2).zip(squares) {
        let bits = [of(k), of(k + 1)];
        match square {
            Square::Ray => lattice.depths[depth].bits = bits,
            Square::Light => lattice.depths[depth].light = Some(bits),
        }
    }
}
