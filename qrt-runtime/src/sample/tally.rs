//! Sums over the paths of pixels, on all threads.

use super::{SampleError, Sum};
use crate::path_machines::{PathMachine, Traced};
use crate::workers::Workers;
use qrt_counting::{Comparators, LevelCounts};
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
    /// The levels of paths at the first register, by channel.
    pub levels: [LevelCounts; 3],
}

impl Tally {
    /// Adds the sums over later paths of the same pixel, counted against the same comparators.
    pub fn add(&mut self, later: &Self) {
        for (sum, more) in self.colour.iter_mut().zip(later.colour) {
            *sum += more;
        }
        self.good.resize(later.good.len(), [0; 3]);
        for (sum, more) in self.good.iter_mut().zip(&later.good) {
            for (sum, more) in sum.iter_mut().zip(more) {
                *sum += more;
            }
        }
        for (sum, more) in self.levels.iter_mut().zip(&later.levels) {
            sum.append(more);
        }
    }
}

/// Sums the paths `ids` of `pixels`. A machine in floating point sums their colours, and counts them
/// against each of `comparators`, channel by channel. The machine of an oracle counts them against the
/// oracle's own comparators, which must be the only ones in `comparators`, and sums no colours.
///
/// # Errors
/// If the work is cancelled, or the circuit is not a valid oracle.
pub fn tallies(
    machine: &dyn PathMachine,
    pixels: &[[u32; 2]],
    ids: Range<u64>,
    comparators: &[[Comparators; 3]],
    workers: &Workers<'_>,
) -> Result<Vec<Tally>, SampleError> {
    in_runs(pixels, ids, workers, |pixels, ids| {
        let none = Tally::empty(comparators);
        let mut tallies = vec![none; pixels.len()];
        let mut sums = vec![[Sum::default(); 3]; pixels.len()];
        machine.trace_paths(None, pixels, ids, &mut |traced| {
            let tally = &mut tallies[traced.pixel()];
            match traced {
                Traced::Colours(block) => {
                    let sums = &mut sums[block.pixel];
                    for (sum, colours) in sums.iter_mut().zip(block.colours) {
                        sum.add(colours);
                    }
                    tally.count_colours(block.colours, comparators);
                }
                Traced::Counts(finished) => tally.add_counts(finished.good),
            }
        })?;
        for (tally, sums) in tallies.iter_mut().zip(sums) {
            tally.colour = sums.map(|sum| sum.value());
        }
        Ok(tallies)
    })
}

impl Tally {
    /// A tally of no paths, for these registers of comparators.
    pub fn empty(comparators: &[[Comparators; 3]]) -> Self {
        let first = comparators.first();
        Self {
            colour: [0.0; 3],
            good: vec![[0; 3]; comparators.len()],
            levels: first.map_or_else(Default::default, |first| {
                first.each_ref().map(|c| LevelCounts::new(c.bits()))
            }),
        }
    }

    fn count_colours(&mut self, colours: [&[f64]; 3], comparators: &[[Comparators; 3]]) {
        for (channel, colours) in colours.into_iter().enumerate() {
            for (good, comparators) in self.good.iter_mut().zip(comparators) {
                good[channel] += comparators[channel].good_total(colours);
            }
            if let Some(first) = comparators.first() {
                let levels = colours.iter().map(|&colour| first[channel].good(colour));
                self.levels[channel].add_all(levels.map(u64::from));
            }
        }
    }

    fn add_counts(&mut self, counts: [&[i64]; 3]) {
        let Some(sums) = self.good.first_mut() else {
            return;
        };
        for (sum, good) in sums.iter_mut().zip(counts) {
            *sum += good.iter().sum::<i64>().cast_unsigned();
        }
        for (levels, good) in self.levels.iter_mut().zip(counts) {
            levels.add_all(good.iter().map(|good| good.cast_unsigned()));
        }
    }
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
