//! Which settings are measured: around the scene's own, one knob at a time, and every estimator with
//! every number of queries.

use super::setting::{Setting, Sweep};
use crate::render::Model;
use qrt_core::scene::{Estimator, Nearest, Sequence, Uncompute};
use qrt_core::valid::{Knobs, MAX_NET_DEPTHS};

/// Registers that are halved before they are repeated: as many as make up for up to 32 repetitions.
const HALVED: u32 = 4;

/// The rows, in their order. `quick` leaves out every other value, and what takes longest.
pub(super) fn settings(knobs: &Knobs, quick: bool) -> Vec<Setting> {
    let scene = Setting::of(knobs);
    let step = if quick { 2 } else { 1 };
    let mut rows = vec![scene];
    let of = |sweep| Setting { sweep, ..scene };

    let most = scene.phase_bits.max(12) + if quick { 0 } else { 2 };
    let least = if quick { 4 } else { 2 };
    for &estimator in Estimator::ALL {
        if estimator == Estimator::Exact {
            continue;
        }
        rows.extend(
            (least..=most.min(40))
                .step_by(step)
                .map(|phase_bits| Setting {
                    estimator,
                    phase_bits,
                    repetitions: 1,
                    ..of(Sweep::Counting)
                }),
        );
    }
    let mut repeated = vec![Estimator::Paper];
    if ![Estimator::Paper, Estimator::Exact].contains(&scene.estimator) {
        repeated.insert(0, scene.estimator);
    }
    for estimator in repeated {
        rows.extend((0..=5).map(|k| Setting {
            estimator,
            phase_bits: scene.phase_bits.saturating_sub(HALVED).max(3),
            repetitions: 1 << k,
            ..of(Sweep::Repetitions)
        }));
    }
    rows.extend((2..=16).step_by(step).map(|comparator_bits| Setting {
        comparator_bits,
        ..of(Sweep::Comparator)
    }));
    let fractions = (6..=24_u32).step_by(2 * step);
    rows.extend(fractions.map(|fraction| Setting {
        fraction,
        ..of(Sweep::Fraction)
    }));
    let most = (scene.path_bits + 2).clamp(10, 18);
    for sequence in [Sequence::DigitalNet, Sequence::ProductLattice] {
        let bits = (4..=most).step_by(step);
        rows.extend(bits.map(|path_bits| Setting {
            sequence,
            path_bits,
            ..of(Sweep::Paths)
        }));
    }
    for (uncompute, nearest) in [
        (Uncompute::Keep, Nearest::Running),
        (Uncompute::Scoped, Nearest::Running),
        (Uncompute::Keep, Nearest::Paper),
        (Uncompute::Scoped, Nearest::Paper),
    ] {
        rows.push(Setting {
            uncompute,
            nearest,
            ..of(Sweep::Circuit)
        });
    }
    rows.extend(Model::ALL.map(|model| Setting {
        model,
        ..of(Sweep::Model)
    }));
    if scene.sequence == Sequence::DigitalNet {
        let most = (scene.depths + 2).min(MAX_NET_DEPTHS);
        rows.extend((1..=most).map(|depths| Setting {
            depths,
            ..of(Sweep::Depth)
        }));
    }
    rows
}
