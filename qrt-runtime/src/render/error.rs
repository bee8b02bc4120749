//! Errors of rendering a picture.

use super::{Colour, RenderOptions};
use crate::checkpoint::CheckpointError;
use crate::memory::MemoryError;
use crate::models::MachineError;
use crate::path_machines::Defect;
use crate::plan::PlanError;
use crate::prepared::{PrepareError, first};
use crate::search::RoundsError;
use crate::workers::ThreadsError;
use qrt_core::oracle::{OracleError, PredicateError};
use qrt_counting::CountingError;
use qrt_counting::estimators::EstimatorError;
use qrt_scene::Estimator;
use qrt_scene::sampling::SamplingError;
use qrt_scene::valid::ValidScene;
use qrt_syntax::Problem;
use std::path::{Path, PathBuf};

/// An error of rendering a picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// No parameters keep the scene's accuracy.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// Colour from one run is requested with an estimator that measures no paths.
    #[error(
        "colour from one run is that of the paths which are measured, and the estimator `exact` \
         measures none: choose another estimator, or three runs"
    )]
    NothingMeasured,
    /// A colour from one run is requested with an estimator whose measured paths are not a sample of
    /// the good indices.
    #[error(
        "colour from one run is that of good indices, and the estimator `phase-mean` measures paths by \
         their phases: choose another estimator, or three runs"
    )]
    MeanOfOneRun,
    /// Noise of measurements is requested with an estimator that measures nothing.
    #[error(
        "noise is that of queries and measurements, and the estimator `exact` makes none: choose \
         another estimator, or no noise"
    )]
    NothingNoisy,
    /// The crop has no pixels, or is not within the film.
    #[error("{}", outside(.crop, *.film))]
    Crop {
        /// x, y, width, height.
        crop: [u32; 4],
        /// The film's width and height, in pixels.
        film: [u32; 2],
    },
    /// The number of paths overflows 64 bits.
    #[error(
        "{pixels} pixels of 2^{path_bits} paths are more than 2^64 paths, which no machine traces \
         in a lifetime: lower `sampling.path_bits`, or the film"
    )]
    TooManyPaths {
        /// Number of pixels to render.
        pixels: u64,
        /// Number of paths of a pixel, as a power of two.
        path_bits: u32,
    },
    /// The layers of a picture are requested with the scene of another picture.
    #[error("this is not the scene that the picture was rendered of")]
    OtherScene,
    /// There are more portions than the picture has pixels.
    #[error("a picture of {pixels} pixels can't be cut into {count} portions: ask for fewer")]
    Portions {
        /// Number of portions.
        count: u32,
        /// Number of pixels of the picture.
        pixels: u64,
    },
    /// The picture does not fit into memory.
    #[error("there is not enough memory for {pixels} pixels")]
    Memory {
        /// Number of pixels of the picture.
        pixels: u64,
    },
    /// The work would exceed the memory budget, by an estimate.
    #[error(transparent)]
    WouldNotFit(#[from] MemoryError),
    /// The scene's circuit costs more than its `budget` allows. [`qrt_scene::front::Loaded::report`]
    /// shows the problems at their places.
    #[error("the circuit is beyond the scene's budget: {}", first(.0))]
    Budget(Vec<Problem>),
    /// The bound on a path's colour is so large that sums over paths could overflow.
    #[error(
        "a path's {} can only be bounded by {bound:e}, too large to sum: lower the radiance or the \
         number of depths",
        name(*.channel)
    )]
    Bound {
        /// 0, 1, 2: red, green, blue.
        channel: usize,
        /// The bound, in radiance.
        bound: f64,
    },
    /// The sequence of paths cannot be created.
    #[error(transparent)]
    Sampling(#[from] SamplingError),
    /// The scene has no circuit.
    #[error(transparent)]
    Oracle(#[from] OracleError),
    /// The compiled circuit does not support the request.
    #[error(transparent)]
    Compiled(#[from] CompiledError),
    /// The code is not a predicate of the scene's paths.
    #[error(transparent)]
    Predicate(#[from] PredicateError),
    /// The options or the scene are not supported with a predicate.
    #[error(transparent)]
    PredicateRefusal(#[from] PredicateRefusal),
    /// The path index is beyond the last.
    #[error("there is no path {id}: a pixel has 2^{path_bits} paths, from 0 on")]
    PathIndex {
        /// The index.
        id: u64,
        /// Number of paths of a pixel, as a power of two.
        path_bits: u32,
    },
    /// A path has a number that does not fit into the register from which a predicate reads it.
    #[error(
        "a path of pixel ({}, {}) has a number beyond its register; this is a defect of qrt, please \
         report it with the scene",
        .pixel[0], .pixel[1]
    )]
    Unheld {
        /// Column and row on the film.
        pixel: [u32; 2],
    },
    /// A search for primary hits is requested with the real model, which has no oracle.
    #[error(
        "primary hits are searched for by a circuit, which the model `real` does not have: use \
         `fixed` or `gates`"
    )]
    SearchModel,
    /// An estimator that counts indices in superposition is requested with a search for primary
    /// hits, which searches every path by itself.
    #[error(
        "the estimator `{0}` counts paths in superposition, and primary hits are searched for path \
         by path: use `exact`, or find primary hits classically"
    )]
    SearchEstimator(Estimator),
    /// The name of the user-defined estimator is not valid.
    #[error(
        "`{name}` is no name of an estimator: 1 to 64 letters, digits, `_`, `-` or `.` of ASCII"
    )]
    OwnName {
        /// The name.
        name: String,
    },
    /// A user-defined estimator is requested with a search for primary hits, which searches every
    /// path by itself.
    #[error(
        "an estimator of one's own counts paths in superposition, and primary hits are searched for \
         path by path: find primary hits classically"
    )]
    OwnSearches,
    /// A user-defined estimator is requested with a scene that has an accuracy. Planning needs the
    /// known error of an estimator.
    #[error(
        "the scene asks for an `accuracy`, which takes what is known of an estimator's error, and of \
         one of one's own nothing is: write the parameters into the scene"
    )]
    OwnAccuracy,
    /// The search for primary hits cannot be set up.
    #[error(transparent)]
    Search(#[from] RoundsError),
    /// The circuit is not a valid oracle: a defect of qrt. The picture would prove nothing, so
    /// there is none.
    #[error("{0}: a defect of qrt; the picture would prove nothing, so there is none")]
    Defect(#[from] Defect),
    /// The pixels cannot be counted with these parameters.
    #[error(transparent)]
    Counting(#[from] CountingError),
    /// The estimator does not support the request.
    #[error(transparent)]
    Estimator(#[from] EstimatorError),
    /// The threads cannot be started.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
    /// The checkpoint cannot be used.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// A path has a colour that is negative, not a number, or above its proven bound. It would be
    /// counted as the bound, and the picture would be too dark, so there is none.
    #[error(
        "path {id} of pixel ({}, {}) has a {} of {colour:e}, outside [0, {bound:e}]; {}",
        .pixel[0], .pixel[1], name(*.channel), out_of_bounds_advice(*.fraction)
    )]
    OutOfBounds {
        /// Column and row on the film.
        pixel: [u32; 2],
        /// The path's index.
        id: u64,
        /// 0 red, 1 green, 2 blue, 3 luminance.
        channel: usize,
        /// The path's colour, in radiance.
        colour: f64,
        /// The bound, in radiance.
        bound: f64,
        /// Fraction bits of the circuit's numbers; `None` for the real model.
        fraction: Option<u32>,
    },
    /// The picture was cancelled before it was finished.
    #[error("interrupted after {finished} of {pixels} pixels{}", kept(.checkpoint.as_deref()))]
    Interrupted {
        /// Number of finished pixels.
        finished: u64,
        /// Number of pixels of the picture.
        pixels: u64,
        /// The checkpoint with the finished tiles, if there is one.
        checkpoint: Option<PathBuf>,
    },
}

/// A request that the compiled circuit of a scene of `qrt!` does not support. [`super::render`]
/// supports it, with a circuit that it builds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CompiledError {
    /// The model runs no circuit.
    #[error(
        "a compiled circuit is run by the models `fixed` and `gates`; `real` runs none: choose one \
         of the two, or use `render`"
    )]
    Model,
    /// The scene has an accuracy: its parameters are chosen at the render, after its circuit was
    /// compiled.
    #[error(
        "the scene asks for an `accuracy`, and its circuit was compiled before the parameters are \
         chosen that keep it: write the parameters into the scene, or use `render`"
    )]
    Accuracy,
    /// The circuit computes no luminance.
    #[error(
        "a compiled circuit computes three channels and no luminance, which colour from one run \
         counts: choose three runs, or use `render`"
    )]
    OneRun,
    /// The circuit traces primary hits itself, so a search for them is not supported.
    #[error(
        "a compiled circuit finds primary hits itself, and none that are searched for: find \
         primary hits classically, or use `render`"
    )]
    Visibility,
}

