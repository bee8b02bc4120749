//! The models against each other, path by path.
//!
//! * `fixed` and `gates` must agree bit for bit: in every path's colour, and in how many
//!   thresholds it exceeds.
//! * The gates machine must return every qubit but the id to zero, and turn the signs of exactly
//!   the good ids.
//! * A count must be the number of thresholds below the colour, counted from their definition.
//! * `fixed` and `real` differ by E_W, the error of a finite width: measured, pixel by pixel.

use crate::machines::{Defect, OracleMachine, Real};
use crate::render::RenderError;
use qrt_core::oracle::{self, Oracle};
use qrt_core::scene::ComparatorAt;
use qrt_core::valid::ValidScene;
use rayon::prelude::*;
use std::sync::Arc;

/// Paths of a pixel that are compared at a time.
const RUN: u64 = 1 << 14;

/// Mismatches that are reported one by one.
const SHOWN: usize = 8;

/// What to verify.
#[derive(Clone, Debug)]
pub struct Options {
    /// How many pixels, spread over the film; all of them if it has no more.
    pub pixels: u64,
    /// Keys the shifts of the digital net.
    pub seed: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            pixels: 16,
            seed: 0,
        }
    }
}

/// A path on which two models disagree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mismatch {
    /// Column and row of the pixel.
    pub pixel: [u32; 2],
    /// The path.
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

/// What was found.
#[derive(Clone, Debug)]
pub struct Report {
    /// Pixels, as columns and rows.
    pub pixels: Vec<[u32; 2]>,
    /// Paths compared.
    pub paths: u64,
    /// Qubits and gates of one run of the circuit, all channels' flips included.
    pub qubits: u32,
    /// See `qubits`.
    pub gates: usize,
    /// Fraction bits.
    pub fraction: u32,
    /// How many (path, channel) pairs disagree.
    pub mismatched: u64,
    /// The first few of them.
    pub mismatches: Vec<Mismatch>,
    /// What the circuit did wrong, if it did.
    pub defect: Option<Defect>,
    /// Per channel: the mean of the pixels, by the real machine.
    pub mean: [f64; 3],
    /// Per channel: E_W, the root mean square over pixels of fixed less real.
    pub width_error: [f64; 3],
    /// Per channel: the greatest difference of a pixel.
    pub greatest: [f64; 3],
    /// Share of (path, channel) pairs whose colours differ by more than a hundredth of the scale:
    /// paths that met something else.
    pub parted: f64,
}

impl Report {
    /// Is all as it must be?
    pub fn holds(&self) -> bool {
        self.mismatched == 0 && self.defect.is_none()
    }

    /// E_W of all channels in units of the mean of all; none if nothing is bright.
    pub fn relative_error(&self) -> Option<f64> {
        let square: f64 = self.width_error.iter().map(|e| e * e).sum();
        let mean: f64 = self.mean.iter().sum();
        (mean > 0.0).then(|| (square / 3.0).sqrt() / (mean / 3.0))
    }
}

/// Sums over the paths of a pixel.
#[derive(Clone, Debug, Default)]
struct Found {
    real: [f64; 3],
    fixed: [f64; 3],
    parted: u64,
    mismatched: u64,
    mismatches: Vec<Mismatch>,
}

