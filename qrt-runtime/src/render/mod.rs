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
//! oracle does it; the good among all `N = R C` ids are counted, and the estimator learns of their
//! number S only what its measurements tell:
//!
//! ```text
//! pixel = scale a~,      a~ an estimate of S/N
//! ```
//!
//! with `scale` the proven bound of a path's colour in that channel. A channel that is proven
//! black takes no queries.
//!
//! [`Visibility`] says how a path's first hit is found: by the tracer like all others, or path by path
//! with an oracle of nearest hits, whose queries are then the picture's.
//!
//! A scene that asks for an `accuracy` is rendered with the knobs that [`crate::plan`] chooses for it.
//!
//! # What a picture depends on
//!
//! On the scene, the seed, the estimator and the version of qrt. Not on the number of threads, the
//! size of tiles, the crop, the instruction set, or on whether it was interrupted: sums are added
//! in an order that ids decide, and draws are keyed by pixel and channel.
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

mod error;
mod metadata;
mod one_run;
mod pixel;
mod sum;
mod tiles;
mod visibility;

pub use error::RenderError;
pub(crate) use sum::Sum;
pub use visibility::{DEFAULT_FAILURE, Searched, Visibility};

use crate::checkpoint::{Checkpoint, Header, Tile};
use crate::estimators::Noise;
use crate::image::{Count, Image};
use crate::machines::{NativeOracle, OracleMachine, Real, Simd};
use crate::plan::{self, Figures, Plan, plan};
use pixel::{Pixels, Source, Totals};
use qrt_core::oracle::Oracle;
use qrt_core::scene::Estimator;
use qrt_core::valid::{Knobs, ValidScene};
use rayon::prelude::*;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;
use tiles::Tiles;

/// What traces the paths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Model {
    /// The tracer in 64-bit floating point.
    #[default]
    Real,
    /// The oracle's program, operation by operation, on integers.
    Fixed,
    /// The oracle's circuit, gate by gate: compute, flip, uncompute.
    Gates,
}

impl Model {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Real, Self::Fixed, Self::Gates];

    /// As it is written.
    pub fn name(self) -> &'static str {
        match self {
            Self::Real => "real",
            Self::Fixed => "fixed",
            Self::Gates => "gates",
        }
    }
}

/// How a pixel gets its colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Colour {
    /// A run of counting for each channel, as in the paper.
    #[default]
    ThreeRuns,
    /// One run, of the luminance; the colour comes from the paths that it measures. A third of the
    /// queries, and colours with the noise of that many paths.
    OneRun,
}

impl Colour {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::ThreeRuns, Self::OneRun];

    /// As it is written.
    pub fn name(self) -> &'static str {
        match self {
            Self::ThreeRuns => "three-runs",
            Self::OneRun => "one-run",
        }
    }
}

/// How to render. What isn't set follows from the scene.
#[derive(Clone, Default)]
pub struct Options<'a> {
    /// Keys the shifts of the digital net and every draw; 0 unless set.
    pub seed: u64,
    /// x, y, width and height of the part of the film to render, from its top left corner; all of
    /// it unless set.
    pub crop: Option<[u32; 4]>,
    /// What traces the paths.
    pub model: Model,
    /// The estimator, in place of the scene's.
    pub estimator: Option<Estimator>,
    /// How pixels get their colours.
    pub colour: Colour,
    /// Noise of the device that counts; none unless set.
    pub noise: Noise,
    /// How first hits are found.
    pub visibility: Visibility,
    /// The knobs of a scene that asks for an accuracy, where they are chosen already.
    pub plan: Option<&'a Plan>,
    /// Threads; as many as the machine has cores unless set.
    pub threads: Option<NonZeroUsize>,
    /// Lanes to trace on.
    pub simd: Simd,
    /// Width and height of the tiles; chosen by the number of paths unless set.
    pub tile: Option<[u32; 2]>,
    /// Where finished tiles are kept until the picture is finished; nowhere unless set. It stays
    /// when the picture is finished, too: remove it when the picture is safe.
    pub checkpoint: Option<PathBuf>,
    /// Go on from the checkpoint, if there is one. Otherwise it is replaced.
    pub resume: bool,
    /// Set it, from any thread, to stop.
    pub cancel: Option<&'a AtomicBool>,
    /// Told how far the work is, from any thread.
    pub progress: Option<&'a (dyn Fn(Progress) + Sync)>,
}

