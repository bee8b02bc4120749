//! Gates that wait, as steps on amplitudes.

use super::super::StateVectorError;
use super::super::error::check_qubits;
use super::kernels::Kernel;
use num_complex::Complex;
use qrt_circuit::Qubit;
use qrt_circuit::quantum::{QuantumGate, Turns};
use std::f64::consts::FRAC_1_SQRT_2;

/// Steps that wait, and the difference between memory and the state after they have run.
#[derive(Clone, Debug, Default)]
pub(super) struct Plan {
    steps: Vec<Kernel>,
    /// The bits in which an index of memory and that of the state differ, because of Xs.
    pub(super) frame: usize,
    /// True if memory lacks a factor `1/sqrt(2)`.
    odd: bool,
}

impl Plan {
    pub(super) fn len(&self) -> usize {
        self.steps.len()
    }

    /// The factor by which memory must be multiplied.
    pub(super) fn scale(&self) -> f64 {
        if self.odd { FRAC_1_SQRT_2 } else { 1.0 }
    }

    /// Takes all steps that wait. A Hadamard's factor of `1/sqrt(2)` is kept back until there are
    /// two.
    pub(super) fn take_steps(&mut self) -> Vec<Kernel> {
        let mut steps = std::mem::take(&mut self.steps);
        for step in &mut steps {
            if let Kernel::Hadamards { mask, scale } = step {
                let factors = mask.count_ones() + u32::from(self.odd);
                *scale = 0.5_f64.powi((factors / 2) as i32);
                self.odd = factors % 2 == 1;
            }
        }
        steps
    }

    /// Adds a gate on a machine of `qubits` qubits.
    pub(super) fn gate(
        &mut self,
        gate: QuantumGate<'_>,
        qubits: u32,
    ) -> Result<(), StateVectorError> {
        match gate {
            QuantumGate::X(t) => {
                check_qubits(&[t], qubits)?;
                self.frame ^= 1 << t;
            }
            QuantumGate::Cx(a, t) => {
                check_qubits(&[a, t], qubits)?;
                self.flip(t, 1 << a);
            }
            QuantumGate::Ccx(a, b, t) => {
                check_qubits(&[a, b, t], qubits)?;
                self.flip(t, 1 << a | 1 << b);
            }
            QuantumGate::H(t) => {
                check_qubits(&[t], qubits)?;
                self.hadamard(t);
            }
            QuantumGate::Ry { angle, target } => {
                check_qubits(&[target], qubits)?;
                if !angle.is_finite() {
                    return Err(StateVectorError::Angle(angle));
                }
                let matrix = rotation(angle);
                let bit = 1 << target;
                // After an X on the target, the columns of the matrix are exchanged.
                let matrix = if self.frame & bit == 0 {
                    matrix
                } else {
                    matrix.map(|[a, b]| [b, a])
                };
                self.frame &= !bit;
                self.steps.push(Kernel::Rotate { target, matrix });
            }
            QuantumGate::Phase { turns, on } => {
                check_qubits(on, qubits)?;
                let mask = on.iter().fold(0, |mask, qubit| mask | 1 << qubit);
                self.phase(turns, mask);
            }
        }
        Ok(())
    }

    fn flip(&mut self, target: Qubit, mask: usize) {
        let value = mask & !self.frame;
        self.steps.push(Kernel::Flip {
            target,
            mask,
            value,
        });
    }

    fn phase(&mut self, turns: Turns, mask: usize) {
        let [re, im] = turns.factor();
        self.steps.push(Kernel::Phase {
            factor: Complex::new(re, im),
            mask,
            value: mask & !self.frame,
        });
    }

    /// Adds a Hadamard. H X = Z H: an X that waits becomes a Z.
    fn hadamard(&mut self, target: Qubit) {
        let bit = 1 << target;
        let flipped = self.frame & bit != 0;
        self.frame &= !bit;
        match self.steps.last_mut() {
            Some(Kernel::Hadamards { mask, .. }) if *mask & bit == 0 => *mask |= bit,
            _ => self.steps.push(Kernel::Hadamards {
                mask: bit,
                scale: 1.0,
            }),
        }
        if flipped {
            self.phase(Turns::HALF, bit);
        }
    }
}

/// Ry's matrix.
pub(in crate::statevector) fn rotation(angle: f64) -> [[f64; 2]; 2] {
    let (sine, cosine) = (libm::sin(0.5 * angle), libm::cos(0.5 * angle));
    [[cosine, -sine], [sine, cosine]]
}
