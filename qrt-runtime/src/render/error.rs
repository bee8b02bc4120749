//! Why a picture isn't rendered.

use crate::checkpoint::CheckpointError;
use crate::counting::CountingError;
use crate::estimators::EstimatorError;
use crate::machines::Defect;
use crate::memory::MemoryError;
use crate::plan::PlanError;
use crate::search::RoundsError;
use crate::workers::ThreadsError;
use qrt_core::oracle::{OracleError, PredicateError};
use qrt_core::sampling::SamplingError;
use qrt_core::scene::Estimator;
use qrt_core::syntax::Problem;
use std::path::{Path, PathBuf};

/// Why a picture isn't rendered.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// No parameters keep the accuracy that the scene asks for.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// One run for all channels, and an estimator that measures no paths.
    #[error(
        "colour from one run is that of the paths which are measured, and the estimator `exact` \
         measures none: choose another estimator, or three runs"
    )]
    NothingMeasured,
    /// Noise of measurements, with an estimator that makes none.
    #[error(
        "noise is that of queries and measurements, and the estimator `exact` makes none: choose \
         another estimator, or no noise"
    )]
    NothingNoisy,
    /// A crop without pixels, or not within the film.
    #[error("{}", outside(.crop, *.film))]
    Crop {
        /// x, y, width, height.
        crop: [u32; 4],
        /// The film's width and height, in pixels.
        film: [u32; 2],
    },
    /// More paths than a 64-bit word counts.
    #[error(
        "{pixels} pixels of 2^{path_bits} paths are more than 2^64 paths, which no machine traces \
         in a lifetime: lower `sampling.path_bits`, or the film"
    )]
    TooManyPaths {
        /// Pixels to be rendered.
        pixels: u64,
        /// Paths of each, as a power of two.
        path_bits: u32,
    },
    /// Layers of a picture are asked for with a scene that is not its own.
    #[error("this is not the scene that the picture was rendered of")]
    OtherScene,
    /// More portions than the picture has pixels.
    #[error("a picture of {pixels} pixels can't be cut into {count} portions: ask for fewer")]
    Portions {
        /// How many portions.
        count: u32,
        /// Pixels of the picture.
        pixels: u64,
    },
    /// A picture that doesn't fit into memory.
    #[error("there is not enough memory for {pixels} pixels")]
    Memory {
        /// How many pixels it has.
        pixels: u64,
    },
    /// What would take more memory than it may, by an estimate.
    #[error(transparent)]
    WouldNotFit(#[from] MemoryError),
    /// The scene's circuit costs more than its `budget` allows, which
    /// [`qrt_core::front::Loaded::report`] shows at its place.
    #[error("the circuit is beyond the scene's budget: {}", first(.0))]
    Budget(Vec<Problem>),
    /// A bound on a path's colour so large that sums over paths would overflow.
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
    /// The sequence of paths can't be made.
    #[error(transparent)]
    Sampling(#[from] SamplingError),
    /// The scene has no circuit.
    #[error(transparent)]
    Oracle(#[from] OracleError),
    /// A circuit that was compiled does not do what is asked.
    #[error(transparent)]
    Compiled(#[from] CompiledError),
    /// Code that is no predicate of the scene's paths.
    #[error(transparent)]
    Predicate(#[from] PredicateError),
    /// What predicates are not asked with.
    #[error(transparent)]
    PredicateRefusal(#[from] PredicateRefusal),
    /// A path index beyond the last.
    #[error("there is no path {id}: a pixel has 2^{path_bits} paths, from 0 on")]
    PathIndex {
        /// The index.
        id: u64,
        /// Paths of a pixel, as a power of two.
        path_bits: u32,
    },
    /// A path has a number that the register cannot hold in which a predicate reads it.
    #[error(
        "a path of pixel ({}, {}) has a number beyond its register; this is a defect of qrt, please \
         report it with the scene",
        .pixel[0], .pixel[1]
    )]
    Unheld {
        /// Column and row on the film.
        pixel: [u32; 2],
    },
    /// A model that has no oracle, and so nothing to search with.
    #[error(
        "primary hits are searched for by a circuit, which the model `real` does not have: use \
         `fixed` or `gates`"
    )]
    SearchModel,
    /// An estimator that counts the indices of a superposition, where every path is searched by
    /// itself.
    #[error(
        "the estimator `{0}` counts paths in superposition, and primary hits are searched for path \
         by path: use `exact`, or find primary hits classically"
    )]
    SearchEstimator(Estimator),
    /// A name that pictures cannot tell.
    #[error(
        "`{name}` is no name of an estimator: 1 to 64 letters, digits, `_`, `-` or `.` of ASCII"
    )]
    OwnName {
        /// The name.
        name: String,
    },
    /// An estimator of one's own, where every path is searched by itself.
    #[error(
        "an estimator of one's own counts paths in superposition, and primary hits are searched for \
         path by path: find primary hits classically"
    )]
    OwnSearches,
    /// An estimator of one's own, with a scene whose parameters follow from what is known of those
    /// that there are.
    #[error(
        "the scene asks for an `accuracy`, which takes what is known of an estimator's error, and of \
         one of one's own nothing is: write the parameters into the scene"
    )]
    OwnAccuracy,
    /// A search that cannot be made.
    #[error(transparent)]
    Search(#[from] RoundsError),
    /// The circuit does not do what an oracle must: a defect of qrt. The picture would prove
    /// nothing, so there is none.
    #[error("{0}: a defect of qrt; the picture would prove nothing, so there is none")]
    Defect(#[from] Defect),
    /// The pixels can't be counted as asked.
    #[error(transparent)]
    Counting(#[from] CountingError),
    /// The estimator can't do what it is asked.
    #[error(transparent)]
    Estimator(#[from] EstimatorError),
    /// The threads can't be started.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
    /// The checkpoint can't be used.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// A path with a colour that is negative, not a number, or above the bound that was proven for it. It
    /// would be counted as the bound, and the picture would be too dark, so there is none.
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
        /// Fraction bits of the numbers of a circuit; none of the real model.
        fraction: Option<u32>,
    },
    /// The picture was cancelled before it was finished.
    #[error("interrupted after {finished} of {pixels} pixels{}", kept(.checkpoint.as_deref()))]
    Interrupted {
        /// Pixels that are finished.
        finished: u64,
        /// Pixels of the picture.
        pixels: u64,
        /// The checkpoint that keeps the finished tiles, if there is one.
        checkpoint: Option<PathBuf>,
    },
}

/// What the circuit of a scene of `qrt!` does not do. [`super::render`] does it with one that it
/// builds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CompiledError {
    /// The model runs no circuit.
    #[error(
        "a compiled circuit is run by the models `fixed` and `gates`; `real` runs none: choose one \
         of the two, or use `render`"
    )]
    Model,
    /// The scene's parameters are chosen when it is rendered, after its circuit was compiled.
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
    /// The circuit finds primary hits itself.
    #[error(
        "a compiled circuit finds primary hits itself, and none that are searched for: find \
         primary hits classically, or use `render`"
    )]
    Visibility,
}

