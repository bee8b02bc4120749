//! Renders a scene: traces every path of every pixel, and counts or sums their colours.
//!
//! The machine traces all R paths of a pixel. Under the estimator `exact`, the pixel is their mean,
//!
//! ```text
//! pixel = 1/R sum_id colour_id            real
//! pixel = scale S/N                       fixed, gates
//! ```
//!
//! Under any other estimator, each path's colour is compared with the C comparators of its channel,
//! as the oracle does. The number S of good ones among all `N = R C` indices is counted, and the
//! estimator learns of S only what its measurements show:
//!
//! ```text
//! pixel = scale a~,      a~ an estimate of S/N
//! ```
//!
//! with `scale` the proven bound of a path's colour in that channel. A channel that is proven black
//! takes no queries.
//!
//! [`Visibility`] chooses how a path's primary hit is found: by the tracer, like all other hits, or
//! path by path with an oracle of nearest hits. The queries of that oracle are then the picture's.
//!
//! A scene with an `accuracy` is rendered with the parameters that [`crate::plan`] chooses for it.
//!
//! # Reproducibility
//!
//! A picture depends on the scene, the seed, the options that decide a pixel (model, estimator,
//! colour, noise, visibility) and the version of qrt. It does not depend on the number of threads,
//! the size of tiles, the crop, the instruction set, or on interruptions: the order of sums follows
//! from path indices, and draws are keyed by pixel and channel.
//!
//! ```
//! use qrt_scene::front::parse;
//! use qrt_runtime::render::{Options, render};
//! let text = "
//! name: sky
//! camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 1 } }
//! film: { width: 4, height: 2 }
//! materials: { sky: { emitter: { radiance: [0.25, 0.5, 1] } } }
//! geometry:
//!   - quad: { vertices: [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], material: sky }
//! counting: { estimator: exact }
//! ";
//! let scene = parse(text, "sky.yaml", &[], "".as_ref())?;
//! let rendered = render(&scene.valid, &Options::default())?;
//! assert_eq!(rendered.image.pixels, [[0.25, 0.5, 1.0]; 8]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod allowed;
mod classes;
mod error;
mod film;
mod job;
mod layers;
mod metadata;
mod one_run;
mod own;
mod parts;
mod picture_part;
mod pixel;
mod portion;
mod source;
mod stop;
mod tiles;
mod totals;
mod visibility;

pub use allowed::check_circuit;
pub use classes::Scales;
pub use error::{CompiledError, PredicateRefusal, RenderError, out_of_bounds_advice};
pub use own::{BoxedEstimator, OwnEstimator};
pub use picture_part::{Merge, MergeError, PicturePart, render_part};
pub use portion::{Portion, PortionError};
pub use visibility::{DEFAULT_FAILURE, Searched, Visibility};

use crate::checkpoint::Checkpoint;
use crate::image::{Count, Image};
use crate::memory::Memory;
use crate::named::named;
use crate::path_machines::{NativeOracle, OracleMachine, Real, Simd};
use crate::plan::{self, Figures, Plan, plan};
use crate::workers::Workers;
use classes::Classes;
use job::Job;
use pixel::Pixels;
use qrt_core::oracle::{self, Marks, Oracle, OracleError, Predicate};
use qrt_core::tracer::PixelClass;
use qrt_counting::estimators::Noise;
use qrt_scene::Estimator;
use qrt_scene::valid::{Parameters, ValidScene};
use source::Source;
use std::collections::BTreeMap;
use std::path::PathBuf;
use tiles::Tiles;

named! {
    /// The machine that traces the paths.
    #[derive(Default)]
    pub enum Model {
        /// The tracer in 64-bit floating point.
        #[default]
        Real = "real",
        /// The oracle's program, operation by operation, on integers.
        Fixed = "fixed",
        /// The oracle's circuit, gate by gate: compute, flip, uncompute.
        Gates = "gates",
    }
}

