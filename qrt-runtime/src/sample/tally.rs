//! Sums over the paths of pixels, on all threads.

use super::{SampleError, Sum};
use crate::path_machines::{OracleMachine, Real};
use crate::workers::Workers;
use qrt_counting::{Comparators, Octaves};
use rayon::prelude::*;
use std::ops::Range;

/// Number of paths that a thread traces at a time.
const RUN: u64 = 1 << 15;

/// Sums over paths of one pixel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    /// The sum of the paths' colours by channel, in radiance.
    pub colour: [f64; 3],
    /// Number of good indices, by register of comparators and by channel.
    pub good: Vec<[u64; 3]>,
    /// The good indices of the first register, by channel and octave.
    pub octaves: [Octaves; 3],
}

impl Tally {
    /// Adds the sums over later paths of the same pixel, counted against the same comparators.
    pub(crate) fn add(&mut self, later: &Self) {
        for (sum, more) in self.colour.iter_mut().zip(later.colour) {
            *sum += more;
        }
        self.good.resize(later.good.len(), [0; 3]);
        for (sum, more) in self.good.iter_mut().zip(&later.good) {
            for (sum, more) in sum.iter_mut().zip(more) {
                *sum += more;
            }
        }
        for (sum, more) in self.octaves.iter_mut().zip(&later.octaves) {
            sum.append(more);
        }
    }
}

/// Sums the paths `ids` of `pixels` in real arithmetic, and counts them against each of
/// `comparators`, channel by channel.
///
/// # Errors
/// See [`SampleError`].
pub fn tallies(
    real: &Real,
    pixels: &[[u32; 2]],
    ids: Range<u64>,
    comparators: &[[Comparators; 3]],
    workers: &Workers<'_>,
) -> Result<Vec<Tally>, SampleError> {
    in_runs(pixels, ids, workers, |pixels, ids| {
        let none = Tally {
            good: vec![[0; 3]; comparators.len()],
            octaves: match comparators.first() {
                Some(first) => first.each_ref().map(|c| Octaves::new(c.bits())),
                None => Default::default(),
            },
            ..Tally::default()
        };
        let mut tallies = vec![none; pixels.len()];
        let mut sums = vec![[Sum::default(); 3]; pixels.len()];
        real.trace_range(pixels, ids, |block| {
            let tally = &mut tallies[block.pixel];
            for (channel, colours) in block.colours.into_iter().enumerate() {
                sums[block.pixel][channel].add(colours);
                for (good, comparators) in tally.good.iter_mut().zip(comparators) {
                    good[channel] += comparators[channel].good_total(colours);
                }
                if let Some(first) = comparators.first() {
                    let octaves = &mut tally.octaves[channel];
                    let counts = colours.iter().map(|&colour| first[channel].good(colour));
                    counts.for_each(|good| octaves.add(good.into()));
                }
            }
        });
        for (tally, sums) in tallies.iter_mut().zip(sums) {
            tally.colour = sums.map(|sum| sum.value());
        }
        Ok(tallies)
    })
}

/// Sums the paths `ids` of `pixels` as a scene's oracle counts them: with one register of
/// comparators, the oracle's own, and without colours.
///
/// # Errors
/// If the work is cancelled, or the circuit is not a valid oracle.
pub fn counted_tallies(
    machine: &OracleMachine,
    pixels: &[[u32; 2]],
    ids: Range<u64>,
    workers: &Workers<'_>,
) -> Result<Vec<Tally>, SampleError> {
    in_runs(pixels, ids, workers, |pixels, ids| {
        let bits = machine.oracle().comparator_bits();
        let none = Tally {
            good: vec![[0; 3]],
            octaves: [(); 3].map(|()| Octaves::new(bits)),
            ..Tally::default()
        };
        let mut tallies = vec![none; pixels.len()];
        machine.trace(pixels, ids, |finished| {
            let tally = &mut tallies[finished.pixel];
            for (sum, good) in tally.good[0].iter_mut().zip(finished.good) {
                *sum += good.iter().sum::<i64>().cast_unsigned();
            }
            for (octaves, good) in tally.octaves.iter_mut().zip(finished.good) {
                for good in good {
                    octaves.add(good.cast_unsigned());
                }
            }
        })?;
        Ok(tallies)
    })
}

/// Cuts the work into runs of paths, or of pixels with few paths, and adds their tallies in order.
fn in_runs(
    pixels: &[[u32; 2]],
    ids: Range<u64>,
    workers: &Workers<'_>,
    run: impl Fn(&[[u32; 2]], Range<u64>) -> Result<Vec<Tally>, SampleError> + Sync,
) -> Result<Vec<Tally>, SampleError> {
    let length = ids.end.saturating_sub(ids.start);
    let together = (RUN / length.max(1)).max(1) as usize;
    let runs = length.div_ceil(RUN).max(1);
    let groups: Vec<&[[u32; 2]]> = pixels.chunks(together).collect();
    let all = groups.len() as u64 * runs;
    let parts: Vec<Vec<Tally>> = (0..all)
        .into_par_iter()
        .map(|number| {
            if workers.cancelled() {
                let pixels = pixels.len() as u64;
                return Err(SampleError::Interrupted { pixels });
            }
            let start = ids.start + number % runs * RUN;
            let part = start..(start + RUN).min(ids.end);
            run(groups[(number / runs) as usize], part)
        })
        .collect::<Result<_, _>>()?;
    let mut whole = Vec::with_capacity(pixels.len());
    for parts in parts.chunks(runs as usize) {
        let mut group = vec![Tally::default(); parts.first().map_or(0, Vec::len)];
        for part in parts {
            for (sum, more) in group.iter_mut().zip(part) {
                sum.add(more);
            }
        }
        whole.append(&mut group);
    }
    Ok(whole)
}
