//! Checks of counting. Strata of the comparator need an estimator that counts them, and enough
//! bits. An error to stop at needs an estimator that stops by itself. `phase-mean` needs a comparator
//! of few bits.

use crate::scene::{Counting, Estimator, Scene};
use qrt_circuit::quantum::MAX_LEVEL_BITS;
use qrt_syntax::{Path, Problem, Problems, Sampling as Fault};

/// Most pixels of a picture that `auto` counts where no estimator is written. It needs fewer queries than `sine`, and
/// is simulated some thirty times longer: for this many pixels, half a minute of processor time.
const MOST_PIXELS: u64 = 4096;

/// Chooses the estimator of a large picture where none is written, and nothing that only some estimators do is asked.
/// Returns whether it did.
pub(super) fn choose_by_size(scene: &mut Scene) -> bool {
    let Counting {
        estimator,
        strata,
        error,
        ..
    } = scene.counting;
    let counts_strata = strata.is_some_and(|strata| strata > 1);
    let needs_auto = scene.accuracy.is_some() || error.is_some() || counts_strata;
    let is_large = u64::from(scene.film.width) * u64::from(scene.film.height) > MOST_PIXELS;
    let chosen = estimator.is_none() && !needs_auto && is_large;
    if chosen {
        scene.counting.estimator = Some(Estimator::Sine);
    }
    chosen
}

pub(super) fn check(scene: &Scene, problems: &mut Problems) {
    check_strata(scene, problems);
    let estimator = scene.counting.estimator();
    let (bits, most) = (scene.comparator.bits, MAX_LEVEL_BITS);
    if estimator == Estimator::PhaseMean && bits > most {
        let what = Fault::LevelBits {
            bits,
            most,
            estimator: estimator.name(),
            counting: Estimator::Auto.name(),
        };
        let path = Path::root().key("counting").key("estimator");
        problems.push(Problem::new(path, what).also(Path::root().key("comparator").key("bits")));
    }
    if scene.counting.error.is_some() && !estimator.stops_itself() {
        let counting = Path::root().key("counting");
        let what = Fault::NeverStops {
            estimator: estimator.name(),
            stopping: Estimator::AdaptiveBayes.name(),
        };
        problems.push(Problem::new(counting.key("error"), what).also(counting.key("estimator")));
    }
}

fn check_strata(scene: &Scene, problems: &mut Problems) {
    let Some(strata @ 2..) = scene.counting.strata else {
        return;
    };
    let counting = Path::root().key("counting");
    let path = counting.key("strata");
    let estimator = scene.counting.estimator();
    if !estimator.counts_strata() {
        let what = Fault::NoStrata {
            strata,
            estimator: estimator.name(),
            counting: Estimator::AdaptiveBayes.name(),
        };
        problems.push(Problem::new(path, what).also(counting.key("estimator")));
        return;
    }
    let bits = scene.comparator.bits;
    let most = scene.comparator.most_strata();
    if strata > most {
        let what = Fault::TooManyStrata { strata, bits, most };
        problems.push(Problem::new(path, what).also(Path::root().key("comparator").key("bits")));
    }
}
