//! A row's setting: one value of every parameter.

use qrt_core::oracle::DEFAULT_FRACTION;
use qrt_runtime::models::Model;
use qrt_runtime::named;
use qrt_scene::sampling::Square;
use qrt_scene::valid::Parameters;
use qrt_scene::{
    Comparator, Counting, DepthSampling, Estimator, Map, Nearest, Sampling, Sequence, Uncompute,
};

named! {
    /// The parameter that a row is about.
    pub enum Sweep {
        /// The scene as it is.
        Scene = "scene",
        /// Every estimator with registers of every size.
        Counting = "counting",
        /// Repetitions of a smaller register.
        Repetitions = "repetitions",
        /// The number of strata of the comparator that are counted on their own.
        Strata = "strata",
        /// The number of comparators.
        Comparator = "comparator",
        /// The width of numbers.
        Fraction = "fraction",
        /// Paths of either sequence.
        Paths = "paths",
        /// The rules for uncomputing registers and for keeping the nearest hit.
        Circuit = "circuit",
        /// The model that traces the paths.
        Model = "model",
        /// The length of paths.
        Depth = "depth",
        /// The scene's estimator on the pixels of the comparison with rivals.
        BesideRivals = "beside-rivals",
        /// A rival of counting: the mean of random paths.
        RandomPaths = "random-paths",
        /// A rival of counting: the mean of all paths of a smaller net.
        ClassicalNet = "classical-net",
    }
}

impl Sweep {
    /// True if the sweep's rows are pictures without a circuit.
    pub(crate) fn is_rival(self) -> bool {
        matches!(self, Self::RandomPaths | Self::ClassicalNet)
    }

    /// True if the sweep's errors are those of pixels that see no lamp, if there are any.
    pub(super) fn leaves_lamps_out(self) -> bool {
        self == Self::BesideRivals || self.is_rival()
    }
}