named! {
    /// The method by which a pixel gets its colour.
    #[derive(Default)]
    pub enum Colour {
        /// A run of counting for each channel, as in the paper.
        #[default]
        ThreeRuns = "three-runs",
        /// One run, of the luminance; the colour comes from the paths that it measures. It takes a
        /// third of the queries, and colours have the noise of that number of paths.
        OneRun = "one-run",
    }
}

/// Options of a render. Options that are not set follow from the scene.
#[derive(Clone, Default)]
pub struct Options<'a> {
    /// The key of the shifts of the digital net and of every draw; 0 unless set.
    pub seed: u64,
    /// The part of the film to render: x, y, width and height in pixels, from the film's top left
    /// corner; the whole film unless set.
    pub crop: Option<[u32; 4]>,
    /// The model that traces the paths.
    pub model: Model,
    /// The estimator, in place of the scene's.
    pub estimator: Option<Estimator>,
    /// A user-defined estimator, in place of all others.
    pub own_estimator: Option<OwnEstimator<'a>>,
    /// The method by which pixels get their colours.
    pub colour: Colour,
    /// Noise of the device that counts; none unless set.
    pub noise: Noise,
    /// The method that finds primary hits.
    pub visibility: Visibility,
    /// The plan of a scene with an accuracy; the render makes a plan unless set.
    pub plan: Option<&'a Plan>,
    /// The threads that do the work, and the callback for progress, in paths.
    pub workers: Workers<'a>,
    /// The memory budget. A render that would exceed it, by an estimate, is refused.
    pub memory: Memory,
    /// SIMD lanes for tracing under [`Model::Real`].
    pub simd: Simd,
    /// Width and height of the tiles in pixels; chosen by the number of paths unless set.
    pub tile: Option<[u32; 2]>,
    /// Path of the checkpoint, which keeps finished tiles until the picture is finished; no
    /// checkpoint unless set. The render does not remove the file: [`render_keeping`] returns the
    /// checkpoint, so that the caller can remove it when the picture is safe.
    pub checkpoint: Option<PathBuf>,
    /// If true, continues from the checkpoint if there is one. If false, the first finished tile
    /// replaces an existing checkpoint.
    pub resume: bool,
    /// Suppresses the note on standard error that qrt is compiled without optimisation. Without it,
    /// the first picture or count of a process that is expected to take ten seconds or more prints
    /// that note, with the lines of Cargo.toml that help. Builds that optimise `qrt-runtime`, as
    /// these lines do, print nothing.
    pub quiet: bool,
}

impl<'a> Options<'a> {
    /// Returns the options with which a scene's parameters are chosen for this picture.
    pub fn planning(&self) -> plan::Options<'a> {
        plan::Options {
            estimator: self.estimator,
            noise: self.noise,
            workers: self.workers,
        }
    }
}

/// The known estimator that stands for user-defined ones in the description of a picture: it counts
/// the comparator as a whole, and decides itself when to end.
pub const OWN_LIKE: Estimator = Estimator::MonteCarlo;

