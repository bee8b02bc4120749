//! `chebyshev`: Chebyshev amplitude estimation.

use super::{Failures, Goal, Iterative, Multiples, Rules};
use crate::estimators::Settings;

impl Iterative {
    /// `chebyshev`: Chebyshev amplitude estimation (Rall & Fuller, *Amplitude estimation from
    /// quantum signal processing*, Quantum 2023).
    ///
    /// The estimator uses all multiples of theta, each at least twice the one before. For a state
    /// whose amplitude on the good indices is x, a circuit of d reflections measures the square of
    /// the Chebyshev polynomial `T_d(x)`. For odd d = 2k+1, that is the fraction of good indices
    /// after k iterations. For even d = 2k, it is the fraction of states that return when the
    /// preparation is undone after k iterations
    /// ([`Device::returned`](crate::estimators::Device::returned)). Both take k queries. Near the
    /// end, if a batch of shots would leave an error of less than 8 times the requested one,
    /// batches are small so that few shots are wasted. The authors take single shots; here a batch
    /// is a tenth of the shots taken at the query depth.
    ///
    /// The authors estimate x; here the estimate is S/N = x^2, and errors are errors of S/N.
    ///
    /// Interval: the last arc. The estimator looks at the shots at a query depth after every batch,
    /// so it uses only 0.6 of the authors' failure probability for that depth. At a confidence of
    /// 95 %, the coverage is 95 to 99 %.
    ///
    /// The estimator ignores noise: it takes fractions for those of a perfect device.
    pub fn chebyshev(settings: &Settings) -> Self {
        Self {
            goal: Goal::new(settings, 4.0),
            rules: Rules {
                multiples: Multiples::All,
                ratio: 2,
                // The authors take 100. With a given number of queries, fewer shots leave more
                // queries for the last query depth.
                shots: 20,
                failures: Failures::Equal,
                // The authors' nu.
                late: Some(8.0),
            },
        }
    }
}
