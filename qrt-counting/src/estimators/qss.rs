//! `qss`: quantum supersampling.

use super::{
    AmplitudeEstimator, Device, Estimate, EstimatorError, Noise, Settings, WindowedCounting,
};
use crate::LookupTable;
use qrt_scene::Estimator;
use std::sync::{Arc, Mutex, PoisonError};

/// The largest number of tables that one estimator keeps.
const TABLES: usize = 8;

/// `qss`: phase estimation of the Grover iterate, and a look-up table from readings to estimates.
///
/// The method is Johnston's (*Quantum supersampling*, SIGGRAPH 2016 talks; Johnston, Harrigan &
/// Gimeno-Segovia, *Programming quantum computers*, 2019, chapter 11). See [`LookupTable`].
///
/// Johnston runs the circuit once per pixel, which is B = 1. He gives no rule for B > 1; here the
/// table looks up the lower median of the readings.
///
/// Interval: the fractions around the reading that hold `confidence` of its column. That is a
/// probability if all S are equally likely before the run, that is, for S/N uniform in [0, 1]. For
/// one given S it may be less: halfway between two readings, the coverage of a single reading's
/// interval of 95 % is 0.90. Known noise flattens the table: it takes a register that is destroyed,
/// or that has a misread bit, to read any value. Once the probability of that reaches the failure
/// probability, intervals are wide.
#[derive(Debug)]
pub struct Supersampling {
    counting: WindowedCounting,
    known_noise: Noise,
    tables: Mutex<Vec<Arc<LookupTable>>>,
}

impl Supersampling {
    pub(super) fn new(settings: &Settings) -> Result<Self, EstimatorError> {
        Ok(Self {
            counting: WindowedCounting::new(Estimator::Qss, settings)?,
            known_noise: settings.known_noise,
            tables: Mutex::default(),
        })
    }

    /// The table for `total` indices, created on first use.
    ///
    /// # Errors
    /// No indices.
    pub fn table(&self, total: u64) -> Result<Arc<LookupTable>, EstimatorError> {
        let mut tables = self.tables.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(table) = tables.iter().find(|table| table.total() == total) {
            return Ok(table.clone());
        }
        let bits = self.counting.phase_bits;
        let noise = self.known_noise;
        let intact = noise.intact((1 << bits) - 1) * noise.read_rightly(bits);
        let table = LookupTable::new(total, bits, self.counting.confidence, intact)?;
        let table = Arc::new(table);
        if tables.len() == TABLES {
            tables.remove(0);
        }
        tables.push(table.clone());
        Ok(table)
    }
}

impl AmplitudeEstimator for Supersampling {
    fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError> {
        let start = device.usage();
        let total = device.total();
        let table = self.table(total)?;
        let mut readings = self.counting.outcomes(device)?;
        readings.sort_unstable();
        let column = table.column(readings[(readings.len() - 1) / 2])?;
        let amplitude = column.good as f64 / total as f64;
        Ok(Estimate {
            good: Some(column.good),
            ln_likelihood: (self.counting.repetitions == 1).then_some(column.ln_likelihood),
            ..device.estimate(start, amplitude, column.interval, self.counting.confidence)
        })
    }

    fn misses(&self) -> f64 {
        self.counting.misses()
    }
}