impl<'a> Options<'a> {
    /// How the knobs of a scene that asks for an accuracy are chosen for this picture.
    pub fn planning(&self) -> plan::Options<'a> {
        plan::Options {
            estimator: self.estimator,
            noise: self.noise,
            threads: self.threads,
            cancel: self.cancel,
        }
    }
}

/// How far a picture is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// Once, at the beginning.
    Started {
        /// Paths of the picture.
        paths: u64,
        /// Of these, those that a checkpoint has.
        resumed: u64,
    },
    /// So many more paths are finished.
    Traced(u64),
}

/// A picture, and how it came about.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendered {
    /// Linear radiance. With a crop, of the crop's size.
    pub image: Image,
    /// Queries of the oracle by pixel, as the image's pixels; all channels together. 0 under
    /// `exact`, which sums over all paths and asks no oracle. Where first hits are searched for:
    /// those of the oracle of nearest hits, all paths together.
    pub queries: Vec<u64>,
    /// S, the good ids of every pixel's channels, as the image's pixels; none of the real model,
    /// which has no ids but paths.
    pub good: Option<Vec<[u64; 3]>>,
    /// What traced the paths.
    pub model: Model,
    /// How first hits were found.
    pub visibility: Visibility,
    /// What of, if they were not traced; none for a scene without faces, whose paths meet nothing.
    pub searched: Option<Searched>,
    /// x, y, width and height on the film.
    pub crop: [u32; 4],
    /// The estimator.
    pub estimator: Estimator,
    /// How its pixels got their colours.
    pub colour: Colour,
    /// Noise of the device that counted.
    pub noise: Noise,
    /// The seed.
    pub seed: u64,
    /// The knobs: the scene's, or those that its accuracy takes.
    pub knobs: Knobs,
    /// How these were chosen, if they were.
    pub plan: Option<Figures>,
    /// The proven bound on a path's colour per channel: the radiance of S = N.
    pub bound: [f64; 3],
    /// N, the ids of a pixel's channel: paths times comparators.
    pub ids: u64,
    /// Paths of the picture.
    pub paths: u64,
    /// Of these, those that a checkpoint had.
    pub resumed_paths: u64,
    /// Wall time of tracing and counting.
    pub seconds: f64,
    /// Threads that worked.
    pub threads: usize,
}

impl Rendered {
    /// Queries of the oracle for the whole picture.
    pub fn total_queries(&self) -> u128 {
        self.queries.iter().map(|&q| u128::from(q)).sum()
    }

    /// The mean pixel.
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
                    scale: self.bound[channel],
                })
            })
    }
}

/// Renders a scene.
///
/// # Errors
/// See [`RenderError`]. An interruption is one: what is finished then is in the checkpoint.
pub fn render(scene: &ValidScene, options: &Options<'_>) -> Result<Rendered, RenderError> {
    render_by(scene, options, |scene, model| {
        compiled(scene, options, model)
    })
}

/// Renders a scene of `qrt!` by the circuit that was compiled with it: the same picture as
/// [`render`]'s, without building its circuit again, and under [`Model::Fixed`] by native code: see
/// [`OracleMachine::native`].
///
/// The circuit of a scene that asks for an accuracy is compiled with the default knobs. Its picture
/// takes those that are chosen for it, by a circuit that is built anew.
///
/// # Errors
/// As [`render`].
pub fn render_compiled<C: NativeOracle>(options: &Options<'_>) -> Result<Rendered, RenderError> {
    if C::scene().scene().accuracy.is_some() {
        return render(C::scene(), options);
    }
    render_by(C::scene(), options, |scene, model| {
        // Its luminance was not compiled.
        if options.colour == Colour::OneRun {
            return compiled(scene, options, model);
        }
        let oracle = C::oracle()
            .map_err(qrt_core::oracle::OracleError::from)?
            .into();
        Ok(match model {
            Model::Gates => OracleMachine::gates(oracle, options.seed, false)?,
            Model::Real | Model::Fixed => OracleMachine::native::<C>(oracle, options.seed, false),
        })
    })
}

