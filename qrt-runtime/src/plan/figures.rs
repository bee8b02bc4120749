//! The parameters that a plan chose, and the errors and costs that it expects.

use qrt_core::inspect::grouped;
use qrt_core::oracle::CallCost;
use qrt_scene::{Accuracy, Estimator, Sequence};
use std::fmt;

/// Errors at the requested confidence, in units of the mean radiance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "parts", derive(serde::Serialize, serde::Deserialize))]
pub struct ErrorParts {
    /// The error of a finite number of paths.
    pub paths: f64,
    /// The error of comparing with a finite number of thresholds.
    pub comparators: f64,
    /// The error of numbers of finite width.
    pub width: f64,
    /// The error of estimating amplitudes from measurements.
    pub counting: f64,
    /// The error of all parts combined, which is not their sum.
    pub total: f64,
}

/// The parameters that a plan chose, and the errors and costs that it expects.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "parts", derive(serde::Serialize, serde::Deserialize))]
pub struct PlanFigures {
    /// The error and the confidence that the scene asks for.
    #[cfg_attr(feature = "parts", serde(with = "crate::serialized::AccuracyFields"))]
    pub accuracy: Accuracy,
    /// The mean radiance over channels and the sampled pixels of the picture.
    pub mean: f64,
    /// Number of pixels in the sample, and number of pixels of the film.
    pub pixels: [u64; 2],
    /// The map from path indices to points, as in the scene.
    #[cfg_attr(feature = "parts", serde(with = "crate::serialized::word"))]
    pub sequence: Sequence,
    /// Chosen: R = 2^path_bits.
    pub path_bits: u32,
    /// True if the error of that number of paths was extrapolated instead of measured.
    pub extrapolated: bool,
    /// Chosen: fraction bits; `None` if the scene has no circuit.
    pub fraction: Option<u32>,
    /// Chosen: C = 2^comparator_bits.
    pub comparator_bits: u32,
    /// The estimator that the plan is for.
    #[cfg_attr(feature = "parts", serde(with = "crate::serialized::word"))]
    pub estimator: Estimator,
    /// Chosen: T = 2^phase_bits.
    pub phase_bits: u32,
    /// Chosen: B, the runs of the counting circuit.
    pub repetitions: u32,
    /// Chosen: half the width of the interval, in radiance, at which a channel stops; `None` if all
    /// queries are used.
    pub error: Option<f64>,
    /// The expected fraction of channels within the requested error.
    pub within: f64,
    /// The parts of the error, in units of the mean radiance.
    pub parts: ErrorParts,
    /// Mean queries of a pixel, for all channels together.
    pub queries: f64,
    /// Mean queries of a pixel for red, green and blue.
    pub channel_queries: [f64; 3],
    /// The cost of one call of the most expensive of the scene's oracles; `None` if the scene has
    /// no circuit.
    #[cfg_attr(feature = "parts", serde(with = "crate::serialized::call_cost"))]
    pub cost: Option<CallCost>,
}

impl fmt::Display for PlanFigures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Accuracy { error, confidence } = self.accuracy;
        let [pixels, film] = self.pixels.map(grouped);
        writeln!(
            f,
            "plan for an error of {error} of the mean radiance {:.4} with probability {confidence}, \
             tried on {pixels} of {film} pixels:",
            self.mean
        )?;
        write!(
            f,
            "  sampling.path_bits {}, precision.fraction ",
            self.path_bits
        )?;
        match self.fraction {
            Some(fraction) => write!(f, "{fraction}")?,
            None => write!(f, "auto")?,
        }
        write!(
            f,
            ", comparator.bits {}, counting.phase_bits {}, repetitions {}, estimator {}",
            self.comparator_bits, self.phase_bits, self.repetitions, self.estimator
        )?;
        match self.error {
            Some(error) => writeln!(f, ", error {error:.3e}")?,
            None => writeln!(f)?,
        }
        let ErrorParts {
            paths,
            comparators,
            width,
            counting,
            total,
        } = self.parts;
        writeln!(
            f,
            "  errors at that probability: paths {paths:.2e}, comparators {comparators:.2e}, width \
             {width:.2e}, counting {counting:.2e}; all together {total:.2e}, within {error} for {:.1} \
             % of channels",
            100.0 * self.within
        )?;
        if self.extrapolated {
            writeln!(
                f,
                "  the error of 2^{} paths follows from how it falls up to 2^{}",
                self.path_bits,
                super::MOST_TRIED
            )?;
        }
        let queries = grouped(self.queries.round() as u64);
        match self.cost {
            Some(CallCost { qubits, toffoli }) => writeln!(
                f,
                "  {queries} queries a pixel x {} Toffoli = {:.2e}, on {} qubits",
                grouped(toffoli),
                self.queries * toffoli as f64,
                grouped(qubits)
            ),
            None => writeln!(f, "  {queries} queries a pixel; the scene has no circuit"),
        }
    }
}
