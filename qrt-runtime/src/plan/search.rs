//! Searches for the cheapest parameters that keep the accuracy.

use super::pilot::{Errors, FEWEST, Pilot, quantile, unreachable, valid};
use super::together::{each_total, failing, will_do};
use super::{ErrorParts, Plan, PlanError, PlanFigures};
use qrt_core::oracle::{CallCost, DEFAULT_FRACTION};
use qrt_scene::{Counting, Estimator, Sequence};

/// The largest number of path bits, including extrapolated ones.
const MOST_PATHS: u32 = 32;
/// The fraction of the queries that each further path bit must save.
const WORTH: f64 = 0.0625;
/// Number of path bits to look ahead: registers grow by doubling, so a saving may need several
/// bits.
const AHEAD: u32 = 3;
/// Phase bits at which a search begins.
const START: u32 = 6;
/// The largest number of phase bits.
const MOST_PHASE: u32 = 40;
/// Further phase bits, each of which doubles the queries, for an estimator that stops each channel
/// by itself: some channels need more queries than the register that suffices if all use it fully.
const SPARE: u32 = 2;
/// The range of errors at which estimators may stop, in steps of a factor 2^(1/STEPS) from the
/// requested error.
const WIDTHS: [i32; 2] = [-32, 64];
const STEPS: f64 = 32.0;
/// Fraction bits that are tried.
const FRACTIONS: std::ops::RangeInclusive<u32> = 8..=30;
/// With more polygons than this, building a circuit takes long, so fewer fraction bits are tried.
const MANY_POLYGONS: usize = 200;

/// Fraction bits, the error with them, and the cost of a call.
type Width = (u32, Errors, CallCost);

/// A counting block, its errors and its queries.
#[derive(Clone)]
struct Counted {
    counting: Counting,
    errors: Vec<Errors>,
    channel_queries: [f64; 3],
}

impl Counted {
    /// Mean queries of a pixel.
    fn queries(&self) -> f64 {
        self.channel_queries.iter().sum()
    }
}

pub(super) fn search(mut pilot: Pilot<'_>) -> Result<Plan, PlanError> {
    if pilot.mean <= 0.0 {
        // The picture is proven black: there is nothing to count, and no error.
        let path_bits = pilot_bits(&pilot, FEWEST);
        return finish(&mut pilot, path_bits, None, None);
    }
    let (path_bits, counted) = choose_paths(&mut pilot)?;
    let (width, counted) = choose_width(&mut pilot, path_bits, counted)?;
    finish(&mut pilot, path_bits, width, Some(counted))
}

/// Returns `bits` for a net; for a lattice, its own path bits.
fn pilot_bits(pilot: &Pilot<'_>, bits: u32) -> u32 {
    let sampling = &pilot.scene.scene().sampling;
    match sampling.sequence {
        Sequence::DigitalNet => bits,
        Sequence::ProductLattice => sampling.path_bits,
    }
}

/// Chooses the smallest number of paths beyond which more paths save few queries. The choice holds
/// for numbers of any width.
fn choose_paths(pilot: &mut Pilot<'_>) -> Result<(u32, Counted), PlanError> {
    let none = vec![[0.0; 3]; pilot.pixels.len()];
    if pilot.is_lattice() {
        let counted = cheapest(pilot, 0, &none, START)?.ok_or_else(|| out_of_reach(pilot, 0))?;
        return Ok((pilot_bits(pilot, 0), counted));
    }
    let mut chosen: Option<(u32, Counted)> = None;
    for bits in FEWEST..=MOST_PATHS {
        if !alone_will_do(pilot, bits)? {
            continue;
        }
        let start = chosen
            .as_ref()
            .map_or(START, |(_, before)| before.counting.phase_bits);
        let Some(counted) = cheapest(pilot, bits, &none, start)? else {
            continue;
        };
        if let Some((fewer, before)) = &chosen {
            let more = bits - fewer;
            let worth = (1.0 - WORTH).powi(more as i32);
            if counted.queries() >= worth * before.queries() {
                if more >= AHEAD {
                    break;
                }
                continue;
            }
        }
        let exact = pilot.estimator == Estimator::Exact;
        chosen = Some((bits, counted));
        if exact {
            break;
        }
    }
    chosen.ok_or_else(|| out_of_reach(pilot, MOST_PATHS))
}

