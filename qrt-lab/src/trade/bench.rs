//! Measurements on the sample of pixels, each made once.

use super::band::Band;
use super::error::{TradeError, first};
use super::setting::Setting;
use super::table::Row;
use qrt_core::oracle::{CallCost, Oracles};
use qrt_counting::estimators::Noise;
use qrt_counting::{Comparators, LevelCounts};
use qrt_runtime::memory::{CircuitSize, CircuitWork, Memory};
use qrt_runtime::models::{MachineOptions, Model, path_machines};
use qrt_runtime::path_machines::Real;
use qrt_runtime::sample::{self, Countable, Draws, Means, PixelEstimates, Tally, tallies};
use qrt_runtime::workers::Workers;
use qrt_scene::valid::{Parameters, ValidScene};
use qrt_scene::{Circuit, Comparator, Estimator, Sampling};
use std::borrow::Cow;
use std::sync::Arc;
use std::time::Instant;

/// The amount of work for a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Effort {
    /// The reference has `2^reference_bits` paths.
    pub(super) reference_bits: u32,
    /// Pictures that differ in depth have `2^depth_bits` paths.
    pub(super) depth_bits: u32,
    /// Number of runs of an estimator for each channel of a pixel.
    pub(super) draws: u64,
    /// Most Toffolis of a row whose gates are run, if there is a limit.
    pub(super) most_toffoli: Option<u64>,
}

/// The data that rows have in common.
pub(super) struct Bench<'a> {
    pub(super) scene: &'a ValidScene,
    pub(super) parameters: Parameters,
    pub(super) pixels: Vec<[u32; 2]>,
    pub(super) seed: u64,
    pub(super) effort: Effort,
    pub(super) workers: Workers<'a>,
    pub(super) references: Vec<(usize, Means)>,
    pub(super) depths: Option<Vec<Means>>,
    real: Vec<((Sampling, Comparator), Traced)>,
    circuits: Vec<(CircuitKey, Built)>,
    counted: Vec<((CircuitKey, Model), Traced)>,
}

type CircuitKey = (Sampling, u32, Comparator, Circuit);

/// The result of a model.
#[derive(Clone)]
struct Traced {
    /// By pixel and channel: the mean of its paths; empty for the circuit's models.
    means: Means,
    /// By pixel and channel: S.
    good: Vec<[u64; 3]>,
    /// By pixel and channel: the levels of paths.
    levels: Vec<[LevelCounts; 3]>,
    /// The wall time, in seconds.
    seconds: f64,
}

#[derive(Clone)]
struct Built {
    oracles: Arc<Oracles<'static>>,
    cost: CallCost,
}

impl<'a> Bench<'a> {
    pub(super) fn new(
        scene: &'a ValidScene,
        seed: u64,
        effort: Effort,
        workers: Workers<'a>,
    ) -> Self {
        Self {
            parameters: scene.parameters(),
            scene,
            pixels: Vec::new(),
            seed,
            effort,
            workers,
            references: Vec::new(),
            depths: None,
            real: Vec::new(),
            circuits: Vec::new(),
            counted: Vec::new(),
        }
    }

    /// Checks that the scene as it is has a circuit, and that running its gates fits into `memory`. Returns the
    /// Toffolis of a call.
    pub(super) fn check(&mut self, memory: Memory) -> Result<u64, TradeError> {
        let parameters = Setting::from_parameters(&self.parameters).parameters(&self.parameters);
        let scene = self
            .scene
            .with_parameters(parameters.clone())
            .map_err(TradeError::Parameters)?;
        memory.keep_compiling(&scene)?;
        // For the scene's own circuit, a missing circuit is an error, so the inner result is `Ok`.
        let mut toffoli = 0;
        if let Ok(Built { oracles, cost }) = self.built(&scene, &parameters)? {
            toffoli = cost.toffoli;
            let oracle = oracles.all_channels(oracles.classes().present()[0])?;
            let work = CircuitWork::gates(self.workers.threads);
            memory.keep_circuit(&scene, &CircuitSize::new(&oracle), work)?;
        }
        Real::new(&scene, self.seed)?;
        Ok(toffoli)
    }

