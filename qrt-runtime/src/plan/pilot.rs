//! Measures the errors on a sample of pixels, part by part.

use super::{PlanError, PlanOptions};
use crate::models::{MachineOptions, Machines, Model, path_machines};
use crate::path_machines::{PathMachine, Real};
use crate::sample::{Means, Tally, prefix_means, radiance, spread, tallies};
use crate::workers::Workers;
use qrt_circuit::quantum::MAX_LEVEL_BITS;
use qrt_core::oracle::{CallCost, Oracles};
use qrt_counting::estimators::Noise;
use qrt_counting::{Comparators, CountingError, LevelCounts};
use qrt_scene::sampling::MAX_PATH_BITS;
use qrt_scene::valid::{Parameters, ValidScene};
use qrt_scene::{Accuracy, Comparator, Estimator, Sequence};
use qrt_tracer::ByClass;
use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::sync::Mutex;

/// Path bits beyond which errors are extrapolated.
pub const MOST_TRIED: u32 = 18;
/// Path bits of the smallest net that is tried.
pub(super) const FEWEST: u32 = 4;
/// Path bits on which comparators and widths are tried.
pub(super) const COMPARED: u32 = 11;
/// The mean radiance is taken over at most this number of pixels, and with this number of path
/// bits.
const MEAN: (u64, u32) = (1 << 12, 8);
/// Keys of the shifts of the two nets, and of a third net as the reference for a lattice.
pub(super) const SHIFTS: [u64; 3] = [0x706c_616e_2041, 0x706c_616e_2042, 0x706c_616e_2043];
/// Comparator bits that are tried.
const COMPARATORS: std::ops::RangeInclusive<u32> = 2..=26;
/// The largest fraction of the error that comparators may take.
const COMPARATORS_SHARE: f64 = 0.05;

/// An error of every sampled channel, in units of the mean radiance.
pub(super) type Errors = Vec<[f64; 3]>;

/// The errors of an estimator, by run, and its queries of a pixel, by channel.
pub(super) type Runs = (Vec<Errors>, [f64; 3]);

/// Runs by phase bits, repetitions, and the bits of the error at which the estimator stops.
type Known = BTreeMap<(u32, u32, Option<u64>), Runs>;

/// A sample of pixels, and the errors measured on it.
pub(super) struct Pilot<'a> {
    pub(super) scene: &'a ValidScene,
    pub(super) accuracy: Accuracy,
    pub(super) estimator: Estimator,
    pub(super) noise: Noise,
    /// The picture's mean radiance.
    pub(super) mean: f64,
    pub(super) pixels: Vec<[u32; 2]>,
    /// Number of runs of an estimator, for every channel and each sign of the paths' error.
    pub(super) draws: u64,
    /// The upper bound of a path's colour, by class of pixels.
    bound_of: ByClass<[f64; 3]>,
    /// The upper bound of a path's colour, by pixel and channel.
    pub(super) bounds: Vec<[f64; 3]>,
    pub(super) comparator_bits: u32,
    /// The errors of the chosen number of comparators.
    pub(super) comparator_errors: Errors,
    /// The best known value of every channel.
    pub(super) values: Means,
    /// The levels of the paths of a smaller net; empty if the estimator reads their sum alone.
    pub(super) levels: Vec<[LevelCounts; 3]>,
    /// The errors of paths by path bits, from [`FEWEST`] on; for a lattice, the only entry is its
    /// own.
    nets: Vec<Errors>,
    /// The errors of estimators tried so far. Counting is tried only if the error of paths alone is
    /// small enough, and then more paths hardly change [`Self::values`], and with them these
    /// errors.
    pub(super) counted: Mutex<Known>,
    workers: Workers<'a>,
}

