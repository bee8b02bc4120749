//! Preparation of the phase register in a window.
//!
//! *Rectangular*: Hadamards.
//!
//! *Sine*: `w_j = sqrt(2/(T+1)) sin(a (j+1))`, `a = pi/(T+1)`. The bits are prepared from the top
//! down. The bits that are fixed so far determine an angle. Let x be the middle of the angles that
//! are still open while m bits are open. The squares of the amplitudes under it sum to a multiple
//! of
//!
//! ```text
//! (1 - D_m) cos(x)^2 + (1 + D_m) sin(x)^2,    D_m = sin(2^m a) / (2^m sin(a)),
//! ```
//!
//! One *bond* qubit with amplitudes `sqrt(1 - D_m) cos(x)` and `sqrt(1 + D_m) sin(x)` therefore
//! carries all the information that the bits below need: the state is a matrix product of bond
//! dimension 2. The next bit moves x by `+-b`, `b = 2^(m-2) a`. With the bit in the basis |+>, |->,
//! that takes the bond's |0> to `c |0>|+> - s |1>|->` and |1> to `c |1>|+> + s |0>|->`, with c and
//! s of the bond's value: a rotation of the bit that the bond selects, a CNOT from the bit to the
//! bond, and a Hadamard on the bit. At the top, x is a quarter turn and the bond is |1>. At the
//! bottom, D_0 = 1, and the bond is |1> again. So T amplitudes take 2 t rotations, 3 t CNOTs and no
//! ancilla but the bond, which returns to zero. (Schoen et al., *Sequential generation of entangled
//! multiqubit states*, 2005, prepare matrix product states by this staircase.)

use super::QuantumGate;
use super::QuantumGate::{Cx, H, Ry, X};
use crate::Qubit;
use std::f64::consts::PI;
use std::fmt;

/// The window on the phase register.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Window {
    /// Equal amplitudes, as in the paper.
    Rect,
    /// Amplitudes w_j proportional to sin(pi (j + 1) / (T + 1)).
    Sine,
}

impl Window {
    /// The window's name: `rect` or `sine`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rect => "rect",
            Self::Sine => "sine",
        }
    }
}

impl fmt::Display for Window {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// True if the window needs a bond qubit.
pub(super) fn has_bond(window: Window) -> bool {
    window == Window::Sine
}

/// Number of gates that prepare a register of `bits` qubits.
pub(super) fn gates(window: Window, bits: u32) -> u64 {
    match window {
        Window::Rect => u64::from(bits),
        Window::Sine => 6 * u64::from(bits) + 2,
    }
}

/// Emits the preparation of `register`, which is zero, bit 0 first. `bond` is zero before and
/// after. The rectangular window does not use it.
pub(super) fn prepare<E>(
    window: Window,
    register: &[Qubit],
    bond: Qubit,
    sink: &mut impl FnMut(QuantumGate<'_>) -> Result<(), E>,
) -> Result<(), E> {
    if window == Window::Rect {
        return register.iter().try_for_each(|qubit| sink(H(*qubit)));
    }
    let angles = angles(register.len() as u32);
    sink(X(bond))?;
    for (qubit, [zero, one]) in register.iter().zip(&angles).rev() {
        // The angle is `zero` where the bond is 0, and `one` where it is 1: a CNOT mirrors the
        // second half.
        let steps = [
            Ry {
                angle: (zero + one) / 2.0,
                target: *qubit,
            },
            Cx(bond, *qubit),
            Ry {
                angle: (zero - one) / 2.0,
                target: *qubit,
            },
            Cx(bond, *qubit),
            Cx(*qubit, bond),
            H(*qubit),
        ];
        steps.into_iter().try_for_each(&mut *sink)?;
    }
    sink(X(bond))
}

/// Returns the angles in radians by which a bond of 0 and a bond of 1 rotate each bit.
fn angles(bits: u32) -> Vec<[f64; 2]> {
    let step = PI / ((1_u64 << bits) as f64 + 1.0);
    let (mut angles, mut ratio, mut rest) = (Vec::new(), 1.0, 0.0);
    for bit in 0..bits {
        // D_0 = 1, D_(m+1) = D_m cos(2^m a). 1 - D is summed separately: it is small where a is.
        let half = 0.5 * (1_u64 << bit) as f64 * step;
        let (sine, cosine) = (libm::sin(half), libm::cos(half));
        let ([even, odd], below) = ([f64::sqrt(rest), f64::sqrt(1.0 + ratio)], ratio);
        let zero = -2.0 * libm::atan2(odd * sine, even * cosine);
        let one = 2.0 * libm::atan2(even * sine, odd * cosine);
        angles.push([zero, one]);
        rest += 2.0 * below * sine * sine;
        ratio = below * (1.0 - 2.0 * sine * sine);
    }
    angles
}
