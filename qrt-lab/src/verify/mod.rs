//! Compares the models with each other, path by path.
//!
//! * `fixed` and `gates` must agree bit for bit: in every path's colour, and in the number of
//!   thresholds that it exceeds.
//! * The gates machine must return every qubit but those of the path index to zero, and flip the
//!   phases of exactly the good indices.
//! * A count must be the number of thresholds below the colour, computed from their definition.
//! * `fixed` and `real` differ by E_W, the error of a finite width: measured, pixel by pixel.

mod error;
mod paths;
mod pixel;

pub use error::VerifyError;
pub use pixel::{PixelCounts, pixel_counts};

use paths::{Found, Trio, show};
use qrt_core::oracle::{Oracle, OracleCost};
use qrt_runtime::Prepared;
use qrt_runtime::memory::Memory;
use qrt_runtime::models::{MachineOptions, Model};
use qrt_runtime::path_machines::{Defect, OracleCircuits, OracleMachine, PathMachine, Real};
use qrt_runtime::plan;
use qrt_runtime::render::Portion;
use qrt_runtime::sample::spread;
use qrt_runtime::workers::{Progress, Workers};
use qrt_scene::valid::ValidScene;
use rayon::prelude::*;
use std::sync::Arc;

/// Number of paths of a pixel that are compared at a time.
const RUN: u64 = 1 << 14;

/// Number of runs of paths whose results are in memory at a time.
const HELD: u64 = 256;

/// The largest number of mismatches that are reported one by one.
const SHOWN: usize = 8;

/// The circuit that the check runs, in words.
pub const CIRCUIT: &str =
    "all three channels in one: compute, compare and flip for each, uncompute";

/// Options of a check.
#[derive(Clone, Copy, Debug)]
pub struct VerifyOptions<'a> {
    /// Number of pixels, spread over the film; all of them if it has no more.
    pub pixels: u64,
    /// The portion of these pixels that is checked; pixels are dealt to portions one by one. All
    /// unless set.
    pub portion: Portion,
    /// The key of the shifts of the digital net.
    pub seed: u64,
    /// The threads that do the work, and the callback for progress, in paths.
    pub workers: Workers<'a>,
}

impl Default for VerifyOptions<'_> {
    fn default() -> Self {
        Self {
            pixels: 16,
            portion: Portion::WHOLE,
            seed: 0,
            workers: Workers::default(),
        }
    }
}

/// A path on which two models disagree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mismatch {
    /// Column and row of the pixel.
    pub pixel: [u32; 2],
    /// The path's index.
    pub id: u64,
    /// 0 red, 1 green, 2 blue.
    pub channel: usize,
    /// Colour and count of the fixed machine, in units of their last places.
    pub fixed: [i64; 2],
    /// Colour and count of the gates machine.
    pub gates: [i64; 2],
    /// The thresholds that the fixed machine's colour exceeds, by their definition.
    pub thresholds: i64,
}

/// The result of the check of a scene's circuit.
#[derive(Clone, Debug, Default)]
pub struct VerifyReport {
    /// The checked pixels, as columns and rows.
    pub pixels: Vec<[u32; 2]>,
    /// Number of paths compared; with a defect, number of paths that should have been compared.
    pub paths: u64,
    /// The oracles of the pixels' classes, one for each channel, and the cost of a call of each
    /// alone. The circuit that runs has the oracles of all three channels, which share compute and
    /// uncompute. Empty if the caller gave the circuit.
    pub oracles: Vec<OracleCost>,
    /// Qubits of the circuit that runs: it computes all three channels at once, compares and flips
    /// each, and uncomputes.
    pub qubits: u32,
    /// Gates of that circuit.
    pub gates: usize,
    /// Fraction bits of every number.
    pub fraction: u32,
    /// Number of (path, channel) pairs on which the models disagree.
    pub mismatched: u64,
    /// The first mismatches, at most 8.
    pub mismatches: Vec<Mismatch>,
    /// The defect of the circuit, if it has one.
    pub defect: Option<Defect>,
    /// The model that shows the defect; `None` without a defect.
    pub defect_model: Option<Model>,
    /// The mean radiance of the pixels per channel, by the real machine. This and the following
    /// figures are 0 if there is a defect.
    pub mean: [f64; 3],
    /// E_W per channel: the root mean square over pixels of fixed minus real.
    pub width_error: [f64; 3],
    /// The largest difference of a pixel per channel, in radiance.
    pub greatest: [f64; 3],
    /// Fraction of (path, channel) pairs whose colours differ by more than a hundredth of the
    /// scale: paths that hit different faces in the two models.
    pub parted: f64,
}

impl VerifyReport {
    /// Returns whether the check passed: no mismatch, and no defect.
    pub fn holds(&self) -> bool {
        self.mismatched == 0 && self.defect.is_none()
    }

