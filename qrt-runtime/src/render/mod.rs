//! From a scene to a picture: every path of every pixel, and what counting makes of them.
//!
//! The machine traces all R paths of a pixel. Under the estimator `exact` the pixel is their mean,
//!
//! ```text
//! pixel = 1/R sum_id colour_id            real
//! pixel = scale S/N                       fixed, gates
//! ```
//!
//! Under any other, each path's colour is compared with the C comparators of its channel, as the
//! oracle does it; the good among all `N = R C` indices are counted, and the estimator learns of
//! their number S only what its measurements tell:
//!
//! ```text
//! pixel = scale a~,      a~ an estimate of S/N
//! ```
//!
//! with `scale` the proven bound of a path's colour in that channel. A channel that is proven
//! black takes no queries.
//!
//! [`Visibility`] says how a path's primary hit is found: by the tracer like all others, or path by
//! path with an oracle of nearest hits, whose queries are then the picture's.
//!
//! A scene that asks for an `accuracy` is rendered with the parameters that [`crate::plan`] chooses
//! for it.
//!
//! # What a picture depends on
//!
//! On the scene, the seed, the estimator and the version of qrt. Not on the number of threads, the
//! size of tiles, the crop, the instruction set, or on whether it was interrupted: sums are added
//! in an order that path indices decide, and draws are keyed by pixel and channel.
//!
//! ```
//! use qrt_core::front::parse;
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
use crate::estimators::Noise;
use crate::image::{Count, Image};
use crate::machines::{NativeOracle, OracleMachine, Real, Simd};
use crate::memory::Memory;
use crate::named::named;
use crate::plan::{self, Figures, Plan, plan};
use crate::workers::Workers;
use classes::Classes;
use job::Job;
use pixel::{Pixels, Source};
use qrt_core::oracle::{self, Marks, Oracle, OracleError, Predicate};
use qrt_core::scene::Estimator;
use qrt_core::tracer::PixelClass;
use qrt_core::valid::{Parameters, ValidScene};
use std::collections::BTreeMap;
use std::path::PathBuf;
use tiles::Tiles;

named! {
    /// What traces the paths.
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
    /// How a pixel gets its colour.
    #[derive(Default)]
    pub enum Colour {
        /// A run of counting for each channel, as in the paper.
        #[default]
        ThreeRuns = "three-runs",
        /// One run, of the luminance; the colour comes from the paths that it measures. A third of
        /// the queries, and colours with the noise of that many paths.
        OneRun = "one-run",
    }
}

/// How to render. What isn't set follows from the scene.
#[derive(Clone, Default)]
pub struct Options<'a> {
    /// Keys the shifts of the digital net and every draw; 0 unless set.
    pub seed: u64,
    /// x, y, width and height in pixels of the part of the film to render, from its top left
    /// corner; all of it unless set.
    pub crop: Option<[u32; 4]>,
    /// What traces the paths.
    pub model: Model,
    /// The estimator, in place of the scene's.
    pub estimator: Option<Estimator>,
    /// An estimator of one's own, in place of all others.
    pub own_estimator: Option<OwnEstimator<'a>>,
    /// How pixels get their colours.
    pub colour: Colour,
    /// Noise of the device that counts; none unless set.
    pub noise: Noise,
    /// How primary hits are found.
    pub visibility: Visibility,
    /// The parameters of a scene that asks for an accuracy, where they are chosen already.
    pub plan: Option<&'a Plan>,
    /// Who does the work; told of paths.
    pub workers: Workers<'a>,
    /// The memory that it may take: what would take more by an estimate is refused.
    pub memory: Memory,
    /// Lanes to trace on, under [`Model::Real`].
    pub simd: Simd,
    /// Width and height of the tiles in pixels; chosen by the number of paths unless set.
    pub tile: Option<[u32; 2]>,
    /// Where finished tiles are kept until the picture is finished; they are not kept unless set.
    /// It stays when the picture is finished, too: [`render_keeping`] hands it over, so that it can
    /// be removed when the picture is safe.
    pub checkpoint: Option<PathBuf>,
    /// Go on from the checkpoint, if there is one. Otherwise it is replaced, by the first tile.
    pub resume: bool,
    /// Suppresses the note on standard error that qrt is compiled without optimisation. Without it,
    /// the first picture or count of a process that is expected to take ten seconds or more prints
    /// that note, with the lines of Cargo.toml that help. Builds that optimise `qrt-runtime` print
    /// nothing.
    pub quiet: bool,
}

impl<'a> Options<'a> {
    /// How the parameters of a scene that asks for an accuracy are chosen for this picture.
    pub fn planning(&self) -> plan::Options<'a> {
        plan::Options {
            estimator: self.estimator,
            noise: self.noise,
            workers: self.workers,
        }
    }
}

/// Which of the known estimators those of one's own are like, in what pictures tell of: it counts the
/// comparator as a whole, and decides itself when it ends.
pub const OWN_LIKE: Estimator = Estimator::MonteCarlo;