/// One value of every parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setting {
    /// The parameter that the row is about.
    pub sweep: Sweep,
    /// The model that traces the paths.
    pub model: Model,
    /// The estimator that counts good indices.
    pub estimator: Estimator,
    /// t, of T = 2^t phases.
    pub phase_bits: u32,
    /// B, the number of runs of the counting circuit.
    pub repetitions: u32,
    /// Number of strata of the comparator that are counted on their own. With `None`, the first
    /// measurements determine it.
    pub strata: Option<u32>,
    /// The sequence that turns path indices into points.
    pub sequence: Sequence,
    /// R = 2^path_bits.
    pub path_bits: u32,
    /// D, the rays of a path.
    pub depths: usize,
    /// Number of fraction bits of every number.
    pub fraction: u32,
    /// C = 2^comparator_bits.
    pub comparator_bits: u32,
    /// The rule for uncomputing registers.
    pub uncompute: Uncompute,
    /// The rule for keeping the nearest hit.
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
    /// The scene's own parameters, on the fixed machine: the circuit's own numbers.
    pub(super) fn from_parameters(parameters: &Parameters) -> Self {
        Self {
            sweep: Sweep::Scene,
            model: Model::Fixed,
            estimator: parameters.counting.estimator(),
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

    /// The values of the setting, in the order of the first columns of `trade.csv`: `sweep` (the
    /// parameter that the row is about), `model`, `estimator`, `phase_bits`, `repetitions`,
    /// `sequence`, `path_bits`, `depths`, `fraction`, `comparator_bits`, `uncompute`, `nearest`,
    /// `strata`.
    pub fn values(&self) -> [String; KEY.len()] {
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
            number_or_auto(self.strata()),
        ]
    }

    /// The keys of the scene's YAML that a setting decides, with their values.
    pub(super) fn keys(&self) -> [(&'static str, String); 10] {
        [
            ("counting.estimator", self.estimator.to_string()),
            ("counting.phase_bits", self.phase_bits.to_string()),
            ("counting.repetitions", self.repetitions.to_string()),
            ("counting.strata", number_or_auto(self.strata)),
            ("sampling.sequence", self.sequence.to_string()),
            ("sampling.path_bits", self.path_bits.to_string()),
            ("precision.fraction", self.fraction.to_string()),
            ("comparator.bits", self.comparator_bits.to_string()),
            ("circuit.uncompute", self.uncompute.to_string()),
            ("circuit.nearest", self.nearest.to_string()),
        ]
    }

    /// The values that `sweep` changes, as text.
    pub(super) fn swept(&self, sweep: Sweep) -> String {
        let Self {
            estimator,
            phase_bits,
            repetitions,
            ..
        } = self;
        match sweep {
            Sweep::Scene => "as it is".to_owned(),
            Sweep::Counting | Sweep::BesideRivals => format!("{estimator} t={phase_bits}"),
            Sweep::Repetitions => format!("{estimator} t={phase_bits} B={repetitions}"),
            Sweep::Strata => number_or_auto(self.strata),
            Sweep::Comparator => format!("{} bits", self.comparator_bits),
            Sweep::Fraction => format!("{} bits", self.fraction),
            Sweep::Paths => format!("{} 2^{}", self.sequence, self.path_bits),
            Sweep::Circuit => format!("uncompute: {}, nearest: {}", self.uncompute, self.nearest),
            Sweep::Model => self.model.name().to_owned(),
            Sweep::Depth => format!("{} rays", self.depths),
            Sweep::RandomPaths | Sweep::ClassicalNet => format!("2^{} paths", self.path_bits),
        }
    }

    /// The setting as text, without its sweep, model and number of depths.
    pub(super) fn described(&self) -> String {
        format!(
            "{} t={} B={}{}, {} 2^{} paths, {} comparator bits, {} fraction bits, uncompute: {}, nearest: {}",
            self.estimator,
            self.phase_bits,
            self.repetitions,
            match self.strata {
                Some(strata @ 2..) => format!(" {strata} strata"),
                _ => String::new(),
            },
            self.sequence,
            self.path_bits,
            self.comparator_bits,
            self.fraction,
            self.uncompute,
            self.nearest,
        )
    }

    /// Maximum number of strata of the setting's comparator.
    pub(super) fn most_strata(&self) -> u32 {
        let comparator = Comparator {
            bits: self.comparator_bits,
            ..Comparator::default()
        };
        comparator.most_strata()
    }

    /// Number of strata, limited by the estimator and the comparator.
    fn strata(&self) -> Option<u32> {
        if self.estimator.counts_strata() {
            let most = self.most_strata();
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
            estimator: Some(self.estimator),
            strata: self.strata(),
            // All other rows use up their queries.
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
            // A lattice of the scene's own size has the scene's distribution of bits; others an
            // even one.
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

/// A number, or `auto` for a number that the estimator chooses.
fn number_or_auto(number: Option<u32>) -> String {
    number.map_or_else(|| "auto".to_owned(), |number| number.to_string())
}

/// Number of bits of a coordinate, if the scene has a lattice or lacks the coordinate.
pub(super) const FINE: u32 = 16;

/// Coordinates of a net with `count` rays.
///
/// They are the scene's own, or fine ones if the scene has a lattice. Rays beyond the scene's
/// length repeat its last ray.
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
    for depth in depths.iter_mut().skip(1) {
        depth.lens = None;
    }
    // The primary ray has no map, but the ray after it may be its repetition.
    if let Some(first) = depths.first_mut() {
        first.map = Map::Auto;
    }
    depths
}

/// Distributes the bits of `lattice` evenly over its dimensions, the rest over the first ones.
fn even(lattice: &mut Sampling) {
    let squares: Vec<_> = lattice.squares().collect();
    let (bits, coordinates) = (lattice.path_bits, 2 * squares.len() as u32);
    let of = |k: u32| bits / coordinates + u32::from(k < bits % coordinates);
    for (k, (depth, square, _)) in (0..coordinates).step_by(2).zip(squares) {
        let bits = [of(k), of(k + 1)];
        match square {
            Square::Ray => lattice.depths[depth].bits = bits,
            Square::Light if depth == 0 => lattice.depths[0].lens = Some(bits),
            Square::Light => lattice.depths[depth].light = bits.into(),
        }
    }
}