impl<'a> Pilot<'a> {
    pub(super) fn new(
        scene: &'a ValidScene,
        accuracy: Accuracy,
        estimator: Estimator,
        options: &PlanOptions<'a>,
    ) -> Result<Self, PlanError> {
        let film = [scene.scene().film.width, scene.scene().film.height];
        let failing = 1.0 - accuracy.confidence;
        let pixels = spread(film, (12.0 / failing).clamp(256.0, 4096.0) as u64);
        let draws = (20.0 / failing / pixels.len() as f64)
            .ceil()
            .clamp(4.0, 64.0) as u64;
        if (draws * pixels.len() as u64) as f64 * failing < 3.0 {
            return Err(unreachable(format!(
                "{} tries on each of {} pixels cannot show that at most a fraction of {failing:.1e} fails",
                draws,
                pixels.len()
            )));
        }
        let workers = options.workers;
        let bound = |machine: Box<dyn PathMachine>| Ok::<_, PlanError>(machine.bounds());
        let bound_of = real(&of_bits(scene, MEAN.1)?, 0)?.by_class.try_map(bound)?;
        let bounds: Vec<[f64; 3]> = pixels.iter().map(|&pixel| *bound_of.at(pixel)).collect();
        let mean_of = |key: u64| {
            let machine = Real::new(&net(scene, MEAN.1)?, key)?;
            let means = prefix_means(&machine, &spread(film, MEAN.0), &[MEAN.1], &workers)?;
            Ok::<f64, PlanError>(means.first().map_or(0.0, |means| radiance(means)))
        };
        let mean = 0.5 * (mean_of(SHIFTS[0])? + mean_of(SHIFTS[1])?);
        if mean <= 0.0 && bounds.iter().any(|bound| *bound != [0.0; 3]) {
            let why = "every pixel that was tried is black, and errors are relative to the mean";
            return Err(unreachable(why.to_owned()));
        }
        let mut pilot = Self {
            scene,
            accuracy,
            estimator,
            noise: options.noise,
            mean,
            pixels,
            draws,
            bound_of,
            bounds,
            comparator_bits: 0,
            comparator_errors: Vec::new(),
            values: Vec::new(),
            levels: Vec::new(),
            nets: Vec::new(),
            counted: Mutex::new(BTreeMap::new()),
            workers,
        };
        pilot.choose_comparators()?;
        if pilot.is_lattice() {
            pilot.compare_lattice()?;
        }
        Ok(pilot)
    }

    /// Returns whether the scene's path bits follow from those of its coordinates.
    pub(super) fn is_lattice(&self) -> bool {
        self.scene.scene().sampling.sequence == Sequence::ProductLattice
    }

    fn relative(&self, a: &Means, b: &Means, factor: f64) -> Errors {
        let factor = factor / self.mean;
        let differences =
            |(a, b): (&[f64; 3], &[f64; 3])| std::array::from_fn(|c| factor * (a[c] - b[c]));
        a.iter().zip(b).map(differences).collect()
    }

    /// The means of the sampled pixels over the first `2^k` paths, for each k of `bits`.
    fn means(&self, scene: &ValidScene, seed: u64, bits: &[u32]) -> Result<Vec<Means>, PlanError> {
        let real = Real::new(scene, seed)?;
        Ok(prefix_means(&real, &self.pixels, bits, &self.workers)?)
    }

    /// The error of `2^bits` paths, and true if it is an extrapolation.
    pub(super) fn paths(&mut self, bits: u32) -> Result<(Errors, bool), PlanError> {
        if self.is_lattice() {
            return Ok((self.nets[0].clone(), false));
        }
        let tried = bits.min(MOST_TRIED);
        let have = FEWEST + self.nets.len() as u32;
        if tried >= have {
            let all: Vec<u32> = (FEWEST..=tried).collect();
            let scene = net(self.scene, tried)?;
            let [a, b] = [SHIFTS[0], SHIFTS[1]].map(|key| self.means(&scene, key, &all));
            let (a, b) = (a?, b?);
            let pairs = a.iter().zip(&b);
            self.nets = pairs
                .map(|(a, b)| self.relative(a, b, std::f64::consts::FRAC_1_SQRT_2))
                .collect();
            if let (Some(a), Some(b)) = (a.last(), b.last()) {
                let middle =
                    |(a, b): (&[f64; 3], &[f64; 3])| std::array::from_fn(|c| 0.5 * (a[c] + b[c]));
                self.values = a.iter().zip(b).map(middle).collect();
            }
        }
        let errors = self.nets[(tried - FEWEST) as usize].clone();
        if bits <= tried {
            return Ok((errors, false));
        }
        let shrink = libm::exp2(self.slope() * f64::from(bits - tried));
        let scaled = errors.into_iter().map(|e| e.map(|e| e * shrink)).collect();
        Ok((scaled, true))
    }

    /// The slope of log2 of the error over path bits, fitted to the last six nets. The upper end of
    /// the fit's band is taken, so that the error is not extrapolated to fall too fast.
    fn slope(&self) -> f64 {
        let root = |errors: &Errors| {
            let sum: f64 = errors.iter().flatten().map(|e| e * e).sum();
            libm::log10(sum.sqrt())
        };
        let last = self.nets.iter().rev().take(6).rev();
        let points = (0..)
            .zip(last)
            .map(|(k, errors)| (f64::from(k) * std::f64::consts::LOG10_2, root(errors)));
        let fit = qrt_drawing::Fit::from_points(points.filter(|p| p.1.is_finite()));
        fit.map_or(0.0, |fit| (fit.slope + fit.slope_band).clamp(-1.0, 0.0))
    }