/// A picture, and a record of how it was made.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendered {
    /// The name of the scene.
    pub scene_name: String,
    /// A hash of the scene and of every file it refers to, as 32 hexadecimal digits.
    pub scene_hash: String,
    /// Width and height of the film in pixels.
    pub film: [u32; 2],
    /// The picture in linear radiance, of the crop's size.
    pub image: Image,
    /// Number of queries of the oracle by pixel, in the order of the image's pixels, for all
    /// channels together. 0 under `exact`, which sums over all paths and queries no oracle. With a
    /// search for primary hits: queries of the oracle of nearest hits, for all paths together.
    pub queries: Vec<u64>,
    /// Width of a channel's interval, in radiance, by pixel and channel; the interval has the
    /// estimator's confidence. 0 under `exact`, which estimates nothing. With colour from one run,
    /// the width of the luminance is in the first place.
    pub widths: Vec<[f64; 3]>,
    /// Number of strata of the comparator that were counted one by one, by pixel and channel: 1 if
    /// the whole comparator was counted at once, 0 if nothing was counted. With colour from one
    /// run, the number of the luminance is in the first place.
    pub strata: Vec<[u8; 3]>,
    /// S, the number of good indices of every pixel's channels, in the order of the image's pixels;
    /// `None` for the real model, which has no comparators.
    pub good: Option<Vec<[u64; 3]>>,
    /// The model that traced the paths.
    pub model: Model,
    /// The method that found primary hits.
    pub visibility: Visibility,
    /// The size and cost of the search for primary hits, if there was one; `None` for a scene
    /// without faces, where all paths meet nothing.
    pub searched: Option<Searched>,
    /// x, y, width and height on the film, in pixels.
    pub crop: [u32; 4],
    /// The estimator of the pixels' amplitudes; [`OWN_LIKE`] for a user-defined one.
    pub estimator: Estimator,
    /// The name of the user-defined estimator, if the picture was made with one.
    pub own_estimator: Option<String>,
    /// The method by which pixels got their colours.
    pub colour: Colour,
    /// Noise of the device that counted.
    pub noise: Noise,
    /// The key of the shifts and draws.
    pub seed: u64,
    /// The parameters: the scene's own, or those chosen for its accuracy.
    pub parameters: Parameters,
    /// The figures of the plan that chose the parameters, if there was one.
    pub plan: Option<Figures>,
    /// The proven bounds on a path's colour, by pixel.
    pub scales: Scales,
    /// N, the number of indices of a pixel's channel: paths times comparators.
    pub ids: u64,
    /// Number of paths of the picture.
    pub paths: u64,
    /// Number of paths that a checkpoint had.
    pub resumed_paths: u64,
    /// Wall time of tracing and counting, in seconds.
    pub seconds: f64,
    /// Number of threads.
    pub threads: usize,
}

impl Rendered {
    /// Number of queries of the oracle for the whole picture.
    pub fn total_queries(&self) -> u128 {
        self.queries.iter().map(|&q| u128::from(q)).sum()
    }

    /// The number of pixels' channels for each number of strata.
    pub fn strata_used(&self) -> BTreeMap<u8, u64> {
        let mut used = BTreeMap::new();
        for &strata in self.strata.iter().flatten().filter(|&&strata| strata > 0) {
            *used.entry(strata).or_default() += 1;
        }
        used
    }

    /// The mean pixel, in linear radiance: red, green, blue.
    pub fn mean(&self) -> [f64; 3] {
        let pixels = &self.image.pixels;
        let mut sum = [0.0; 3];
        for pixel in pixels {
            for (sum, value) in sum.iter_mut().zip(pixel) {
                *sum += value / pixels.len() as f64;
            }
        }
        sum
    }

    /// Iterates over the channels of all pixels, as written to a CSV file; x and y are on the film.
    pub fn counts(&self) -> impl Iterator<Item = Count> {
        tiles::pixels(self.crop)
            .zip(&self.image.pixels)
            .enumerate()
            .flat_map(move |(place, ([x, y], pixel))| {
                (0..3).map(move |channel| Count {
                    x,
                    y,
                    channel,
                    value: pixel[channel],
                    good: self.good.as_ref().map(|good| good[place][channel]),
                    total: self.ids,
                    scale: self.scales.at([x, y])[channel],
                })
            })
    }
}

/// Renders a scene.
///
/// # Errors
/// See [`RenderError`]. On an interruption, the checkpoint has the finished tiles.
pub fn render(scene: &ValidScene, options: &Options<'_>) -> Result<Rendered, RenderError> {
    render_keeping(scene, options).map(without_checkpoint)
}

/// As [`render`], but also returns the checkpoint, open and locked, if there is one. No other
/// process can use it until the caller removes ([`Checkpoint::remove`]) or drops it, when the
/// picture is safe.
///
/// # Errors
/// As [`render`].
pub fn render_keeping(
    scene: &ValidScene,
    options: &Options<'_>,
) -> Result<(Rendered, Option<Checkpoint>), RenderError> {
    let rendered = render_portion(scene, options, None, |_| ());
    rendered.map(|(rendered, (), checkpoint)| (rendered, checkpoint))
}