    /// Measures a row. The inner error is the reason why it was not measured.
    pub(super) fn row(&mut self, setting: Setting) -> Result<Result<Row, String>, TradeError> {
        if setting.sweep.is_rival() {
            return self.rival(setting).map(Ok);
        }
        let parameters = setting.parameters(&self.parameters);
        let scene = match self.scene.with_parameters(parameters.clone()) {
            Ok(scene) => scene,
            Err(problems) => return Ok(Err(first(&problems))),
        };
        let built = match self.built(&scene, &parameters)? {
            Ok(built) => built,
            Err(why) => return Ok(Err(why)),
        };
        let paths = (self.pixels.len() as u64) << parameters.sampling.path_bits;
        let toffoli = built.cost.toffoli.saturating_mul(paths);
        if setting.model == Model::Gates
            && self.effort.most_toffoli.is_some_and(|most| toffoli > most)
        {
            return Ok(Err(format!(
                "its gates take long, {toffoli} Toffolis, and count what `fixed` counts; a measurement that is not quick runs them"
            )));
        }
        let kept = self.kept(setting)?;
        let own = self.reference(self.parameters.sampling.depths.len())?;
        let mean = sample::radiance(&picked(own, &kept));
        if mean <= 0.0 {
            return Err(TradeError::Black);
        }
        let truth = self.reference(setting.depths)?.clone();
        let real = self.real(&scene, &parameters)?;
        let counted = match setting.model {
            Model::Real => real.clone(),
            model => self.counted(&parameters, &built, model)?,
        };
        let bounds = self.bounds(&scene)?;
        let ids = (1_u64 << parameters.sampling.path_bits) << parameters.comparator.bits;
        let value = |(good, bound): (&[u64; 3], &[f64; 3])| {
            std::array::from_fn(|c| bound[c] * (good[c] as f64 / ids as f64))
        };
        let [in_real, in_model]: [Means; 2] =
            [&real.good, &counted.good].map(|good| good.iter().zip(&bounds).map(value).collect());
        let mut estimated = self.estimated(&parameters, &bounds, &counted, ids)?;
        let [real_means, in_real, in_model, truth] =
            [&real.means, &in_real, &in_model, &truth].map(|means| picked(means, &kept));
        estimated.values = picked(&estimated.values, &kept);
        let drawn = drawn(&estimated, &in_model, &truth, mean);
        let pixels = self.pixels.len() as f64;
        let depth = self.depth_error(setting.depths, mean)?;
        Ok(Ok(Row {
            setting,
            queries: estimated.queries as f64 / pixels / self.effort.draws as f64,
            cost: built.cost,
            mean,
            errors: [
                Band::of_difference(&real_means, &truth, mean),
                Band::of_difference(&in_real, &real_means, mean),
                Band::of_difference(&in_model, &in_real, mean),
                drawn[0],
                depth,
                drawn[1],
            ],
            seconds: (counted.seconds + estimated.seconds / self.effort.draws as f64) / pixels,
        }))
    }

    fn real(&mut self, scene: &ValidScene, parameters: &Parameters) -> Result<Traced, TradeError> {
        let key = (parameters.sampling.clone(), parameters.comparator);
        if let Some((_, found)) = self.real.iter().find(|(of, _)| *of == key) {
            return Ok(found.clone());
        }
        let start = Instant::now();
        let paths = 1 << parameters.sampling.path_bits;
        let found = self.tallied(&Oracles::new(scene), parameters, Model::Real)?;
        let traced = Traced {
            means: means(&found, paths),
            good: good(&found),
            levels: levels(found),
            seconds: start.elapsed().as_secs_f64(),
        };
        self.real.push((key, traced.clone()));
        Ok(traced)
    }

    /// Sums all paths of the sampled pixels, and counts them, under a model.
    fn tallied(
        &self,
        oracles: &Oracles<'_>,
        parameters: &Parameters,
        model: Model,
    ) -> Result<Vec<Tally>, TradeError> {
        let machines = path_machines(oracles, &self.machine(model))?;
        machines.by_class.apart(&self.pixels, |machine, pixels| {
            let comparators = [Comparators::rgb(machine.bounds(), parameters.comparator)?];
            let paths = 0..machine.paths();
            Ok(tallies(
                &**machine,
                pixels,
                paths,
                &comparators,
                &self.workers,
            )?)
        })
    }

