//! Gates of a quantum circuit.

use crate::Qubit;
use std::f64::consts::TAU;

/// A gate on amplitudes. X, CNOT and Toffoli are those of [`super::super::Gate`], with the
/// classical parameters of a pixel built in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum QuantumGate<'a> {
    /// Flips a qubit.
    X(Qubit),
    /// Flips the second qubit where the first is 1.
    Cx(Qubit, Qubit),
    /// Flips the third qubit where the first and the second are 1.
    Ccx(Qubit, Qubit, Qubit),
    /// Hadamard: `|0> -> (|0> + |1>)/sqrt(2)`, `|1> -> (|0> - |1>)/sqrt(2)`.
    H(Qubit),
    /// `|0> -> cos(a/2) |0> + sin(a/2) |1>`, `|1> -> -sin(a/2) |0> + cos(a/2) |1>`.
    Ry {
        /// The angle a of the rotation, in radians.
        angle: f64,
        /// The qubit that is rotated.
        target: Qubit,
    },
    /// Multiplies by `exp(2 pi i turns)` where all of `on` are 1. On one qubit it is Z, S, T and
    /// the like, on two a controlled phase, on more a multi-controlled phase, on none the global
    /// phase.
    Phase {
        /// The phase, in turns.
        turns: Turns,
        /// The qubits that must all be 1, no two of them equal.
        on: &'a [Qubit],
    },
}

impl QuantumGate<'_> {
    /// Calls `each` for every qubit of the gate.
    pub fn qubits(&self, mut each: impl FnMut(Qubit)) {
        match *self {
            Self::X(t) | Self::H(t) | Self::Ry { target: t, .. } => each(t),
            Self::Cx(a, t) => [a, t].into_iter().for_each(each),
            Self::Ccx(a, b, t) => [a, b, t].into_iter().for_each(each),
            Self::Phase { on, .. } => on.iter().copied().for_each(each),
        }
    }
}

/// A phase of `numerator / 2^bits` turns, in lowest terms and in (-1/2, 1/2].
///
/// ```
/// use qrt_circuit::quantum::Turns;
/// assert_eq!(Turns::new(6, 3), Turns::new(-1, 2));
/// assert_eq!(Turns::HALF.factor(), [-1.0, 0.0]);
/// assert_eq!(Turns::new(-1, 2).factor(), [0.0, -1.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Turns {
    numerator: i64,
    bits: u32,
}

impl Turns {
    /// Half a turn: a phase flip, the factor -1.
    pub const HALF: Self = Self {
        numerator: 1,
        bits: 1,
    };

    /// The phase of `numerator / 2^bits` turns.
    ///
    /// # Panics
    /// If `bits` exceeds 52: f64 does not distinguish the angle from others.
    pub fn new(numerator: i64, bits: u32) -> Self {
        assert!(bits <= 52, "phases have at most 52 bits");
        let size = 1_i64 << bits;
        let within = numerator.rem_euclid(size);
        let spare = within.trailing_zeros().min(bits);
        let (within, bits) = (within >> spare, bits - spare);
        let size = size >> spare;
        Self {
            numerator: if 2 * within > size {
                within - size
            } else {
                within
            },
            bits,
        }
    }

    /// The numerator, odd unless the phase is 0.
    pub fn numerator(self) -> i64 {
        self.numerator
    }

    /// The exponent of the denominator: the phase is `numerator / 2^bits` turns.
    pub fn bits(self) -> u32 {
        self.bits
    }

    /// The phase in turns, in (-1/2, 1/2], without rounding.
    pub fn as_f64(self) -> f64 {
        self.numerator as f64 / (1_u64 << self.bits) as f64
    }

    /// Returns the phase that undoes this one: its negative.
    pub fn inverse(self) -> Self {
        Self::new(-self.numerator, self.bits)
    }

    /// Returns `exp(2 pi i turns)`, as real and imaginary part: exact at multiples of a quarter
    /// turn, elsewhere to an ulp.
    pub fn factor(self) -> [f64; 2] {
        let turns = self.as_f64();
        let quarter = (4.0 * turns).round();
        let rest = TAU * (turns - 0.25 * quarter);
        let (sine, cosine) = (libm::sin(rest), libm::cos(rest));
        match quarter as i64 & 3 {
            0 => [cosine, sine],
            1 => [0.0 - sine, cosine],
            2 => [-cosine, 0.0 - sine],
            _ => [sine, 0.0 - cosine],
        }
    }
}
