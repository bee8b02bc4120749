//! The settings that are measured.
//!
//! They vary the scene's parameters one at a time, and combine every estimator with every number of
//! queries.

use super::setting::{Setting, Sweep};
use qrt_runtime::models::Model;
use qrt_scene::valid::{MAX_NET_DEPTHS, Parameters};
use qrt_scene::{Estimator, Nearest, Sequence, Uncompute};

/// Number of times that a register is halved before it is repeated, to make up for up to 32
/// repetitions.
const HALVED: u32 = 4;

/// The rows, in their order. `quick` leaves out every other value, and those that take longest.
pub(super) fn settings(parameters: &Parameters, quick: bool) -> Vec<Setting> {
    let scene = Setting::from_parameters(parameters);
    let step = if quick { 2 } else { 1 };
    let of = |sweep| Setting { sweep, ..scene };
    let mut rows = vec![scene];
    rows.extend(counting(of(Sweep::Counting), quick, step));
    rows.extend(repetitions(of(Sweep::Repetitions)));
    rows.extend(strata(of(Sweep::Strata)));
    rows.extend((2..=16).step_by(step).map(|comparator_bits| Setting {
        comparator_bits,
        ..of(Sweep::Comparator)
    }));
    let fractions = (6..=24_u32).step_by(2 * step);
    rows.extend(fractions.map(|fraction| Setting {
        fraction,
        ..of(Sweep::Fraction)
    }));
    rows.extend(paths(of(Sweep::Paths), step));
    rows.extend(circuits(of(Sweep::Circuit)));
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
    rows.extend(beside_rivals(of(Sweep::BesideRivals), quick, step));
    rows.extend(rivals(scene, step));
    rows
}

/// Settings of the scene's estimator, or of `auto` if that is `exact`, for the comparison with rivals.
fn beside_rivals(scene: Setting, quick: bool, step: usize) -> impl Iterator<Item = Setting> {
    let own = match scene.estimator {
        Estimator::Exact => Estimator::Auto,
        own => own,
    };
    let rows = counting(scene, quick, step);
    rows.filter(move |row| row.estimator == own)
}

/// Classical pictures with growing numbers of paths.
fn rivals(scene: Setting, step: usize) -> impl Iterator<Item = Setting> {
    // Random paths go further, because the law of their error is known.
    let sweeps = [(Sweep::RandomPaths, 8), (Sweep::ClassicalNet, 0)];
    sweeps.into_iter().flat_map(move |(sweep, more)| {
        let bits = (0..=most_paths(&scene) + more).step_by(step);
        bits.map(move |path_bits| Setting {
            sweep,
            model: Model::Real,
            estimator: Estimator::Exact,
            sequence: Sequence::DigitalNet,
            path_bits,
            ..scene
        })
    })
}

/// Path bits of the largest net that is tried.
pub(super) fn most_paths(scene: &Setting) -> u32 {
    (scene.path_bits + 2).clamp(10, 18)
}

/// Every estimator with registers of every size.
fn counting(scene: Setting, quick: bool, step: usize) -> impl Iterator<Item = Setting> {
    let most = scene.phase_bits.max(12) + if quick { 0 } else { 2 };
    let least = if quick { 4 } else { 2 };
    let counted = Estimator::ALL.iter().filter(|&&e| e != Estimator::Exact);
    counted.flat_map(move |&estimator| {
        let bits = (least..=most.min(40)).step_by(step);
        bits.map(move |phase_bits| Setting {
            estimator,
            phase_bits,
            repetitions: 1,
            ..scene
        })
    })
}

/// Repetitions of a smaller register: for the scene's estimator, if it counts, and for the paper's.
fn repetitions(scene: Setting) -> impl Iterator<Item = Setting> {
    let mut repeated = vec![Estimator::Paper];
    if ![Estimator::Paper, Estimator::Exact].contains(&scene.estimator) {
        repeated.insert(0, scene.estimator);
    }
    repeated.into_iter().flat_map(move |estimator| {
        (0..=5).map(move |k| Setting {
            estimator,
            phase_bits: scene.phase_bits.saturating_sub(HALVED).max(3),
            repetitions: 1 << k,
            ..scene
        })
    })
}

/// Numbers of strata that the comparator allows, for an estimator that counts them.
fn strata(scene: Setting) -> impl Iterator<Item = Setting> {
    let estimator = if scene.estimator.counts_strata() {
        scene.estimator
    } else {
        Estimator::AdaptiveBayes
    };
    let most = scene.most_strata();
    let numbers = [1, 2, 3, 4, 6].into_iter().filter(move |n| *n <= most);
    let all = numbers.map(Some).chain([None]);
    all.map(move |strata| Setting {
        estimator,
        strata,
        ..scene
    })
}

/// Paths of either sequence.
fn paths(scene: Setting, step: usize) -> impl Iterator<Item = Setting> {
    let most = most_paths(&scene);
    let sequences = [Sequence::DigitalNet, Sequence::ProductLattice];
    sequences.into_iter().flat_map(move |sequence| {
        let bits = (4..=most).step_by(step);
        bits.map(move |path_bits| Setting {
            sequence,
            path_bits,
            ..scene
        })
    })
}

/// Settings of the circuit: combinations of `uncompute` and `nearest`.
fn circuits(scene: Setting) -> impl Iterator<Item = Setting> {
    [Nearest::Running, Nearest::Paper]
        .into_iter()
        .flat_map(move |nearest| {
            [Uncompute::Keep, Uncompute::Scoped].map(|uncompute| Setting {
                uncompute,
                nearest,
                ..scene
            })
        })
}