/// A machine for the scene's oracle, made now.
fn compiled(
    scene: &ValidScene,
    options: &Options<'_>,
    model: Model,
) -> Result<OracleMachine, RenderError> {
    let chosen = qrt_core::oracle::Options::default();
    let one_run = options.colour == Colour::OneRun;
    let oracle = if one_run {
        Oracle::rgb_and_luminance(scene, chosen)?.into()
    } else {
        Oracle::rgb(scene, chosen)?.into()
    };
    // The colours of the paths that are measured.
    Ok(match model {
        Model::Gates => OracleMachine::gates(oracle, options.seed, one_run)?,
        Model::Real | Model::Fixed => OracleMachine::fixed(oracle, options.seed, one_run),
    })
}

fn render_by(
    scene: &ValidScene,
    options: &Options<'_>,
    machine: impl FnOnce(&ValidScene, Model) -> Result<OracleMachine, RenderError>,
) -> Result<Rendered, RenderError> {
    let film = [scene.scene().film.width, scene.scene().film.height];
    let crop = options.crop.unwrap_or([0, 0, film[0], film[1]]);
    check_crop(crop, film)?;
    let planned;
    let (scene, chosen) = match (scene.scene().accuracy, options.plan) {
        (None, _) => (scene, None),
        (Some(_), Some(plan)) => (&plan.scene, Some(plan.figures)),
        (Some(_), None) => {
            planned = plan(scene, &options.planning())?;
            match &planned {
                Some(plan) => (&plan.scene, Some(plan.figures)),
                None => (scene, None),
            }
        }
    };
    let written = scene.scene();
    let estimator = options.visibility.estimator(options, written)?;
    let paths = 1 << written.sampling.path_bits;
    let area = u64::from(crop[2]) * u64::from(crop[3]);
    let Some(all_paths) = area.checked_mul(paths) else {
        return Err(RenderError::TooManyPaths {
            pixels: area,
            path_bits: written.sampling.path_bits,
        });
    };
    let mut searched = None;
    let source = match options.model {
        _ if options.visibility != Visibility::Classical => {
            let (machine, what) = visibility::machine(scene, options)?;
            searched = what;
            Source::Oracle(machine)
        }
        Model::Real => {
            let real = Real::new(scene, options.seed)?.with_simd(options.simd);
            Source::Real(Box::new(real))
        }
        model @ (Model::Fixed | Model::Gates) => Source::Oracle(machine(scene, model)?),
    };
    let Options {
        noise,
        colour,
        seed,
        ..
    } = *options;
    let pixels = Pixels::new(source, written, estimator, noise, colour, seed)?;
    let threads = options.threads.map_or(0, NonZeroUsize::get);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| RenderError::Threads(error.to_string()))?;

    let mut film = Film::new(crop, area)?;
    let finished = film.open(options, || header(scene, options, estimator, crop))?;
    let resumed = finished.iter().filter(|&&f| f).count() as u64;
    let job = Job {
        tiles: Tiles::new(crop, options.tile, paths),
        pixels,
        paths,
        options,
        crop,
        finished,
        film: Mutex::new(film),
    };
    job.report(Progress::Started {
        paths: all_paths,
        resumed: resumed * paths,
    });
    let start = Instant::now();
    let done = pool.install(|| {
        let tiles = (0..job.tiles.count()).into_par_iter();
        tiles.try_for_each(|number| job.tile(number))
    });
    let seconds = start.elapsed().as_secs_f64();
    let bound = job.pixels.bound();
    let film = job
        .film
        .into_inner()
        .unwrap_or_else(PoisonError::into_inner);
    match done {
        Ok(()) => Ok(Rendered {
            image: film.image,
            queries: film.queries,
            good: (options.model != Model::Real && options.colour == Colour::ThreeRuns)
                .then_some(film.good),
            model: options.model,
            visibility: options.visibility,
            searched,
            crop,
            estimator,
            colour: options.colour,
            noise: options.noise,
            seed: options.seed,
            knobs: scene.knobs(),
            plan: chosen,
            bound,
            ids: paths << written.comparator.bits,
            paths: all_paths,
            resumed_paths: resumed * paths,
            seconds,
            threads: pool.current_num_threads(),
        }),
        Err(Stop::Cancelled) => Err(RenderError::Interrupted {
            finished: film.finished,
            pixels: area,
            checkpoint: options.checkpoint.clone(),
        }),
        Err(Stop::Failed(error)) => Err(error),
    }
}

