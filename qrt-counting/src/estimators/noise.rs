//! Noise of a device.

use super::EstimatorError;
use super::id_bits;
use std::fmt;
use std::str::FromStr;

/// The noise model of a device.
///
/// *Depolarising*: with this probability a query leaves all qubits, those of the index and of the
/// phase register, in the maximally mixed state, where they stay. A shot of k queries is intact
/// with probability `(1 - depolarising)^k`. Otherwise every outcome is equally likely: an index is
/// good with probability S/N, and a phase register reads any value.
///
/// *Readout*: with this probability each measured bit is misread. On a phase register the bits are
/// flipped. A misread index is another index, which the model takes to be good with probability
/// S/N. It does not model the neighbours of an index.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Noise {
    /// Probability that a query destroys the state.
    pub depolarising: f64,
    /// Probability that a measured bit is wrong.
    pub readout: f64,
}

impl Noise {
    /// The noise of a perfect device: none.
    pub const NONE: Self = Self {
        depolarising: 0.0,
        readout: 0.0,
    };

    /// Checks that both probabilities are in [0, 1].
    ///
    /// # Errors
    /// A probability that is not in [0, 1].
    pub(crate) fn check(&self) -> Result<(), EstimatorError> {
        for probability in [self.depolarising, self.readout] {
            if !(0.0..=1.0).contains(&probability) {
                return Err(EstimatorError::Noise(probability));
            }
        }
        Ok(())
    }

    /// The probability that a state survives `queries` queries.
    pub(crate) fn intact(&self, queries: u64) -> f64 {
        survives(self.depolarising, queries)
    }

    /// The probability that a shot of the shifted circuit among `total` indices survives `queries`
    /// queries, and that its index and its coin are read correctly.
    pub(crate) fn coin_intact(&self, queries: u64, total: u64) -> f64 {
        self.intact(queries) * self.read_rightly(id_bits(total) + 1)
    }

    /// The probability that `bits` bits are all read correctly.
    pub(crate) fn read_rightly(&self, bits: u32) -> f64 {
        survives(self.readout, u64::from(bits))
    }
}

/// `(1 - each)^times`.
fn survives(each: f64, times: u64) -> f64 {
    if times == 0 {
        1.0
    } else if each >= 1.0 {
        0.0
    } else {
        libm::exp(times as f64 * libm::log1p(-each))
    }
}

impl fmt::Display for Noise {
    /// Writes the noise in the syntax of the command line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "depolarising={},readout={}",
            self.depolarising, self.readout
        )
    }
}

/// An error in the command line's syntax of [`Noise`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}; noise is written as `depolarising=1e-4,readout=0.01`, with probabilities in 0..=1")]
pub struct NoiseError(String);

impl FromStr for Noise {
    type Err = NoiseError;

    fn from_str(text: &str) -> Result<Self, NoiseError> {
        let mut noise = Self::NONE;
        let mut named = [false; 2];
        for part in text.split(',') {
            let (name, value) = part
                .split_once('=')
                .ok_or_else(|| NoiseError(format!("`{part}` has no `=`")))?;
            let value: f64 = (value.trim().parse())
                .map_err(|_| NoiseError(format!("`{value}` is not a number")))?;
            if !(0.0..=1.0).contains(&value) {
                return Err(NoiseError(format!("{value} is not a probability")));
            }
            let (place, slot) = match name.trim() {
                "depolarising" => (0, &mut noise.depolarising),
                "readout" => (1, &mut noise.readout),
                other => return Err(NoiseError(format!("there is no noise `{other}`"))),
            };
            if std::mem::replace(&mut named[place], true) {
                return Err(NoiseError(format!("`{}` is there twice", name.trim())));
            }
            *slot = value;
        }
        Ok(noise)
    }
}