/// Returns whether the errors of paths and comparators alone keep the accuracy, so that an error of
/// counting may be added.
fn alone_will_do(pilot: &mut Pilot<'_>, bits: u32) -> Result<bool, PlanError> {
    let (paths, _) = pilot.paths(bits)?;
    Ok(will_do(pilot, &[&paths, &pilot.comparator_errors], None))
}

fn out_of_reach(pilot: &Pilot<'_>, bits: u32) -> PlanError {
    let (error, confidence) = (pilot.accuracy.error, pilot.accuracy.confidence);
    unreachable(if pilot.is_lattice() {
        format!(
            "the product lattice with these bits, and any number of queries of `{}`, do not reach an \
             error of {error} with probability {confidence}: use `sequence: digital-net`, or more bits",
            pilot.estimator
        )
    } else {
        format!(
            "neither 2^{bits} paths nor any number of queries of `{}` reach an error of {error} with \
             probability {confidence}",
            pilot.estimator
        )
    })
}

/// Chooses the width of numbers with the smallest product of queries and Toffolis; `None` if there
/// is no circuit.
fn choose_width(
    pilot: &mut Pilot<'_>,
    path_bits: u32,
    wide: Counted,
) -> Result<(Option<Width>, Counted), PlanError> {
    let many = pilot.scene.surface_of_faces().len() > MANY_POLYGONS;
    let (first, step) = if many {
        (DEFAULT_FRACTION, 4)
    } else {
        (*FRACTIONS.start(), 1)
    };
    let mut best: Option<(f64, Width, Counted)> = None;
    let mut has_circuit = false;
    for fraction in (first..=*FRACTIONS.end()).step_by(step) {
        let Some((errors, spent)) = pilot.width(path_bits, fraction)? else {
            if has_circuit {
                break;
            }
            continue;
        };
        has_circuit = true;
        // A lower bound: the cost if this width had no error. Wider numbers cost more.
        let least = spent.toffoli as f64 * wide.queries().max(1.0);
        if best.as_ref().is_some_and(|best| best.0 <= least) {
            break;
        }
        let start = wide.counting.phase_bits;
        let Some(counted) = cheapest(pilot, path_bits, &errors, start)? else {
            continue;
        };
        let cost = spent.toffoli as f64 * counted.queries().max(1.0);
        if best.as_ref().is_none_or(|best| cost < best.0) {
            best = Some((cost, (fraction, errors, spent), counted));
        }
    }
    match best {
        Some((_, width, counted)) => Ok((Some(width), counted)),
        None if has_circuit => Err(unreachable(format!(
            "no width of numbers reaches an error of {} with probability {}",
            pilot.accuracy.error, pilot.accuracy.confidence
        ))),
        None => Ok((None, wide)),
    }
}