/// Runs a scene on all three machines.
///
/// # Errors
/// A scene without a circuit. What the machines find is in the report.
pub fn verify(scene: &ValidScene, options: &Options) -> Result<Report, RenderError> {
    let oracle = Arc::new(Oracle::rgb(scene, oracle::Options::default())?);
    let real = Real::new(scene, options.seed)?;
    let fixed = OracleMachine::fixed(oracle.clone(), options.seed, true);
    let film = oracle.film;
    let area = u64::from(film[0]) * u64::from(film[1]);
    let count = options.pixels.clamp(1, area);
    // One in the middle of each of as many equal parts of the film's row-by-row order.
    let pixels: Vec<[u32; 2]> = (0..count)
        .map(|k| ((2 * u128::from(k) + 1) * u128::from(area) / (2 * u128::from(count))) as u64)
        .map(|place| {
            let width = u64::from(film[0]);
            [(place % width) as u32, (place / width) as u32]
        })
        .collect();
    let mut report = Report {
        paths: count << oracle.points.path_bits(),
        pixels,
        qubits: 0,
        gates: 0,
        fraction: oracle.fraction,
        mismatched: 0,
        mismatches: Vec::new(),
        defect: None,
        mean: [0.0; 3],
        width_error: [0.0; 3],
        greatest: [0.0; 3],
        parted: 0.0,
    };
    let gates = match OracleMachine::gates(oracle.clone(), options.seed, true) {
        Ok(gates) => gates,
        Err(defect) => {
            report.defect = Some(defect);
            return Ok(report);
        }
    };
    if let Some(parts) = gates.parts() {
        report.qubits = parts.compute.qubits;
        report.gates = parts.gates();
    }
    let at = scene.scene().comparator.at;
    let trio = Trio {
        oracle: &oracle,
        real: &real,
        fixed: &fixed,
        gates: &gates,
        at,
    };
    let found: Vec<Result<Found, Defect>> = report
        .pixels
        .par_iter()
        .map(|&pixel| trio.pixel(pixel))
        .collect();
    let mut parted = 0;
    for found in found {
        let found = match found {
            Ok(found) => found,
            Err(defect) => {
                report.defect.get_or_insert(defect);
                continue;
            }
        };
        for c in 0..3 {
            let difference = found.fixed[c] - found.real[c];
            report.mean[c] += found.real[c] / count as f64;
            report.width_error[c] += difference * difference / count as f64;
            report.greatest[c] = report.greatest[c].max(difference.abs());
        }
        parted += found.parted;
        report.mismatched += found.mismatched;
        let room = SHOWN - report.mismatches.len().min(SHOWN);
        report
            .mismatches
            .extend(found.mismatches.into_iter().take(room));
    }
    report.width_error = report.width_error.map(f64::sqrt);
    report.parted = parted as f64 / (3 * report.paths) as f64;
    Ok(report)
}

struct Trio<'a> {
    oracle: &'a Oracle,
    real: &'a Real,
    fixed: &'a OracleMachine,
    gates: &'a OracleMachine,
    at: ComparatorAt,
}

impl Trio<'_> {
    fn pixel(&self, pixel: [u32; 2]) -> Result<Found, Defect> {
        let paths = self.fixed.paths();
        let mut found = Found::default();
        let mut first = 0;
        while first < paths {
            let ids = first..(first + RUN).min(paths);
            let mut real: [Vec<f64>; 3] = Default::default();
            self.real.trace_range(&[pixel], ids.clone(), |block| {
                for (all, colours) in real.iter_mut().zip(block.colours) {
                    all.extend_from_slice(colours);
                }
            });
            let fixed = columns(self.fixed, pixel, ids.clone())?;
            let gates = columns(self.gates, pixel, ids.clone())?;
            self.compare(pixel, ids.start, [&real[0], &real[1], &real[2]], &fixed, &gates, &mut found);
            first = ids.end;
        }
        for sum in found.real.iter_mut().chain(&mut found.fixed) {
            *sum /= paths as f64;
        }
        Ok(found)
    }

    fn compare(
        &self,
        pixel: [u32; 2],
        first: u64,
        real: [&Vec<f64>; 3],
        fixed: &Columns,
        gates: &Columns,
        found: &mut Found,
    ) {
        let ulp = 1.0 / (1_u64 << self.oracle.fraction) as f64;
        for c in 0..3 {
            let scale = self.oracle.channels[c].scale;
            for (lane, &colour) in real[c].iter().enumerate() {
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
    }

    /// `#{y < 2^c : x > (y + s) / 2^c}` for the colour `x 2^-fraction`, s being 1/2 or 0: in exact
    /// integers, by bisection.
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

/// Every path's counts and colours.
#[derive(Default)]
struct Columns {
    good: [Vec<i64>; 3],
    colours: [Vec<i64>; 3],
}

fn columns(
    machine: &OracleMachine,
    pixel: [u32; 2],
    ids: std::ops::Range<u64>,
) -> Result<Columns, Defect> {
    let mut columns = Columns::default();
    machine.trace(&[pixel], ids, |finished| {
        for c in 0..3 {
            columns.good[c].extend_from_slice(finished.good[c]);
            columns.colours[c].extend_from_slice(finished.colours[c]);
        }
    })?;
    Ok(columns)
}