/// Renders the pixels of a portion, with all others black; without a portion, the whole picture.
/// Also returns the result of `told`, which gets the request with the chosen parameters.
fn render_portion<T>(
    scene: &ValidScene,
    options: &Options<'_>,
    portion: Option<Portion>,
    told: impl FnOnce(&Request<'_>) -> T,
) -> Result<(Rendered, T, Option<Checkpoint>), RenderError> {
    let crop = crop_of(scene, options)?;
    options.memory.keep_picture([crop[2], crop[3]])?;
    if options.own_estimator.is_some() && scene.scene().accuracy.is_some() {
        return Err(RenderError::OwnAccuracy);
    }
    let planned;
    let chosen = match (scene.scene().accuracy, options.plan) {
        (None, _) => None,
        (Some(_), Some(plan)) => Some(plan),
        (Some(_), None) => {
            options.memory.keep_plan(scene)?;
            planned = plan(scene, &options.planning())?;
            planned.as_ref()
        }
    };
    let traced = chosen.map_or(scene, |plan| &plan.scene);
    let request = Request {
        portion,
        ..Request::new(traced, options, crop)?
    };
    if let Some(count) = portion.map(Portion::count)
        && u64::from(count) > request.area
    {
        let pixels = request.area;
        return Err(RenderError::Portions { count, pixels });
    }
    check_circuit(traced, options)?;
    let (classes, searched) = Classes::new(&request)?;
    let told = told(&request);
    let (rendered, checkpoint) = Job::new(request, classes)?.render()?;
    let rendered = Rendered {
        scene_hash: scene.fingerprint().to_string(),
        plan: chosen.map(|plan| plan.figures),
        searched,
        ..rendered
    };
    Ok((rendered, told, checkpoint))
}

/// Renders a scene of `qrt!` with the circuit that was compiled with it. The picture is the same as
/// [`render`]'s, but the circuit is not built again. Under [`Model::Fixed`] it runs as native code:
/// see [`OracleMachine::native`].
///
/// # Errors
/// As [`render`]; and a [`CompiledError`] if that circuit does not support the request, or under
/// [`Model::Real`], the default, which does not run it.
pub fn render_compiled<C: NativeOracle>(options: &Options<'_>) -> Result<Rendered, RenderError> {
    let scene = C::scene();
    if scene.scene().accuracy.is_some() {
        return Err(CompiledError::Accuracy.into());
    }
    if options.colour == Colour::OneRun {
        return Err(CompiledError::OneRun.into());
    }
    if options.visibility != Visibility::Classical {
        return Err(CompiledError::Visibility.into());
    }
    let request = Request::new(scene, options, crop_of(scene, options)?)?;
    let oracle = C::oracle().map_err(OracleError::from)?.into();
    let machine = match options.model {
        Model::Real => return Err(CompiledError::Model.into()),
        Model::Fixed => OracleMachine::native::<C>(oracle, options.seed, false),
        Model::Gates => OracleMachine::gates(oracle, options.seed, false)?,
    };
    let pixels = request.pixels(Source::Oracle(machine))?;
    let job = Job::new(request, Classes::one(pixels))?;
    job.render().map(without_checkpoint)
}

fn without_checkpoint((rendered, checkpoint): (Rendered, Option<Checkpoint>)) -> Rendered {
    if let Some(checkpoint) = checkpoint {
        // The picture is complete, and an error of its checkpoint is no reason to lose it.
        let _ = checkpoint.close();
    }
    rendered
}

/// Renders the light of only those paths that satisfy a predicate.
pub(crate) fn render_predicate(
    predicate: &Predicate,
    options: &Options<'_>,
) -> Result<Rendered, RenderError> {
    let scene = predicate.scene();
    let request = Request {
        predicate: Some(predicate),
        ..Request::new(scene, options, crop_of(scene, options)?)?
    };
    let (classes, _) = Classes::new(&request)?;
    Job::new(request, classes)?.render().map(without_checkpoint)
}

/// A valid request for a picture: its parameters are chosen, and its crop is on the film.
struct Request<'a> {
    scene: &'a ValidScene,
    options: &'a Options<'a>,
    /// x, y, width and height on the film, in pixels.
    crop: [u32; 4],
    estimator: Estimator,
    /// Number of pixels of the picture.
    area: u64,
    /// R, the number of paths of a pixel.
    paths: u64,
    /// The predicate that selects paths; `None` for all paths.
    predicate: Option<&'a Predicate>,
    /// The portion of the pixels to render; `None` for all.
    portion: Option<Portion>,
}

