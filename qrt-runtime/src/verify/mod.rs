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