    fn compare_lattice(&mut self) -> Result<(), PlanError> {
        let own = of_bits(self.scene, 0)?;
        let bits = own.scene().sampling.path_bits;
        let means = self.means(&own, 0, &[bits])?;
        let limit_bits = (bits + 4).min(MOST_TRIED).max(bits);
        let limits = self.means(&net(self.scene, limit_bits)?, SHIFTS[2], &[limit_bits])?;
        self.nets = vec![self.relative(&means[0], &limits[0], 1.0)];
        self.values.clone_from(&means[0]);
        Ok(())
    }

    fn choose_comparators(&mut self) -> Result<(), PlanError> {
        let paths = 1_u64 << COMPARED;
        let found = self.tallied(COMPARATORS)?;
        let means: Means = found
            .iter()
            .map(|tally| tally.colour.map(|sum| sum / paths as f64))
            .collect();
        // A table of phases has no more address bits.
        let most = match self.estimator {
            Estimator::PhaseMean => MAX_LEVEL_BITS,
            _ => *COMPARATORS.end(),
        };
        for (number, bits) in COMPARATORS.enumerate() {
            let ids = (paths << bits) as f64;
            let counted: Means = found
                .iter()
                .zip(&self.bounds)
                .map(|(tally, bound)| {
                    std::array::from_fn(|c| bound[c] * (tally.good[number][c] as f64 / ids))
                })
                .collect();
            self.comparator_errors = if self.mean > 0.0 {
                self.relative(&counted, &means, 1.0)
            } else {
                vec![[0.0; 3]; counted.len()]
            };
            self.comparator_bits = bits;
            let error = quantile(&self.comparator_errors, self.accuracy.confidence);
            if bits == most || error <= COMPARATORS_SHARE * self.accuracy.error {
                break;
            }
        }
        self.values = means;
        if self.estimator.reads_colours() {
            let chosen = self.comparator_bits;
            let found = self.tallied(chosen..=chosen)?;
            self.levels = found.into_iter().map(|tally| tally.levels).collect();
        }
        Ok(())
    }

    /// Counts the paths of the net with which comparators are chosen, for each number of comparator
    /// bits in `bits`.
    fn tallied(&self, bits: RangeInclusive<u32>) -> Result<Vec<Tally>, PlanError> {
        let net = net(self.scene, COMPARED)?;
        let machines = real(&net, SHIFTS[0])?.by_class;
        machines.apart(&self.pixels, |machine, pixels| {
            let comparators = bits.clone().map(|bits| self.comparators(pixels[0], bits));
            let comparators: Vec<_> = comparators.collect::<Result<_, _>>()?;
            let ids = 0..1 << COMPARED;
            Ok(tallies(
                &**machine,
                pixels,
                ids,
                &comparators,
                &self.workers,
            )?)
        })
    }

    /// The comparators of pixels of the same class as `pixel`.
    fn comparators(&self, pixel: [u32; 2], bits: u32) -> Result<[Comparators; 3], CountingError> {
        let comparator = Comparator {
            bits,
            ..Comparator::default()
        };
        Comparators::rgb(*self.bound_of.at(pixel), comparator)
    }

    /// The error of numbers with `fraction` fraction bits, and the cost of a call with
    /// `2^path_bits` paths; `None` if there is no circuit.
    pub(super) fn width(
        &self,
        path_bits: u32,
        fraction: u32,
    ) -> Result<Option<(Errors, CallCost)>, PlanError> {
        let mut parameters = net_parameters(self.scene, path_bits);
        if self.is_lattice() {
            parameters = self.scene.parameters();
        }
        parameters.precision.fraction = Some(fraction);
        parameters.comparator.bits = self.comparator_bits;
        let scene = valid(self.scene, parameters)?;
        let oracles = Oracles::new(&scene);
        let Ok(most) = oracles.most_expensive() else {
            return Ok(None);
        };
        let options = MachineOptions {
            model: Model::Fixed,
            seed: SHIFTS[0],
            ..MachineOptions::default()
        };
        if oracles.assemble_all_channels().is_err() {
            return Ok(None);
        }
        let fixed = path_machines(&oracles, &options)?.by_class;
        let own = real(&scene, SHIFTS[0])?.by_class;
        let found = fixed.apart(&self.pixels, |machine, pixels| {
            let paths = machine.paths().min(1 << COMPARED);
            let own = &**own.at(pixels[0]);
            let comparators = [self.comparators(pixels[0], self.comparator_bits)?];
            let in_real = tallies(own, pixels, 0..paths, &comparators, &self.workers)?;
            let in_fixed = tallies(&**machine, pixels, 0..paths, &comparators, &self.workers)?;
            let ids = (paths << self.comparator_bits) as f64;
            let bound = *self.bound_of.at(pixels[0]);
            let value = |tally: &Tally| -> [f64; 3] {
                std::array::from_fn(|c| bound[c] * (tally.good[0][c] as f64 / ids))
            };
            let pairs = in_fixed.iter().zip(&in_real);
            let values = pairs.map(|(a, b)| (value(a), value(b)));
            Ok::<_, PlanError>(values.collect::<Vec<_>>())
        })?;
        let (a, b): (Means, Means) = found.into_iter().unzip();
        Ok(Some((self.relative(&a, &b, 1.0), most.call)))
    }
}