    /// Combines the reports of all portions of a check.
    ///
    /// Pixels, paths and mismatches add up. Means are those over all pixels, and root mean squares
    /// are pooled. Of largest differences, qubits and gates, the largest is taken. Empty without
    /// reports.
    pub fn pooled(portions: impl IntoIterator<Item = Self>) -> Self {
        portions.into_iter().reduce(Self::and).unwrap_or_default()
    }

    /// E_W of all channels in units of the mean of all; `None` if that mean is 0.
    pub fn relative_error(&self) -> Option<f64> {
        let square: f64 = self.width_error.iter().map(|e| e * e).sum();
        let mean: f64 = self.mean.iter().sum();
        (mean > 0.0).then(|| (square / 3.0).sqrt() / (mean / 3.0))
    }
}

/// Runs a scene on all three machines. A scene with an accuracy runs with the parameters that are
/// chosen for it.
///
/// # Errors
/// If the scene has no circuit, or the check is interrupted. Differences and defects of the
/// machines are in the report.
pub fn verify(
    scene: &ValidScene,
    options: &VerifyOptions<'_>,
) -> Result<VerifyReport, VerifyError> {
    let planning = plan::PlanOptions {
        workers: options.workers,
        ..plan::PlanOptions::default()
    };
    let prepared = Prepared::new(scene, &planning, Memory::default())?;
    verify_prepared(&prepared, options)
}

/// As [`verify`], for a scene that is prepared.
///
/// # Errors
/// As [`verify`].
pub fn verify_prepared(
    prepared: &Prepared<'_>,
    options: &VerifyOptions<'_>,
) -> Result<VerifyReport, VerifyError> {
    let scene = prepared.scene();
    let chosen = pixels(scene, options)?;
    // Each pixel runs on the circuit of its class.
    let (oracles, classes) = (prepared.oracles(), prepared.oracles().classes());
    let mut checked = Vec::new();
    for &class in classes.present() {
        let mine = |pixel: &[u32; 2]| classes.class(*pixel) == class;
        let pixels: Vec<[u32; 2]> = chosen.iter().copied().filter(mine).collect();
        if !pixels.is_empty() {
            checked.push((pixels, oracles.with_costs(class)?));
        }
    }
    let real = prepared.machines(&MachineOptions {
        seed: options.seed,
        ..MachineOptions::default()
    })?;
    let mut whole: Option<VerifyReport> = None;
    for (pixels, (oracle, costs)) in checked {
        let real = &**real.by_class.at(pixels[0]);
        let parts = OracleCircuits::new(&oracle);
        let mut report = verify_pixels(scene, real, &oracle, parts, pixels, options)?;
        report.oracles = costs.to_vec();
        whole = Some(match whole {
            None => report,
            Some(before) => before.and(report),
        });
    }
    Ok(whole.unwrap_or_default())
}

/// Returns the pixels that [`verify`] checks: those of the portion, in the order of the film.
///
/// # Errors
/// If there are more portions than pixels.
pub fn pixels(
    scene: &ValidScene,
    options: &VerifyOptions<'_>,
) -> Result<Vec<[u32; 2]>, VerifyError> {
    chosen(
        [scene.scene().film.width, scene.scene().film.height],
        options,
    )
}

/// As [`verify`], on given circuits, for example modified ones.
///
/// # Errors
/// As [`verify`].
pub fn verify_parts(
    scene: &ValidScene,
    oracle: &Arc<Oracle>,
    parts: OracleCircuits,
    options: &VerifyOptions<'_>,
) -> Result<VerifyReport, VerifyError> {
    let pixels = chosen(oracle.film, options)?;
    let real = Real::new(scene, options.seed)?;
    verify_pixels(scene, &real, oracle, parts, pixels, options)
}

/// Returns the pixels to check.
fn chosen(film: [u32; 2], options: &VerifyOptions<'_>) -> Result<Vec<[u32; 2]>, VerifyError> {
    let area = u64::from(film[0]) * u64::from(film[1]);
    let all = spread(film, options.pixels.clamp(1, area));
    let (portion, pixels) = (options.portion, all.len() as u64);
    if u64::from(portion.count()) > pixels {
        let count = portion.count();
        return Err(VerifyError::Portions { count, pixels });
    }
    let mine = all
        .into_iter()
        .enumerate()
        .filter(|(number, _)| portion.takes(*number));
    Ok(mine.map(|(_, pixel)| pixel).collect())
}

