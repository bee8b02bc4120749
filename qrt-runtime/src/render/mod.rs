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
//! A scene with an `accuracy` is rendered with the parameters that [`crate::plan`] chooses for it:
//! [`Prepared`].
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
//! use qrt_runtime::render::{RenderOptions, render};
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
//! let rendered = render(&scene.valid, &RenderOptions::default())?;
//! assert_eq!(rendered.image.pixels, [[0.25, 0.5, 1.0]; 8]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod classes;
pub(crate) mod error;
mod film;
mod job;
mod layers;
mod metadata;
mod one_run;
mod own;
mod parts;
#[cfg(feature = "parts")]
mod picture_part;
mod pixel;
mod portion;
#[cfg(feature = "parts")]
mod properties;
mod request;
mod stop;
mod tiles;
mod totals;

pub use crate::counted_pixels::CountedPixels;
pub use crate::models::{DEFAULT_FAILURE, Model, PrimaryHitsFound, Searched, Visibility};
pub use classes::Scales;
pub use error::{CompiledError, RenderError, out_of_bounds_advice};
pub use own::{BoxedEstimator, OwnEstimator};
#[cfg(feature = "parts")]
pub use picture_part::{Merge, MergeError, PicturePart, render_part};
pub use portion::{Portion, PortionError};
pub(crate) use request::crop_of;

use crate::checkpoint::Checkpoint;
use crate::image::{Count, Image};
use crate::memory::{CircuitWork, Memory};
use crate::models::{MachineError, MachineOptions, Machines};
use crate::named::named;
use crate::path_machines::{OracleMachine, PathMachine, Simd};
use crate::plan::{self, PlanFigures};
use crate::prepared::{PrepareError, Prepared};
use crate::workers::Workers;
use classes::Classes;
use job::Job;
use qrt_core::oracle::OracleError;
use qrt_core::oracle::compiled::CompiledOracle;
use qrt_counting::estimators::Noise;
use qrt_scene::Estimator;
use qrt_scene::valid::{Parameters, ValidScene};
use qrt_tracer::ByClass;
use request::Request;
use std::path::PathBuf;