impl From<PrepareError> for RenderError {
    fn from(error: PrepareError) -> Self {
        match error {
            PrepareError::Plan(error) => error.into(),
            PrepareError::WouldNotFit(error) => error.into(),
            PrepareError::Oracle(error) => error.into(),
            PrepareError::Budget(problems) => Self::Budget(problems),
        }
    }
}

impl From<MachineError> for RenderError {
    fn from(error: MachineError) -> Self {
        match error {
            MachineError::Sampling(error) => error.into(),
            MachineError::Oracle(error) => error.into(),
            MachineError::Defect(error) => error.into(),
            MachineError::Search(error) => error.into(),
            MachineError::SearchModel => Self::SearchModel,
        }
    }
}

impl CompiledError {
    /// Checks that a compiled circuit supports a request.
    pub(super) fn check(scene: &ValidScene, options: &RenderOptions<'_>) -> Result<(), Self> {
        if scene.scene().accuracy.is_some() {
            return Err(Self::Accuracy);
        }
        if options.colour == Colour::OneRun {
            return Err(Self::OneRun);
        }
        if options.searches() {
            return Err(Self::Visibility);
        }
        Ok(())
    }
}

impl RenderError {
    /// Returns true if the request can't be met, so that another attempt will fail alike; false if
    /// the job failed.
    pub fn is_refusal(&self) -> bool {
        match self {
            Self::Plan(error) => error.is_refusal(),
            Self::Checkpoint(error) => matches!(
                error,
                CheckpointError::Differs { .. } | CheckpointError::Irregular { .. }
            ),
            Self::Memory { .. }
            | Self::Threads(_)
            | Self::Defect(_)
            | Self::Unheld { .. }
            | Self::OutOfBounds { .. }
            | Self::Interrupted { .. } => false,
            _ => true,
        }
    }
}