/// A picture, and how it came about.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendered {
    /// What the scene is called.
    pub scene_name: String,
    /// A hash of the scene and of every file it refers to, as 32 hexadecimal digits.
    pub scene_hash: String,
    /// Width and height of the film in pixels.
    pub film: [u32; 2],
    /// Linear radiance. With a crop, of the crop's size.
    pub image: Image,
    /// Queries of the oracle by pixel, as the image's pixels; all channels together. 0 under
    /// `exact`, which sums over all paths and asks no oracle. Where primary hits are searched for:
    /// those of the oracle of nearest hits, all paths together.
    pub queries: Vec<u64>,
    /// How wide the interval of a channel is, in radiance, by pixel and channel: it has the estimator's
    /// confidence. 0 under `exact`, which estimates nothing. Of the luminance, it stands in the first
    /// place.
    pub widths: Vec<[f64; 3]>,
    /// Strata of the comparator that were counted one by one, by pixel and channel: 1 where the
    /// whole was counted at once, 0 where nothing is counted. Of the luminance, it stands in the
    /// first place.
    pub strata: Vec<[u8; 3]>,
    /// S, the good indices of every pixel's channels, as the image's pixels; none of the real
    /// model, which compares with no comparators.
    pub good: Option<Vec<[u64; 3]>>,
    /// What traced the paths.
    pub model: Model,
    /// How primary hits were found.
    pub visibility: Visibility,
    /// What was searched for them, if they were not traced; none for a scene without faces, whose
    /// paths meet nothing.
    pub searched: Option<Searched>,
    /// x, y, width and height on the film, in pixels.
    pub crop: [u32; 4],
    /// What estimated the amplitudes of its pixels, unless it is one's own; [`OWN_LIKE`] then.
    pub estimator: Estimator,
    /// The name of the estimator of one's own, if that did.
    pub own_estimator: Option<String>,
    /// How its pixels got their colours.
    pub colour: Colour,
    /// Noise of the device that counted.
    pub noise: Noise,
    /// What keyed its shifts and draws.
    pub seed: u64,
    /// The parameters: the scene's, or those that its accuracy takes.
    pub parameters: Parameters,
    /// How these were chosen, if they were.
    pub plan: Option<Figures>,
    /// The proven bounds on a path's colour, by pixel.
    pub scales: Scales,
    /// N, the indices of a pixel's channel: paths times comparators.
    pub ids: u64,
    /// Paths of the picture.
    pub paths: u64,
    /// Of these, those that a checkpoint had.
    pub resumed_paths: u64,
    /// Wall time of tracing and counting, in seconds.
    pub seconds: f64,
    /// How many threads worked.
    pub threads: usize,
}

impl Rendered {
    /// Queries of the oracle for the whole picture.
    pub fn total_queries(&self) -> u128 {
        self.queries.iter().map(|&q| u128::from(q)).sum()
    }

    /// How many channels of pixels were counted in how many strata.
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

    /// Every channel of every pixel as it is written to a CSV file; x and y are on the film.
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
/// See [`RenderError`]. An interruption is one: what is finished then is in the checkpoint.
pub fn render(scene: &ValidScene, options: &Options<'_>) -> Result<Rendered, RenderError> {
    render_keeping(scene, options).map(without_checkpoint)
}

/// As [`render`], and hands over the checkpoint, open and locked, if there is one: nobody else can
/// begin with it before the picture is safe, and it is removed ([`Checkpoint::remove`]) or dropped.
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

/// The pixels of a portion, all others black, and what is `told` of what was asked; of no portion, the
/// whole picture.
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
    let (rendered, checkpoint) = Job::new(request, classes)?.run()?;
    let rendered = Rendered {
        scene_hash: scene.fingerprint().to_string(),
        plan: chosen.map(|plan| plan.figures),
        searched,
        ..rendered
    };
    Ok((rendered, told, checkpoint))
}

/// Renders a scene of `qrt!` by the circuit that was compiled with it: the same picture as
/// [`render`]'s, without building its circuit again, and under [`Model::Fixed`] by native code: see
/// [`OracleMachine::native`].
///
/// # Errors
/// As [`render`]; and a [`CompiledError`] where that circuit does not do what is asked, or is not
/// run at all: under [`Model::Real`], which is the default.
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
    job.run().map(without_checkpoint)
}

fn without_checkpoint((rendered, checkpoint): (Rendered, Option<Checkpoint>)) -> Rendered {
    if let Some(checkpoint) = checkpoint {
        // The picture is there; what becomes of its parts is no reason to lose it.
        let _ = checkpoint.close();
    }
    rendered
}

/// Renders the light of the paths on which a predicate holds.
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
    Job::new(request, classes)?.run().map(without_checkpoint)
}

/// A picture that can be rendered: its parameters are chosen, and its crop lies on the film.
struct Request<'a> {
    scene: &'a ValidScene,
    options: &'a Options<'a>,
    /// x, y, width and height on the film, in pixels.
    crop: [u32; 4],
    estimator: Estimator,
    /// Pixels of the picture.
    area: u64,
    /// R, the paths of a pixel.
    paths: u64,
    /// Which paths count, if not all do.
    predicate: Option<&'a Predicate>,
    /// Which of its pixels are rendered, if not all are.
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

    /// How the picture is cut into tiles. Portions are cut alike, whoever renders them.
    fn tiles(&self) -> Tiles {
        let size = self.options.tile.filter(|_| self.portion.is_none());
        let portion = self.portion.unwrap_or(Portion::WHOLE);
        Tiles::new(self.crop, size, self.paths, portion)
    }

    /// How the pixels get their colours whose paths `source` traces.
    fn pixels(&self, source: Source) -> Result<Pixels, RenderError> {
        Pixels::new(source, self.scene.scene(), self.estimator, self.options)
    }

    /// What traces the paths of the pixels of a class, and what is searched for their primary hits,
    /// if they are searched for.
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
        // The paths that one run measures give it the colours.
        let machine = if model == Model::Gates {
            OracleMachine::gates(oracle.into(), seed, one_run)?
        } else {
            OracleMachine::fixed(oracle.into(), seed, one_run)
        };
        Ok((Source::Oracle(machine), None))
    }
}

/// The part of the film that is rendered: x, y, width and height.
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