impl RenderError {
    /// Whether it is the request that can't be met, rather than the job that failed: another
    /// attempt will fail alike.
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

fn first(problems: &[Problem]) -> String {
    let first = problems.first().map(|problem| problem.words().message);
    first.unwrap_or_default()
}

fn name(channel: usize) -> &'static str {
    ["red", "green", "blue", "luminance"]
        .get(channel)
        .copied()
        .unwrap_or("?")
}

/// Advice on a path whose colour is out of bounds, on a machine of `fraction` bits; the real model has none.
pub fn out_of_bounds_advice(fraction: Option<u32>) -> String {
    let report = "this is a defect of qrt, please report it with the scene";
    match fraction {
        None => report.to_owned(),
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

/// What predicates are not asked with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PredicateRefusal {
    /// The scene's parameters are chosen for the error of its picture.
    #[error(
        "the scene asks for an `accuracy`, which is that of its picture: write the parameters into \
         the scene that a predicate is counted with"
    )]
    Accuracy,
    /// One run for all channels.
    #[error(
        "colour from one run takes the colours of all paths that are measured, whether or not a \
         predicate holds: choose three runs"
    )]
    OneRun,
    /// Primary hits that are searched for.
    #[error(
        "a predicate is a part of the circuit that finds primary hits itself: find primary hits \
         classically"
    )]
    Visibility,
    /// A checkpoint, which does not know whose paths it keeps.
    #[error("a checkpoint keeps pictures of all paths, and none of a predicate: ask for none")]
    Checkpoint,
}
