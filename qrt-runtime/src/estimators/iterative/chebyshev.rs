//! `chebyshev`: Chebyshev amplitude estimation.

use super::{Failures, Goal, Iterative, Multiples, Rules};
use crate::estimators::Settings;

impl Iterative {
    /// `chebyshev`: Chebyshev amplitude estimation (Rall & Fuller, *Amplitude estimation from
    /// quantum signal processing*, Quantum 2023).
    ///
    /// All multiples of theta, each at least twice the one before. Of a state whose amplitude on
    /// the good indices is x, a circuit of d reflections shows the square of the Chebyshev
    /// polynomial `T_d(x)`: for odd d = 2k+1 as the fraction of good indices after k iterations,
    /// for even d = 2k as the fraction of states that return when the preparation is undone after k
    /// ([`Device::returned`](crate::estimators::Device::returned)). Both take k queries.
    /// Near the end, when a batch of shots would leave
    /// an error of less than 8 times the one that is asked, shots are taken in small numbers (the
    /// authors: one by one; here a tenth of those taken at the query depth), so that few are
    /// wasted.
    ///
    /// The authors estimate x; here it is S/N = x^2, and errors are errors of that.
    ///
    /// Interval: the last arc. Shots at a query depth are looked at after every batch, so that the
    /// failure probability at it is taken to be 0.6 of what the authors give it. At a confidence of
    /// 95 %, the coverage is 95 to 99 %.
    ///
    /// Noise is not reckoned with: fractions are taken for those of a perfect device.
    pub fn chebyshev(settings: &Settings) -> Self {
        Self {
            goal: Goal::new(settings, 4.0),
            rules: Rules {
                multiples: Multiples::All,
                ratio: 2,
                // The authors take 100; with a given number of queries, fewer leave more for the
                // last query depth.
                shots: 20,
                failures: Failures::Equal,
                // The authors' nu.
                late: Some(8.0),
            },
        }
    }
}