    fn machine(&self, model: Model) -> MachineOptions<'static> {
        MachineOptions {
            model,
            seed: self.seed,
            ..MachineOptions::default()
        }
    }

    /// The bound of a path's colour, by pixel.
    fn bounds(&self, scene: &ValidScene) -> Result<Vec<[f64; 3]>, TradeError> {
        let real = path_machines(&Oracles::new(scene), &self.machine(Model::Real))?;
        let machines = real.by_class;
        let pixels = self.pixels.iter();
        Ok(pixels.map(|&pixel| machines.at(pixel).bounds()).collect())
    }

    fn built(
        &mut self,
        scene: &ValidScene,
        parameters: &Parameters,
    ) -> Result<Result<Built, String>, TradeError> {
        let key = circuit_key(parameters);
        if let Some((_, found)) = self.circuits.iter().find(|(of, _)| *of == key) {
            return Ok(Ok(found.clone()));
        }
        let own = Setting::from_parameters(&self.parameters).parameters(&self.parameters);
        let oracles = Oracles::of_scene(Cow::Owned(scene.clone()));
        let most = match oracles.most_expensive() {
            Ok(most) => most,
            // A row without a circuit is left out; a scene without one has no table.
            Err(why) if circuit_key(&own) != key => return Ok(Err(why.to_string())),
            Err(error) => return Err(error.into()),
        };
        // Machines run the oracles of all channels. They are assembled from the same recordings as
        // those whose cost was counted.
        oracles.assemble_all_channels()?;
        let built = Built {
            oracles: Arc::new(oracles),
            cost: most.call,
        };
        // A circuit is large, and the rows of a circuit are consecutive, except those of the
        // scene's own. The cache therefore keeps only that one and the latest.
        self.circuits.retain(|(of, _)| *of == circuit_key(&own));
        self.circuits.push((key, built.clone()));
        Ok(Ok(built))
    }

    fn counted(
        &mut self,
        parameters: &Parameters,
        built: &Built,
        model: Model,
    ) -> Result<Traced, TradeError> {
        let key = (circuit_key(parameters), model);
        if let Some((_, found)) = self.counted.iter().find(|(of, _)| *of == key) {
            return Ok(found.clone());
        }
        let start = Instant::now();
        let found = self.tallied(&built.oracles, parameters, model)?;
        let traced = Traced {
            means: Means::new(),
            good: good(&found),
            levels: levels(found),
            seconds: start.elapsed().as_secs_f64(),
        };
        self.counted.push((key, traced.clone()));
        Ok(traced)
    }

    /// The estimates of every channel of every pixel, several times.
    fn estimated(
        &self,
        parameters: &Parameters,
        bounds: &[[f64; 3]],
        traced: &Traced,
        total: u64,
    ) -> Result<Estimated, TradeError> {
        let start = Instant::now();
        let by_level = parameters.counting.reads_levels();
        let draws = Draws {
            counting: &parameters.counting,
            scales: bounds,
            noise: Noise::NONE,
            // With this seed, the first draw is that of the rendered picture.
            seed: self.seed,
            count: self.effort.draws,
            total,
        };
        let countable = if by_level {
            Countable::Levels(&traced.levels)
        } else {
            Countable::Whole(&traced.good)
        };
        let found = draws.draw(&self.pixels, &countable)?;
        let exact = parameters.counting.estimator() == Estimator::Exact;
        let queries: u64 = found.iter().flat_map(|drawn| drawn.queries).sum();
        let values = |(drawn, bound): (PixelEstimates, &[f64; 3])| {
            let value = |of: &[f64; 3]| std::array::from_fn(|c| bound[c] * of[c]);
            drawn.amplitudes.iter().map(value).collect()
        };
        Ok(Estimated {
            values: found.into_iter().zip(bounds).map(values).collect(),
            queries: if exact { 0 } else { queries },
            seconds: start.elapsed().as_secs_f64(),
        })
    }
}

/// The entries of `all` at the indices `kept`.
pub(super) fn picked<T: Clone>(all: &[T], kept: &[usize]) -> Vec<T> {
    kept.iter().map(|&at| all[at].clone()).collect()
}

struct Estimated {
    /// By pixel, draw and channel, in radiance.
    values: Vec<Vec<[f64; 3]>>,
    /// Number of queries of all pixels, draws and channels.
    queries: u64,
    seconds: f64,
}

fn circuit_key(parameters: &Parameters) -> CircuitKey {
    let fraction = parameters.precision.fraction.unwrap_or_default();
    let sampling = parameters.sampling.clone();
    (
        sampling,
        fraction,
        parameters.comparator,
        parameters.circuit,
    )
}

fn means(tallies: &[Tally], paths: u64) -> Means {
    let mean = |tally: &Tally| tally.colour.map(|sum| sum / paths as f64);
    tallies.iter().map(mean).collect()
}

fn levels(tallies: Vec<Tally>) -> Vec<[LevelCounts; 3]> {
    tallies.into_iter().map(|tally| tally.levels).collect()
}

fn good(tallies: &[Tally]) -> Vec<[u64; 3]> {
    let good = |tally: &Tally| tally.good.first().copied().unwrap_or_default();
    tallies.iter().map(good).collect()
}

/// E_T and the total error: the differences of all draws from S/N and from the limit.
fn drawn(estimated: &Estimated, counted: &Means, truth: &Means, mean: f64) -> [Band; 2] {
    [counted, truth].map(|other| {
        let square = |(values, other): (&Vec<[f64; 3]>, &[f64; 3])| {
            let pairs = values.iter().flat_map(|value| value.iter().zip(other));
            let sum: f64 = pairs.map(|(a, b)| ((a - b) / mean).powi(2)).sum();
            sum / (3 * values.len()).max(1) as f64
        };
        let pairs = estimated.values.iter().zip(other);
        Band::of_squares(&pairs.map(square).collect::<Vec<_>>())
    })
}