named! {
    /// The method by which a pixel gets its colour.
    #[derive(Default)]
    #[cfg_attr(feature = "parts", derive(serde::Serialize, serde::Deserialize))]
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
#[derive(Clone, Debug, Default)]
pub struct RenderOptions<'a> {
    /// The key of the shifts of the digital net and of every draw; 0 unless set.
    pub seed: u64,
    /// The part of the film to render: x, y, width and height in pixels, from the film's top left
    /// corner; the whole film unless set.
    pub crop: Option<[u32; 4]>,
    /// The model that traces the paths. Unless set, [`Model::Real`], or [`Model::Fixed`] for the
    /// compiled circuit of [`render_compiled`].
    pub model: Option<Model>,
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
    /// The threads that do the work, and the callback for progress, in paths.
    pub workers: Workers<'a>,
    /// The memory budget. A render that would exceed it, by an estimate, is refused.
    pub memory: Memory,
    /// SIMD lanes for tracing under [`Model::Real`].
    pub simd: Simd,
    /// Width and height of the tiles in pixels; chosen by the number of paths unless set.
    pub tile: Option<[u32; 2]>,
    /// Path of the checkpoint, which keeps finished tiles until the picture is finished; no
    /// checkpoint unless set. The render does not remove the file: [`Prepared::render`] returns the
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

impl<'a> RenderOptions<'a> {
    /// Returns the model that traces the paths.
    pub fn model(&self) -> Model {
        self.model.unwrap_or_default()
    }

    /// Returns the options with which a scene's parameters are chosen for this picture.
    pub fn planning(&self) -> plan::PlanOptions<'a> {
        plan::PlanOptions {
            estimator: self.estimator,
            noise: self.noise,
            workers: self.workers,
        }
    }

    /// Returns how a render uses the scene's circuit; `None` for the real model, which runs none.
    pub fn circuit_work(&self) -> Option<CircuitWork> {
        match self.model() {
            Model::Real => None,
            Model::Fixed => Some(CircuitWork::Program),
            Model::Gates => Some(CircuitWork::gates(self.workers.threads)),
        }
    }

    /// True if primary hits are searched for with an oracle of nearest hits.
    pub(crate) fn searches(&self) -> bool {
        self.visibility != Visibility::Classical
    }

    /// The method that finds primary hits, before the machines are made.
    fn primary_hits(&self) -> PrimaryHitsFound {
        PrimaryHitsFound {
            method: self.visibility,
            searched: None,
        }
    }

    /// Checks what is known of a request for a picture before its parameters are chosen: its crop is on
    /// the film, the picture fits into memory, and the estimator fits the other options.
    ///
    /// # Errors
    /// If the request cannot be met.
    pub fn check(&self, scene: &ValidScene) -> Result<(), RenderError> {
        let [_, _, width, height] = request::crop_of(scene, self)?;
        self.memory.keep_picture([width, height])?;
        if self.own_estimator.is_some() && scene.scene().accuracy.is_some() {
            return Err(RenderError::OwnAccuracy);
        }
        request::estimator(scene.scene(), self).map(|_| ())
    }

    /// Prepares a scene for a render with these options.
    ///
    /// # Errors
    /// As [`RenderOptions::check`] and [`Prepared::new`].
    pub fn prepare<'s>(&self, scene: &'s ValidScene) -> Result<Prepared<'s>, RenderError> {
        self.check(scene)?;
        let prepared = Prepared::new(scene, &self.planning(), self.memory)?;
        Ok(if self.colour == Colour::OneRun {
            prepared.with_luminance()
        } else {
            prepared
        })
    }

    /// Checks that the picture, and the least circuit that the scene may have, fit into the memory budget.
    pub(crate) fn check_memory(&self, scene: &ValidScene) -> Result<(), RenderError> {
        let [_, _, width, height] = request::crop_of(scene, self)?;
        self.memory.keep_picture([width, height])?;
        if self.model() != Model::Real {
            self.memory.keep_compiling(scene)?;
        }
        Ok(())
    }

    /// The machine that traces the paths.
    fn machine(&self) -> MachineOptions<'static> {
        MachineOptions {
            model: self.model(),
            seed: self.seed,
            simd: self.simd,
            visibility: self.visibility,
            // With one run, the pixel's colour comes from the colours of measured paths.
            colours: self.colour == Colour::OneRun,
            ..MachineOptions::default()
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
    /// The figures of the pixels beside their colours, in the order of the image's pixels.
    pub counted: CountedPixels,
    /// The model that traced the paths.
    pub model: Model,
    /// The method that found primary hits, and its cost.
    pub primary_hits: PrimaryHitsFound,
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
    pub plan: Option<PlanFigures>,
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
        self.counted.queries.iter().map(|&q| u128::from(q)).sum()
    }

    /// S, the number of good indices of every pixel's channels, in the order of the image's pixels;
    /// `None` for the real model, which has no comparators, and for colour from one run, which counts
    /// the luminance.
    pub fn good(&self) -> Option<&[[u64; 3]]> {
        let counts = self.model != Model::Real && self.colour == Colour::ThreeRuns;
        counts.then_some(&*self.counted.good)
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
        let good = self.good();
        tiles::pixels(self.crop)
            .zip(&self.image.pixels)
            .enumerate()
            .flat_map(move |(place, ([x, y], pixel))| {
                (0..3).map(move |channel| Count {
                    x,
                    y,
                    channel,
                    value: pixel[channel],
                    good: good.map(|good| good[place][channel]),
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
pub fn render(scene: &ValidScene, options: &RenderOptions<'_>) -> Result<Rendered, RenderError> {
    let rendered = options.prepare(scene)?.render(options);
    rendered.map(without_checkpoint)
}

impl Prepared<'_> {
    /// Renders the scene. Also returns the checkpoint, open and locked, if there is one. No other
    /// process can use it until the caller removes ([`Checkpoint::remove`]) or drops it, when the
    /// picture is safe.
    ///
    /// # Errors
    /// As [`render`].
    pub fn render(
        &self,
        options: &RenderOptions<'_>,
    ) -> Result<(Rendered, Option<Checkpoint>), RenderError> {
        let request = Request::new(self.scene(), options)?;
        self.render_request(request)
    }

    /// Checks that the circuit that a render with `options` runs fits into the memory budget, and that
    /// the scene's oracles are within the scene's `budget`. Under [`Model::Real`], which runs no
    /// circuit, there is nothing to check.
    ///
    /// # Errors
    /// As [`Prepared::check_circuit`].
    pub fn check_render(&self, options: &RenderOptions<'_>) -> Result<(), PrepareError> {
        let Some(work) = options.circuit_work() else {
            return Ok(());
        };
        // With a search for primary hits a smaller circuit runs in place of the scene's. If the scene
        // is small, that one is not compiled only for its size.
        if !options.searches() || !self.compiles_at_once() {
            self.check_memory([0, 0], work)?;
        }
        self.check_budget()
    }

    /// Renders the pixels that are requested; all others are black.
    fn render_request(
        &self,
        request: Request<'_>,
    ) -> Result<(Rendered, Option<Checkpoint>), RenderError> {
        // Colour from one run counts the luminance, which the circuit may not have.
        let counts_luminance =
            request.options.colour == Colour::OneRun && request.options.model() != Model::Real;
        let luminant = counts_luminance.then(|| self.made_luminant()).flatten();
        let prepared = luminant.as_ref().unwrap_or(self);
        prepared.check_render(request.options)?;
        let machines = prepared.machines(&request.options.machine())?;
        drop(luminant);
        let (rendered, checkpoint) = trace(request, machines)?;
        let rendered = Rendered {
            scene_hash: self.scene_hash().to_owned(),
            plan: self.plan().copied(),
            ..rendered
        };
        Ok((rendered, checkpoint))
    }
}

/// Traces and counts the requested pixels, each by the machine of its class.
fn trace(
    request: Request<'_>,
    machines: Machines,
) -> Result<(Rendered, Option<Checkpoint>), RenderError> {
    let pixels = machines
        .by_class
        .try_map(|machine| request.pixels(machine))?;
    let job = Job::new(request, Classes::new(pixels))?;
    let (rendered, checkpoint) = job.render()?;
    let primary_hits = PrimaryHitsFound {
        searched: machines.searched,
        ..rendered.primary_hits
    };
    Ok((
        Rendered {
            primary_hits,
            ..rendered
        },
        checkpoint,
    ))
}

/// Renders a scene of `qrt!` with the circuit that was compiled with it. The picture is the same as
/// [`render`]'s, but the circuit is not built again. The model is [`Model::Fixed`] unless set.
///
/// # Errors
/// As [`render`]; and a [`CompiledError`] if that circuit does not support the request, or under
/// [`Model::Real`], which does not run it.
pub fn render_compiled<C: CompiledOracle>(
    options: &RenderOptions<'_>,
) -> Result<Rendered, RenderError> {
    let options = &RenderOptions {
        model: options.model.or(Some(Model::Fixed)),
        ..options.clone()
    };
    CompiledError::check(C::scene(), options)?;
    let request = Request::new(C::scene(), options)?;
    let oracle = C::oracle().map_err(OracleError::from)?.into();
    let machine = match options.model() {
        Model::Real => return Err(CompiledError::Model.into()),
        Model::Fixed => OracleMachine::fixed(oracle, options.seed, false),
        Model::Gates => OracleMachine::gates(oracle, options.seed, false)?,
    };
    let machine: Box<dyn PathMachine> = Box::new(machine);
    let machines = Machines {
        by_class: ByClass::one(machine),
        searched: None,
    };
    trace(request, machines).map(without_checkpoint)
}

fn without_checkpoint((rendered, checkpoint): (Rendered, Option<Checkpoint>)) -> Rendered {
    if let Some(checkpoint) = checkpoint {
        // The picture is complete, and an error of its checkpoint is no reason to lose it.
        let _ = checkpoint.close();
    }
    rendered
}

/// Renders a scene whose parameters are chosen with the machines that `machines` makes from the
/// options of the scene's own.
pub(crate) fn render_on(
    scene: &ValidScene,
    options: &RenderOptions<'_>,
    machines: impl FnOnce(MachineOptions<'static>) -> Result<Machines, MachineError>,
) -> Result<Rendered, RenderError> {
    let request = Request::new(scene, options)?;
    options.check_memory(scene)?;
    trace(request, machines(options.machine())?).map(without_checkpoint)
}
