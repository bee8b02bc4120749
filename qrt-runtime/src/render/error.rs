//! Why a picture isn't rendered.

use super::one_run::OneRunError;
use crate::checkpoint::CheckpointError;
use crate::counting::CountingError;
use crate::estimators::EstimatorError;
use std::fmt;
use std::path::PathBuf;

/// Why a picture isn't rendered.
#[derive(Debug)]
#[non_exhaustive]
pub enum RenderError {
    /// The scene asks for an accuracy that no knobs reach, or that cannot be shown: why.
    Unreachable(String),
    /// One run for all channels, and an estimator that measures no paths.
    NothingMeasured,
    /// Noise of measurements, with an estimator that makes none.
    NothingNoisy,
    /// A crop without pixels, or not within the film.
    Crop {
        /// x, y, width, height.
        crop: [u32; 4],
        /// Width, height.
        film: [u32; 2],
    },
    /// More paths than a 64-bit word counts.
    TooManyPaths {
        /// Pixels to be rendered.
        pixels: u64,
        /// Paths of each.
        path_bits: u32,
    },
    /// A picture that doesn't fit into memory.
    Memory {
        /// Its pixels.
        pixels: u64,
    },
    /// A bound on a path's colour so large that sums over paths would overflow.
    Bound {
        /// 0, 1, 2: red, green, blue.
        channel: usize,
        /// The bound, in radiance.
        bound: f64,
    },
    /// The sequence of paths can't be made.
    Sampling(qrt_core::sampling::SamplingError),
    /// The scene has no circuit.
    Oracle(qrt_core::oracle::OracleError),
    /// A model that has no oracle, and so nothing to search with.
    SearchModel,
    /// An estimator that counts the ids of a superposition, where every path is searched by itself.
    SearchEstimator(qrt_core::scene::Estimator),
    /// A search that cannot be made.
    Search(crate::search::RoundsError),
    /// The circuit does not do what an oracle must: a defect of qrt. The picture would prove
    /// nothing, so there is none.
    Defect(crate::machines::Defect),
    /// The pixels can't be counted as asked.
    Counting(CountingError),
    /// The estimator can't do what it is asked.
    Estimator(EstimatorError),
    /// The threads can't be started.
    Threads(String),
    /// The checkpoint can't be used.
    Checkpoint(CheckpointError),
    /// Paths with a colour that is negative, not a number, or above the bound that was proven for
    /// it: a defect of qrt. The picture would be wrong, so there is none.
    OutOfBounds {
        /// Column and row on the film.
        pixel: [u32; 2],
        /// 0, 1, 2: red, green, blue.
        channel: usize,
        /// How many paths of the pixel.
        paths: u64,
        /// The colour of one of them.
        colour: f64,
        /// The bound.
        bound: f64,
    },
    /// Cancelled.
    Interrupted {
        /// Pixels that are finished.
        finished: u64,
        /// Pixels of the picture.
        pixels: u64,
        /// What is finished, if it is kept.
        checkpoint: Option<PathBuf>,
    },
}

impl RenderError {
    /// Whether it is the request that can't be met, rather than the job that failed: another
    /// attempt will fail alike.
    pub fn is_refusal(&self) -> bool {
        match self {
            Self::Unreachable(_)
            | Self::NothingMeasured
            | Self::NothingNoisy
            | Self::Crop { .. }
            | Self::TooManyPaths { .. }
            | Self::Bound { .. }
            | Self::Sampling(_)
            | Self::Oracle(_)
            | Self::SearchModel
            | Self::SearchEstimator(_)
            | Self::Search(_)
            | Self::Counting(_)
            | Self::Estimator(_) => true,
            Self::Checkpoint(error) => matches!(error, CheckpointError::Differs { .. }),
            Self::Memory { .. }
            | Self::Threads(_)
            | Self::Defect(_)
            | Self::OutOfBounds { .. }
            | Self::Interrupted { .. } => false,
        }
    }
}

fn name(channel: usize) -> &'static str {
    ["red", "green", "blue"]
        .get(channel)
        .copied()
        .unwrap_or("?")
}