fn check_crop(crop: [u32; 4], film: [u32; 2]) -> Result<(), RenderError> {
    let [x, y, width, height] = crop;
    let within = |first: u32, length: u32, whole: u32| {
        length > 0 && first.checked_add(length).is_some_and(|end| end <= whole)
    };
    if within(x, width, film[0]) && within(y, height, film[1]) {
        Ok(())
    } else {
        Err(RenderError::Crop { crop, film })
    }
}

/// What decides a pixel.
fn header(scene: &ValidScene, asked: &Options<'_>, estimator: Estimator, crop: [u32; 4]) -> Header {
    let options = [
        ("model", asked.model.name().to_owned()),
        ("estimator", estimator.name().to_owned()),
        ("colour", asked.colour.name().to_owned()),
        ("noise", asked.noise.to_string()),
        ("version", env!("CARGO_PKG_VERSION").to_owned()),
    ];
    Header {
        scene_hash: scene.fingerprint().to_string(),
        seed: asked.seed,
        options: options
            .map(|(key, value)| (key.to_owned(), value))
            .into_iter()
            .chain(asked.visibility.written())
            .collect(),
        width: scene.scene().film.width,
        height: scene.scene().film.height,
        crop,
    }
}

/// Why the work on a tile ended early.
enum Stop {
    Cancelled,
    Failed(RenderError),
}

impl<E: Into<RenderError>> From<E> for Stop {
    fn from(error: E) -> Self {
        Self::Failed(error.into())
    }
}

struct Job<'a> {
    options: &'a Options<'a>,
    pixels: Pixels,
    paths: u64,
    crop: [u32; 4],
    tiles: Tiles,
    /// By pixel, whether a checkpoint has it; empty if there was none.
    finished: Vec<bool>,
    film: Mutex<Film>,
}

impl Job<'_> {
    fn report(&self, progress: Progress) {
        if let Some(listener) = self.options.progress {
            listener(progress);
        }
    }

    fn cancelled(&self) -> bool {
        let cancel = self.options.cancel;
        cancel.is_some_and(|flag| flag.load(Ordering::Relaxed))
    }

    fn tile(&self, number: u64) -> Result<(), Stop> {
        let [x, y, width, height] = self.tiles.rectangle(number);
        let mut tile = Tile {
            x,
            y,
            width,
            height,
            pixels: Vec::new(),
            queries: Vec::new(),
            good: Vec::new(),
        };
        if !self.finished.is_empty()
            && tiles::rows(&tile, self.crop).all(|row| self.finished[row].iter().all(|&f| f))
        {
            return Ok(());
        }
        if self.cancelled() {
            return Err(Stop::Cancelled);
        }
        let places: Vec<[u32; 2]> = tiles::pixels([x, y, width, height]).collect();
        if self.pixels.splits() {
            let traced = |paths| {
                self.report(Progress::Traced(paths));
                !self.cancelled()
            };
            for &place in &places {
                let totals = self.pixels.many(place, &traced)?;
                self.finish(&mut tile, place, &totals.ok_or(Stop::Cancelled)?)?;
            }
        } else {
            for (&place, totals) in places.iter().zip(&self.pixels.few(&places)?) {
                if self.cancelled() {
                    return Err(Stop::Cancelled);
                }
                self.finish(&mut tile, place, totals)?;
            }
            self.report(Progress::Traced(places.len() as u64 * self.paths));
        }
        let mut film = self.film.lock().unwrap_or_else(PoisonError::into_inner);
        film.keep(&tile)?;
        Ok(())
    }

    /// Adds a pixel to its tile.
    fn finish(&self, tile: &mut Tile, place: [u32; 2], totals: &Totals) -> Result<(), RenderError> {
        let pixel = self.pixels.finish(place, totals)?;
        tile.pixels.push(pixel.colour);
        tile.queries.push(pixel.queries);
        tile.good.push(pixel.good);
        Ok(())
    }
}