impl<'a> Request<'a> {
    fn new(
        scene: &'a ValidScene,
        options: &'a Options<'a>,
        crop: [u32; 4],
    ) -> Result<Self, RenderError> {
        let path_bits = scene.scene().sampling.path_bits;
        let request = Self {
            scene,
            options,
            crop,
            estimator: options.visibility.estimator(options, scene.scene())?,
            area: u64::from(crop[2]) * u64::from(crop[3]),
            paths: 1 << path_bits,
            predicate: None,
            portion: None,
        };
        match request.area.checked_mul(request.paths) {
            Some(_) => Ok(request),
            None => Err(RenderError::TooManyPaths {
                pixels: request.area,
                path_bits,
            }),
        }
    }

    /// Cuts the picture into tiles. The tiles of portions do not depend on [`Options::tile`], so
    /// that all processes cut alike.
    fn tiles(&self) -> Tiles {
        let size = self.options.tile.filter(|_| self.portion.is_none());
        let portion = self.portion.unwrap_or(Portion::WHOLE);
        Tiles::new(self.crop, size, self.paths, portion)
    }

    /// Creates the pixels' counter for the paths that `source` traces.
    fn pixels(&self, source: Source) -> Result<Pixels, RenderError> {
        Pixels::new(source, self.scene.scene(), self.estimator, self.options)
    }

    /// Creates the machine that traces the paths of a class of pixels, and describes the search for
    /// their primary hits, if there is one.
    fn source(&self, class: PixelClass) -> Result<(Source, Option<Searched>), RenderError> {
        let Options { seed, model, .. } = *self.options;
        if self.options.visibility != Visibility::Classical {
            let (machine, searched) = visibility::machine(self.scene, self.options, class)?;
            return Ok((Source::Oracle(machine), searched));
        }
        if model == Model::Real {
            let real = match self.predicate {
                Some(predicate) => Real::of_predicate(predicate, Marks::Light, seed, class)?,
                None => Real::of_class(self.scene, seed, class)?,
            };
            let real = real.with_simd(self.options.simd);
            return Ok((Source::Real(Box::new(real)), None));
        }
        let one_run = self.options.colour == Colour::OneRun;
        let of_class = oracle::Options::of_class(class);
        let oracle = match self.predicate {
            Some(predicate) => predicate.oracle(Marks::Light, of_class)?,
            None if one_run => Oracle::rgb_and_luminance(self.scene, of_class)?,
            None => Oracle::rgb(self.scene, of_class)?,
        };
        // With one run, the pixel's colour comes from the colours of measured paths.
        let machine = if model == Model::Gates {
            OracleMachine::gates(oracle.into(), seed, one_run)?
        } else {
            OracleMachine::fixed(oracle.into(), seed, one_run)
        };
        Ok((Source::Oracle(machine), None))
    }
}

/// Returns the part of the film to render: x, y, width and height.
pub(crate) fn crop_of(scene: &ValidScene, options: &Options<'_>) -> Result<[u32; 4], RenderError> {
    let film = [scene.scene().film.width, scene.scene().film.height];
    let crop = options.crop.unwrap_or([0, 0, film[0], film[1]]);
    let [x, y, width, height] = crop;
    let within = |first: u32, length: u32, whole: u32| {
        length > 0 && first.checked_add(length).is_some_and(|end| end <= whole)
    };
    if within(x, width, film[0]) && within(y, height, film[1]) {
        Ok(crop)
    } else {
        Err(RenderError::Crop { crop, film })
    }
}