/// The machines in floating point.
fn real(scene: &ValidScene, seed: u64) -> Result<Machines, PlanError> {
    let options = MachineOptions {
        seed,
        ..MachineOptions::default()
    };
    Ok(path_machines(&Oracles::new(scene), &options)?)
}

/// The `level` quantile of the absolute errors.
pub(super) fn quantile(errors: &[[f64; 3]], level: f64) -> f64 {
    let mut sizes: Vec<f64> = errors.iter().flatten().map(|e| e.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let at = (level * sizes.len() as f64).ceil() as usize;
    sizes
        .get(at.clamp(1, sizes.len().max(1)) - 1)
        .copied()
        .unwrap_or(0.0)
}

pub(super) fn unreachable(why: String) -> PlanError {
    PlanError::Unreachable(why)
}

/// The scene's parameters with a digital net of `2^bits` paths.
fn net_parameters(scene: &ValidScene, bits: u32) -> Parameters {
    let mut parameters = scene.parameters();
    if parameters.sampling.sequence == Sequence::ProductLattice {
        parameters.sampling.sequence = Sequence::DigitalNet;
        for depth in &mut parameters.sampling.depths {
            depth.bits = [16; 2];
        }
    }
    parameters.sampling.path_bits = bits.min(MAX_PATH_BITS);
    parameters
}

fn net(scene: &ValidScene, bits: u32) -> Result<ValidScene, PlanError> {
    valid(scene, net_parameters(scene, bits))
}

/// The scene with its own sequence; a net gets `2^bits` paths.
fn of_bits(scene: &ValidScene, bits: u32) -> Result<ValidScene, PlanError> {
    let mut parameters = scene.parameters();
    if parameters.sampling.sequence == Sequence::DigitalNet {
        parameters.sampling.path_bits = bits;
    }
    valid(scene, parameters)
}

pub(super) fn valid(scene: &ValidScene, parameters: Parameters) -> Result<ValidScene, PlanError> {
    scene.with_parameters(parameters).map_err(|problems| {
        let first = problems.into_iter().next();
        unreachable(first.map_or_else(String::new, |problem| problem.description().message))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use qrt_scene::front::parse;

    /// A wall that a lamp behind the camera lights, and another lamp before it, on the right of the film:
    /// some pixels may see that one, and others see none.
    const HALF: &str = "
name: half
camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 2 } }
film: { width: 4, height: 2 }
materials:
  wall: { lambertian: { albedo: [0.5, 0.25, 0.125] } }
  lamp: { emitter: { radiance: [1, 1, 1] } }
geometry:
  - quad: { vertices: [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], material: wall }
  - quad: { vertices: [[1, -1, 0.5], [3, -1, 0.5], [3, 1, 0.5], [1, 1, 0.5]], material: lamp }
  - quad: { vertices: [[-1, -1, 3], [-1, 1, 3], [1, 1, 3], [1, -1, 3]], material: lamp }
sampling: { depths: [{ bits: [2, 2] }, { bits: [2, 2], light: [2, 2] }] }
accuracy: { error: 0.2, confidence: 0.8 }
";

    #[test]
    fn each_width_that_is_tried_is_compiled_once_for_each_class() {
        let scene = parse(HALF, "half.yaml", &[], "".as_ref()).unwrap().valid;
        let accuracy = scene.scene().accuracy.unwrap();
        let options = PlanOptions::default();
        let pilot = Pilot::new(&scene, accuracy, Estimator::Sine, &options).unwrap();
        assert_eq!(scene.recordings(), 0);
        for tried in 1..3 {
            assert!(pilot.width(4, 8 + tried).unwrap().is_some());
            assert_eq!(scene.recordings(), 2 * u64::from(tried));
        }
    }
}
