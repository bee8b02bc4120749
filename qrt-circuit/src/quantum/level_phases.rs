//! The phases that a circuit turns a path's level into.

use super::{MAX_LEVEL_BITS, QuantumError};

/// A phase for each level of a colour: `phi = 2 arctan(slope (x - reference))`, x = level / 2^c.
///
/// A level is the number of thresholds, of `2^c`, that the colour exceeds. The phases of all levels
/// lie in (-pi, pi). They are rounded to multiples of `2^-bits` turns, as a table of the circuit
/// holds them.
///
/// ```
/// use qrt_circuit::quantum::LevelPhases;
/// // Four thresholds; a level of 1/4 above the reference has half a right angle, an eighth of a turn.
/// let phases = LevelPhases::new(1.656_854_25, 0.5, 2, 8)?;
/// assert_eq!((0..=4).map(|level| phases.word(level)).collect::<Vec<_>>(), [-56, -32, 0, 32, 56]);
/// # Ok::<(), qrt_circuit::quantum::QuantumError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelPhases {
    slope: f64,
    reference: f64,
    level_bits: u32,
    bits: u32,
}

impl LevelPhases {
    /// The fewest and the most bits of a phase.
    pub const BITS: std::ops::RangeInclusive<u32> = 2..=51;

    /// Creates the phases of the levels `0 ..= 2^level_bits`.
    ///
    /// # Errors
    /// A slope that is not positive and finite; a reference that is not in [0, 1]; more than
    /// [`MAX_LEVEL_BITS`] bits of levels; bits outside of [`LevelPhases::BITS`].
    pub fn new(
        slope: f64,
        reference: f64,
        level_bits: u32,
        bits: u32,
    ) -> Result<Self, QuantumError> {
        let inside = slope > 0.0 && slope.is_finite() && (0.0..=1.0).contains(&reference);
        if !inside {
            return Err(QuantumError::Slope);
        }
        if level_bits > MAX_LEVEL_BITS || !Self::BITS.contains(&bits) {
            return Err(QuantumError::LevelBits);
        }
        Ok(Self {
            slope,
            reference,
            level_bits,
            bits,
        })
    }

    /// The factor of a colour's distance from the reference.
    pub fn slope(&self) -> f64 {
        self.slope
    }

    /// The colour of phase 0, as a fraction of its scale.
    pub fn reference(&self) -> f64 {
        self.reference
    }

    /// c: there are `2^c` thresholds.
    pub fn level_bits(&self) -> u32 {
        self.level_bits
    }

    /// Number of bits of a phase: phases are multiples of `2^-bits` turns.
    pub fn bits(&self) -> u32 {
        self.bits
    }

    /// The phase of a level, in units of `2^-bits` turns: at most `2^(bits-1) - 1` to either side of 0,
    /// ascending with the level. A level above `2^c` has the phase of `2^c`.
    pub fn word(&self, level: u64) -> i64 {
        let all = 1_u64 << self.level_bits;
        let x = level.min(all) as f64 / all as f64;
        let half = libm::atan(self.slope * (x - self.reference));
        let most = (1_i64 << (self.bits - 1)) - 1;
        let word = half / std::f64::consts::PI * (1_u64 << self.bits) as f64;
        (word.round() as i64).clamp(-most, most)
    }
}