impl fmt::Display for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreachable(why) => write!(f, "the scene's `accuracy` cannot be kept: {why}"),
            Self::NothingMeasured => write!(
                f,
                "colour from one run is that of the paths which are measured, and the estimator \
                 `exact` measures none: choose another estimator, or three runs"
            ),
            Self::NothingNoisy => write!(
                f,
                "noise is that of queries and measurements, and the estimator `exact` makes none: \
                 choose another estimator, or no noise"
            ),
            Self::Crop { crop, film } => {
                let [x, y, width, height] = crop;
                if *width == 0 || *height == 0 {
                    write!(f, "a crop of {width} x {height} has no pixels")
                } else {
                    let [w, h] = film;
                    write!(
                        f,
                        "a crop of {width} x {height} at ({x}, {y}) does not lie within the film \
                         of {w} x {h}"
                    )
                }
            }
            Self::TooManyPaths { pixels, path_bits } => write!(
                f,
                "{pixels} pixels of 2^{path_bits} paths are more than 2^64 paths, which no \
                 machine traces in a lifetime: lower `sampling.path_bits`, or the film"
            ),
            Self::Memory { pixels } => {
                write!(f, "there is not enough memory for {pixels} pixels")
            }
            Self::Bound { channel, bound } => write!(
                f,
                "a path's {} can only be bounded by {bound:e}, too large to sum: lower the \
                 radiance or the number of depths",
                name(*channel)
            ),
            Self::Sampling(error) => error.fmt(f),
            Self::Oracle(error) => error.fmt(f),
            Self::SearchModel => f.write_str(
                "first hits are searched for by a circuit, which the model `real` does not have: \
                 use `fixed` or `gates`",
            ),
            Self::SearchEstimator(estimator) => write!(
                f,
                "the estimator `{estimator}` counts paths in superposition, and first hits are \
                 searched for path by path: use `exact`, or find first hits classically"
            ),
            Self::Search(error) => error.fmt(f),
            Self::Defect(error) => write!(
                f,
                "{error}: a defect of qrt; the picture would prove nothing, so there is none"
            ),
            Self::Estimator(error) => error.fmt(f),
            Self::Counting(error) => error.fmt(f),
            Self::Threads(reason) => write!(f, "the threads cannot be started: {reason}"),
            Self::Checkpoint(error) => error.fmt(f),
            Self::OutOfBounds {
                pixel: [x, y],
                channel,
                paths,
                colour,
                bound,
            } => write!(
                f,
                "pixel ({x}, {y}): {paths} of its paths have a {} outside [0, {bound:e}], such as \
                 {colour:e}; this is a defect of qrt, please report it with the scene",
                name(*channel)
            ),
            Self::Interrupted {
                finished,
                pixels,
                checkpoint,
            } => {
                write!(f, "interrupted after {finished} of {pixels} pixels")?;
                match checkpoint {
                    Some(path) => write!(f, ", which `{}` keeps", path.display()),
                    None => Ok(()),
                }
            }
        }
    }
}

impl std::error::Error for RenderError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Sampling(error) => Some(error),
            Self::Oracle(error) => Some(error),
            Self::Search(error) => Some(error),
            Self::Defect(error) => Some(error),
            Self::Estimator(error) => Some(error),
            Self::Counting(error) => Some(error),
            Self::Checkpoint(error) => Some(error),
            _ => None,
        }
    }
}

impl From<qrt_core::sampling::SamplingError> for RenderError {
    fn from(error: qrt_core::sampling::SamplingError) -> Self {
        Self::Sampling(error)
    }
}

impl From<qrt_core::oracle::OracleError> for RenderError {
    fn from(error: qrt_core::oracle::OracleError) -> Self {
        Self::Oracle(error)
    }
}

impl From<crate::search::RoundsError> for RenderError {
    fn from(error: crate::search::RoundsError) -> Self {
        Self::Search(error)
    }
}

impl From<crate::machines::Defect> for RenderError {
    fn from(error: crate::machines::Defect) -> Self {
        Self::Defect(error)
    }
}

impl From<OneRunError> for RenderError {
    fn from(error: OneRunError) -> Self {
        match error {
            OneRunError::Estimator(error) => error.into(),
            OneRunError::Defect(defect) => defect.into(),
        }
    }
}

impl From<EstimatorError> for RenderError {
    fn from(error: EstimatorError) -> Self {
        Self::Estimator(error)
    }
}

impl From<CountingError> for RenderError {
    fn from(error: CountingError) -> Self {
        Self::Counting(error)
    }
}

impl From<CheckpointError> for RenderError {
    fn from(error: CheckpointError) -> Self {
        Self::Checkpoint(error)
    }
}
