//! The phase of an amplitude in a phase register, and its angle theta.

use super::double::{self, Double};
use super::kernel::Register;

/// T theta as the nearest outcome and the offset from it, in [-1/2, 1/2].
///
/// The two are separate because their sum at T = 2^40 would leave 13 bits for the offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Phase {
    pub(crate) cell: u64,
    pub(crate) offset: f64,
}

impl Phase {
    pub(crate) fn new(theta: Double, register: &Register) -> Self {
        let steps = theta.scale(register.size() as f64);
        let nearest = steps.hi.round();
        let offset = (steps.hi - nearest) + steps.lo;
        // `hi` may be halfway between two integers although `hi + lo` is not.
        if offset < -0.5 {
            Self {
                cell: nearest as u64 - 1,
                offset: offset + 1.0,
            }
        } else if offset > 0.5 {
            Self {
                cell: nearest as u64 + 1,
                offset: offset - 1.0,
            }
        } else {
            Self {
                cell: nearest as u64,
                offset,
            }
        }
    }

    /// The phase `cell + remainder` grid steps from 0, in [0, T/2]; `remainder` is in [-1, 1].
    pub(crate) fn at(cell: u64, remainder: f64) -> Self {
        let nearest = remainder.round();
        Self {
            cell: cell.saturating_add_signed(nearest as i64),
            offset: remainder - nearest,
        }
    }

    /// The phase of `good` among `total` indices.
    pub(crate) fn from_counts(good: u64, total: u64, register: &Register) -> Self {
        Self::new(theta_of(good, total), register)
    }
}

/// asin(sqrt(good/total)) / pi to 104 bits; exact if it is a multiple of 1/4.
///
/// By Niven's theorem no other ratio has a theta on a grid whose size is a power of two.
pub(crate) fn theta_of(good: u64, total: u64) -> Double {
    if good == total - good {
        return Double::from(0.25);
    }
    let all = Double::from(total);
    double::theta(
        Double::from(good).divide(all),
        Double::from(total - good).divide(all),
    )
}