fn name(channel: usize) -> &'static str {
    ["red", "green", "blue", "luminance"]
        .get(channel)
        .copied()
        .unwrap_or("?")
}

/// Advice for a path whose colour is out of bounds, on a machine of `fraction` bits; `None` is the
/// real model.
pub fn out_of_bounds_advice(fraction: Option<u32>) -> String {
    let report = "please report it with the scene";
    match fraction {
        None => format!("no rounding explains it, {report}"),
        Some(bits) => format!(
            "numbers of {bits} fraction bits may be too coarse for the scene: write more \
             (`precision.fraction`); if it stays with 24, {report}"
        ),
    }
}

fn outside([x, y, width, height]: &[u32; 4], [w, h]: [u32; 2]) -> String {
    if *width == 0 || *height == 0 {
        format!("a crop of {width} x {height} has no pixels")
    } else {
        format!(
            "a crop of {width} x {height} at ({x}, {y}) does not lie within the film of {w} x {h}"
        )
    }
}

fn kept(checkpoint: Option<&Path>) -> String {
    checkpoint.map_or_else(String::new, |path| {
        format!(", which `{}` keeps", path.display())
    })
}

/// A request that predicates don't support.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PredicateRefusal {
    /// The scene has an accuracy, for which parameters are chosen by the error of its picture.
    #[error(
        "the scene asks for an `accuracy`, which is that of its picture: write the parameters into \
         the scene that a predicate is counted with"
    )]
    Accuracy,
    /// One run for all channels is requested.
    #[error(
        "colour from one run takes the colours of all paths that are measured, whether or not a \
         predicate holds: choose three runs"
    )]
    OneRun,
    /// A search for primary hits is requested.
    #[error(
        "a predicate is a part of the circuit that finds primary hits itself: find primary hits \
         classically"
    )]
    Visibility,
    /// A checkpoint is requested. A checkpoint does not record a predicate.
    #[error("a checkpoint keeps pictures of all paths, and none of a predicate: ask for none")]
    Checkpoint,
}
