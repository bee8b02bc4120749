//! Compares a run of paths on all three machines.

use super::{Mismatch, SHOWN};
use qrt_core::oracle::Oracle;
use qrt_runtime::models::Model;
use qrt_runtime::path_machines::{Defect, PathMachine, Traced};
use qrt_scene::ComparatorAt;
use std::ops::Range;
use std::sync::atomic::AtomicBool;

/// Sums over the paths of one pixel.
#[derive(Clone, Debug, Default)]
pub(super) struct Found {
    pub(super) real: [f64; 3],
    pub(super) fixed: [f64; 3],
    pub(super) parted: u64,
    pub(super) mismatched: u64,
    pub(super) mismatches: Vec<Mismatch>,
}

impl Found {
    /// Adds the next run.
    pub(super) fn add(&mut self, next: Self) {
        for c in 0..3 {
            self.real[c] += next.real[c];
            self.fixed[c] += next.fixed[c];
        }
        self.parted += next.parted;
        self.mismatched += next.mismatched;
        show(&mut self.mismatches, next.mismatches);
    }
}

/// Adds mismatches to those that are reported one by one, up to [`SHOWN`] of them.
pub(super) fn show(shown: &mut Vec<Mismatch>, more: Vec<Mismatch>) {
    let room = SHOWN.saturating_sub(shown.len());
    shown.extend(more.into_iter().take(room));
}

/// The three machines for one scene.
pub(super) struct Trio<'a> {
    pub(super) oracle: &'a Oracle,
    pub(super) real: &'a dyn PathMachine,
    pub(super) fixed: &'a dyn PathMachine,
    pub(super) gates: &'a dyn PathMachine,
    pub(super) at: ComparatorAt,
    pub(super) cancel: Option<&'a AtomicBool>,
}

impl Trio<'_> {
    /// Compares the paths `ids` of a pixel.
    ///
    /// # Errors
    /// A defect, and the model that shows it.
    pub(super) fn compare_paths(
        &self,
        pixel: [u32; 2],
        ids: Range<u64>,
    ) -> Result<Found, (Model, Defect)> {
        let shown_by = |model: Model| move |defect: Defect| (model, defect);
        let mut real: [Vec<f64>; 3] = Default::default();
        let traced = |traced: Traced<'_>| {
            if let Traced::Colours(block) = traced {
                for (all, colours) in real.iter_mut().zip(block.colours) {
                    all.extend_from_slice(colours);
                }
            }
        };
        let all = self.trace(self.real, pixel, ids.clone(), traced);
        all.map_err(shown_by(Model::Real))?;
        let within = self.within_bounds(pixel, ids.start, &real);
        within.map_err(shown_by(Model::Real))?;
        let fixed = self.columns(self.fixed, pixel, ids.clone());
        let fixed = fixed.map_err(shown_by(Model::Fixed))?;
        let gates = self.columns(self.gates, pixel, ids.clone());
        let gates = gates.map_err(shown_by(Model::Gates))?;
        Ok(self.compare(pixel, ids.start, &real, &fixed, &gates))
    }

    /// Checks that no colour of the real machine exceeds its bound.
    fn within_bounds(
        &self,
        pixel: [u32; 2],
        first: u64,
        colours: &[Vec<f64>; 3],
    ) -> Result<(), Defect> {
        let limits = [0, 1, 2].map(|channel| self.real.limit(channel));
        for (channel, (colours, limit)) in colours.iter().zip(limits).enumerate() {
            // A NaN is outside, too.
            let inside = |&colour: &f64| colour >= 0.0 && colour <= limit;
            let Some(lane) = colours.iter().position(|colour| !inside(colour)) else {
                continue;
            };
            let most = 1_i64 << self.oracle.comparator_bits();
            let scale = self.oracle.channels[channel].scale;
            return Err(Defect::OutOfBounds {
                pixel,
                id: first + lane as u64,
                channel,
                count: (colours[lane] / scale * most as f64).ceil() as i64,
                most,
            });
        }
        Ok(())
    }

    fn columns(
        &self,
        machine: &dyn PathMachine,
        pixel: [u32; 2],
        ids: Range<u64>,
    ) -> Result<Columns, Defect> {
        let mut columns = Columns::default();
        self.trace(machine, pixel, ids, |traced| {
            if let Traced::Counts(finished) = traced {
                for c in 0..3 {
                    columns.good[c].extend_from_slice(finished.good[c]);
                    columns.colours[c].extend_from_slice(finished.colours[c]);
                }
            }
        })?;
        Ok(columns)
    }

    fn trace(
        &self,
        machine: &dyn PathMachine,
        pixel: [u32; 2],
        ids: Range<u64>,
        mut traced: impl FnMut(Traced<'_>),
    ) -> Result<(), Defect> {
        machine.trace_paths(self.cancel, &[pixel], ids, &mut traced)
    }

    fn compare(
        &self,
        pixel: [u32; 2],
        first: u64,
        real: &[Vec<f64>; 3],
        fixed: &Columns,
        gates: &Columns,
    ) -> Found {
        let mut found = Found::default();
        let ulp = 1.0 / (1_u64 << self.oracle.fraction) as f64;
        for (c, real) in real.iter().enumerate() {
            let scale = self.oracle.channels[c].scale;
            for (lane, &colour) in real.iter().enumerate() {
                let width = [fixed.colours[c][lane], fixed.good[c][lane]];
                let gate = [gates.colours[c][lane], gates.good[c][lane]];
                let value = width[0] as f64 * ulp * scale;
                found.real[c] += colour;
                found.fixed[c] += value;
                found.parted += u64::from((value - colour).abs() > 0.01 * scale);
                let thresholds = self.thresholds(width[0]);
                if width != gate || thresholds != width[1] {
                    found.mismatched += 1;
                    if found.mismatches.len() < SHOWN {
                        found.mismatches.push(Mismatch {
                            pixel,
                            id: first + lane as u64,
                            channel: c,
                            fixed: width,
                            gates: gate,
                            thresholds,
                        });
                    }
                }
            }
        }
        found
    }

    /// `#{y < 2^c : x > (y + s) / 2^c}` for the colour `x 2^-fraction`, with s = 1/2 for midpoints
    /// and 0 otherwise. It is computed in exact integers, by bisection.
    fn thresholds(&self, x: i64) -> i64 {
        let bits = self.oracle.comparator_bits();
        let half = i128::from(self.at == ComparatorAt::Midpoints);
        // x 2^(c + 1) > (2 y + 2 s) 2^fraction
        let left = i128::from(x) << (bits + 1);
        let exceeds = |y: i64| left > (2 * i128::from(y) + half) << self.oracle.fraction;
        let (mut low, mut high) = (0, 1_i64 << bits);
        while low < high {
            let middle = low.midpoint(high);
            if exceeds(middle) {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        low
    }
}

/// The counts and colours of every path.
#[derive(Default)]
struct Columns {
    good: [Vec<i64>; 3],
    colours: [Vec<i64>; 3],
}