/// The counting block with the fewest queries that keeps the accuracy together with the errors of
/// `2^path_bits` paths, of comparators and of `width`. It has the smallest register, or a smaller
/// one that is repeated; for an estimator that stops by itself, the largest error to stop at. The
/// search begins with a register of `start` bits.
fn cheapest(
    pilot: &mut Pilot<'_>,
    path_bits: u32,
    width: &Errors,
    start: u32,
) -> Result<Option<Counted>, PlanError> {
    let (paths, _) = pilot.paths(path_bits)?;
    let pilot = &*pilot;
    let attempt = |phase_bits: u32, repetitions: u32, error: Option<f64>| {
        let counting = Counting {
            phase_bits,
            repetitions,
            estimator: Some(pilot.estimator),
            error,
            ..Counting::default()
        };
        let (errors, channel_queries) = pilot.counted(&counting)?;
        let others = [&paths, &pilot.comparator_errors, width];
        let counted = Counted {
            counting,
            errors,
            channel_queries,
        };
        let good = will_do(pilot, &others, Some(&counted.errors));
        Ok::<_, PlanError>(good.then_some(counted))
    };
    if pilot.estimator == Estimator::Exact {
        let counting = Counting::default();
        return attempt(counting.phase_bits, counting.repetitions, None);
    }
    // Counting cannot help if the other errors are too large already.
    if !will_do(pilot, &[&paths, &pilot.comparator_errors, width], None) {
        return Ok(None);
    }
    // Begins where a similar search ended: goes down while the accuracy is kept, or up until it is.
    let mut found = attempt(start, 1, None)?;
    let mut phase_bits = start;
    if found.is_some() {
        while phase_bits > 1
            && let Some(smaller) = attempt(phase_bits - 1, 1, None)?
        {
            (found, phase_bits) = (Some(smaller), phase_bits - 1);
        }
    }
    while found.is_none() && phase_bits < MOST_PHASE {
        phase_bits += 1;
        found = attempt(phase_bits, 1, None)?;
    }
    let Some(mut best) = found else {
        return Ok(None);
    };
    if pilot.estimator.stops_itself() {
        // Channels need different numbers of queries: each stops when its interval is narrow
        // enough.
        let most = (phase_bits + SPARE).min(MOST_PHASE);
        let error = |step: i32| {
            let asked = pilot.accuracy.error * pilot.mean;
            Some(asked * libm::exp2(f64::from(step) / STEPS))
        };
        let [mut enough, mut too_wide] = WIDTHS;
        while too_wide - enough > 1 {
            let middle = i32::midpoint(enough, too_wide);
            match attempt(most, 1, error(middle))? {
                Some(found) => {
                    enough = middle;
                    if found.queries() < best.queries() {
                        best = found;
                    }
                }
                None => too_wide = middle,
            }
        }
    } else {
        // Tries a smaller register, repeated.
        let repeated: &[u32] = if phase_bits > 4 { &[7, 6, 5] } else { &[] };
        for &repetitions in repeated {
            match attempt(phase_bits - 3, repetitions, None)? {
                Some(found) if found.queries() < best.queries() => best = found,
                _ => break,
            }
        }
    }
    Ok(Some(best))
}

fn finish(
    pilot: &mut Pilot<'_>,
    path_bits: u32,
    width: Option<Width>,
    counted: Option<Counted>,
) -> Result<Plan, PlanError> {
    let none = vec![[0.0; 3]; pilot.pixels.len()];
    let black = counted.is_none();
    let (paths, extrapolated) = if black {
        (none.clone(), false)
    } else {
        pilot.paths(path_bits)?
    };
    let counting = counted
        .as_ref()
        .map_or_else(Counting::default, |c| c.counting);
    let errors = counted.as_ref().map_or(&[][..], |c| &c.errors);
    let width_errors = width.as_ref().map_or(&none, |(_, errors, _)| errors);
    let mut totals = Vec::new();
    let others = [&paths, &pilot.comparator_errors, width_errors];
    each_total(pilot, &others, Some(errors), |_, total| totals.push(total));
    let confidence = pilot.accuracy.confidence;
    let parts = ErrorParts {
        paths: quantile(&paths, confidence),
        comparators: quantile(&pilot.comparator_errors, confidence),
        width: quantile(width_errors, confidence),
        counting: quantile(&errors.concat(), confidence),
        total: quantile(&totals, confidence),
    };
    let (failing, _) = if black {
        (0.0, 0.0)
    } else {
        failing(pilot, &others, Some(errors))
    };
    let fraction = width.as_ref().map(|(fraction, ..)| *fraction);
    let mut parameters = pilot.scene.parameters();
    parameters.sampling.path_bits = path_bits;
    parameters.precision.fraction = fraction;
    parameters.comparator.bits = pilot.comparator_bits;
    parameters.counting = counting;
    parameters.counting.estimator = Some(pilot.estimator);
    let film = pilot.scene.scene().film;
    Ok(Plan {
        scene: valid(pilot.scene, parameters)?,
        figures: PlanFigures {
            accuracy: pilot.accuracy,
            mean: pilot.mean,
            pixels: [
                pilot.pixels.len() as u64,
                u64::from(film.width) * u64::from(film.height),
            ],
            sequence: pilot.scene.scene().sampling.sequence,
            path_bits,
            extrapolated,
            fraction,
            comparator_bits: pilot.comparator_bits,
            estimator: pilot.estimator,
            phase_bits: counting.phase_bits,
            repetitions: counting.repetitions,
            error: counting.error,
            within: 1.0 - failing,
            parts,
            queries: counted.as_ref().map_or(0.0, Counted::queries),
            channel_queries: counted.map_or([0.0; 3], |c| c.channel_queries),
            cost: width.map(|(.., cost)| cost),
        },
    })
}