/// What is finished.
struct Film {
    crop: [u32; 4],
    image: Image,
    queries: Vec<u64>,
    good: Vec<[u64; 3]>,
    finished: u64,
    checkpoint: Option<Checkpoint>,
}

impl Film {
    fn new(crop: [u32; 4], area: u64) -> Result<Self, RenderError> {
        let memory = || RenderError::Memory { pixels: area };
        let size = usize::try_from(area).map_err(|_| memory())?;
        let mut pixels = Vec::new();
        let mut queries = Vec::new();
        let mut good = Vec::new();
        good.try_reserve_exact(size).map_err(|_| memory())?;
        good.resize(size, [0; 3]);
        pixels.try_reserve_exact(size).map_err(|_| memory())?;
        queries.try_reserve_exact(size).map_err(|_| memory())?;
        pixels.resize(size, [0.0; 3]);
        queries.resize(size, 0);
        Ok(Self {
            crop,
            image: Image {
                width: crop[2],
                height: crop[3],
                pixels,
            },
            queries,
            good,
            finished: 0,
            checkpoint: None,
        })
    }

    /// Opens the checkpoint, and tells which pixels it has.
    fn open(
        &mut self,
        options: &Options<'_>,
        header: impl FnOnce() -> Header,
    ) -> Result<Vec<bool>, RenderError> {
        let mut finished = Vec::new();
        let Some(path) = &options.checkpoint else {
            return Ok(finished);
        };
        if options.resume && path.exists() {
            let (checkpoint, tiles) = Checkpoint::open(path, &header())?;
            if !tiles.is_empty() {
                finished.resize(self.queries.len(), false);
            }
            for tile in &tiles {
                self.paint(tile);
                for row in tiles::rows(tile, self.crop) {
                    finished[row].fill(true);
                }
            }
            self.finished = finished.iter().filter(|&&f| f).count() as u64;
            self.checkpoint = Some(checkpoint);
        } else {
            self.checkpoint = Some(Checkpoint::create(path, &header())?);
        }
        Ok(finished)
    }

    fn keep(&mut self, tile: &Tile) -> Result<(), RenderError> {
        if let Some(checkpoint) = &mut self.checkpoint {
            checkpoint.append(tile)?;
        }
        self.paint(tile);
        self.finished += tile.pixels.len() as u64;
        Ok(())
    }

    fn paint(&mut self, tile: &Tile) {
        let width = tile.width as usize;
        let rows = tiles::rows(tile, self.crop);
        let colours = tile.pixels.chunks_exact(width);
        let queries = tile.queries.chunks_exact(width);
        let good = tile.good.chunks_exact(width);
        for ((row, good), (colours, queries)) in rows.zip(good).zip(colours.zip(queries)) {
            self.image.pixels[row.clone()].copy_from_slice(colours);
            self.good[row.clone()].copy_from_slice(good);
            self.queries[row].copy_from_slice(queries);
        }
    }
}