fn verify_pixels(
    scene: &ValidScene,
    real: &dyn PathMachine,
    oracle: &Arc<Oracle>,
    parts: OracleCircuits,
    pixels: Vec<[u32; 2]>,
    options: &VerifyOptions<'_>,
) -> Result<VerifyReport, VerifyError> {
    let count = pixels.len() as u64;
    let path_bits = oracle.points.path_bits();
    let Some(paths) = count.checked_mul(1 << path_bits) else {
        return Err(VerifyError::TooManyPaths {
            pixels: count,
            path_bits,
        });
    };
    let mut report = VerifyReport {
        paths,
        pixels,
        qubits: parts.compute.qubits,
        gates: parts.gates(),
        fraction: oracle.fraction,
        ..VerifyReport::default()
    };
    let fixed = OracleMachine::fixed(oracle.clone(), options.seed, true);
    options.workers.on_threads(|| {
        let gates = OracleMachine::of_parts(oracle.clone(), parts, options.seed, true);
        match gates {
            Ok(gates) => {
                let trio = Trio {
                    oracle,
                    real,
                    fixed: &fixed,
                    gates: &gates,
                    at: scene.scene().comparator.at,
                    cancel: options.workers.cancel,
                };
                report.compare(&trio, &options.workers)?;
            }
            Err(defect) => report.set_defect((Model::Gates, defect)),
        }
        Ok(report)
    })?
}

impl VerifyReport {
    /// Combines the reports of two sets of pixels. Their circuits may differ; the larger size is
    /// taken.
    fn and(mut self, other: Self) -> Self {
        let share = |report: &Self| report.pixels.len() as f64;
        let (a, b) = (share(&self), share(&other));
        let mean = |x: f64, y: f64| (a * x + b * y) / (a + b);
        for c in 0..3 {
            self.mean[c] = mean(self.mean[c], other.mean[c]);
            let squares = [self.width_error[c], other.width_error[c]].map(|e| e * e);
            self.width_error[c] = mean(squares[0], squares[1]).sqrt();
            self.greatest[c] = self.greatest[c].max(other.greatest[c]);
        }
        self.parted = mean(self.parted, other.parted);
        self.pixels.extend(other.pixels);
        for oracle in other.oracles {
            if !self.oracles.contains(&oracle) {
                self.oracles.push(oracle);
            }
        }
        let place = |oracle: &OracleCost| (oracle.name.class as usize, oracle.name.channel);
        self.oracles.sort_by_key(place);
        self.paths += other.paths;
        self.qubits = self.qubits.max(other.qubits);
        self.gates = self.gates.max(other.gates);
        self.mismatched += other.mismatched;
        show(&mut self.mismatches, other.mismatches);
        if self.defect.is_none() {
            (self.defect, self.defect_model) = (other.defect, other.defect_model);
        }
        self
    }

    /// Compares all paths of all pixels, run by run.
    fn compare(&mut self, trio: &Trio<'_>, workers: &Workers<'_>) -> Result<(), VerifyError> {
        workers.report(Progress::Started {
            total: self.paths,
            resumed: 0,
        });
        let pixels = self.pixels.len() as u64;
        let of_pixel = self.paths / pixels;
        let runs = of_pixel.div_ceil(RUN);
        let all = runs * pixels;
        let mut pixel = Found::default();
        for first in (0..all).step_by(HELD as usize) {
            let numbers = first..(first + HELD).min(all);
            let found = numbers.clone().into_par_iter().map(|number| {
                if workers.cancelled() {
                    return Ok(Found::default());
                }
                let start = number % runs * RUN;
                let ids = start..(start + RUN).min(of_pixel);
                let length = ids.end - ids.start;
                let found = trio.compare_paths(self.pixels[(number / runs) as usize], ids);
                workers.report(Progress::Finished(length));
                found
            });
            let found: Vec<Result<Found, (Model, Defect)>> = found.collect();
            if workers.cancelled() {
                return Err(VerifyError::Interrupted {
                    finished: first / runs,
                    pixels,
                });
            }
            for (number, found) in numbers.zip(found) {
                match found {
                    Ok(found) => pixel.add(found),
                    Err(defect) => {
                        self.set_defect(defect);
                        // Sums over only some of the pixels would not be means.
                        [self.mean, self.width_error, self.greatest] = [[0.0; 3]; 3];
                        self.parted = 0.0;
                        return Ok(());
                    }
                }
                if number % runs + 1 == runs {
                    self.add_pixel(std::mem::take(&mut pixel), of_pixel);
                }
            }
        }
        self.mean = self.mean.map(|sum| sum / pixels as f64);
        self.width_error = self.width_error.map(|sum| (sum / pixels as f64).sqrt());
        self.parted /= 3.0 * self.paths as f64;
        Ok(())
    }

    /// Records a defect, and the model that shows it.
    fn set_defect(&mut self, (model, defect): (Model, Defect)) {
        (self.defect, self.defect_model) = (Some(defect), Some(model));
    }

    /// Adds a finished pixel with `paths` paths.
    fn add_pixel(&mut self, found: Found, paths: u64) {
        for c in 0..3 {
            let real = found.real[c] / paths as f64;
            let difference = found.fixed[c] / paths as f64 - real;
            self.mean[c] += real;
            self.width_error[c] += difference * difference;
            self.greatest[c] = self.greatest[c].max(difference.abs());
        }
        self.parted += found.parted as f64;
        self.mismatched += found.mismatched;
        show(&mut self.mismatches, found.mismatches);
    }
}
