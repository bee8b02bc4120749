//! Phase flips under many controls, as one gate or by Toffolis.

use super::QuantumGate::{Ccx, Phase};
use super::{QuantumGate, Turns};
use crate::Qubit;

/// The circuit of a phase flip that more than two qubits control.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Conjunction {
    /// One multi-controlled gate, without ancillas.
    #[default]
    Whole,
    /// Toffolis into ancillas that are zero, a phase flip on two qubits, and the Toffolis backwards
    /// (Barenco et al., *Elementary gates for quantum computation*, 1995, section 7): `2 (k - 2)`
    /// Toffolis and `k - 2` ancillas for `k` qubits. Within G the oracle's ancillas are reused.
    Toffolis,
}

impl Conjunction {
    /// Number of ancillas of a phase flip on `qubits` qubits.
    pub fn ancillas(self, qubits: u32) -> u32 {
        match self {
            Self::Whole => 0,
            Self::Toffolis => qubits.saturating_sub(2),
        }
    }

    /// Number of gates of a phase flip on `qubits` qubits.
    pub fn gates(self, qubits: u32) -> u64 {
        1 + 2 * u64::from(self.ancillas(qubits))
    }

    /// Flips the phase where all of `on` are 1. `ancillas` are zero before and after; their number
    /// is [`Conjunction::ancillas`].
    pub(super) fn sign<E>(
        self,
        on: &[Qubit],
        ancillas: &[Qubit],
        sink: &mut impl FnMut(QuantumGate<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        let needed = self.ancillas(on.len() as u32) as usize;
        if needed == 0 {
            return sink(Phase {
                turns: Turns::HALF,
                on,
            });
        }
        let ladder = |k: usize| {
            let below = if k == 0 { on[0] } else { ancillas[k - 1] };
            Ccx(below, on[k + 1], ancillas[k])
        };
        for k in 0..needed {
            sink(ladder(k))?;
        }
        sink(Phase {
            turns: Turns::HALF,
            on: &[ancillas[needed - 1], on[on.len() - 1]],
        })?;
        (0..needed).rev().try_for_each(|k| sink(ladder(k)))
    }
}
