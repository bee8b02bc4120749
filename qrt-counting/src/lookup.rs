//! The look-up table of quantum supersampling: from a reading of the phase register to good
//! indices.
//!
//! Johnston (*Quantum supersampling*, SIGGRAPH 2016 talks; Johnston, Harrigan & Gimeno-Segovia,
//! *Programming quantum computers*, 2019, chapter 11) tabulates P(y | S), with a column for every
//! reading y and a row for every S. The look-up of y returns the S of the column's largest entry.
//! That entry's fraction of the column measures how far the result can be trusted; Johnston calls
//! it the *confidence map*. The entries depend on N and the register alone, so they are known
//! before anything is rendered.
//!
//! Here y and T - y, whose columns are equal, share one column. A column is computed when it is
//! first read. If it has too many rows, they are merged. Near y, all S within an eighth of a step
//! form a row. Farther away, P oscillates and falls with the square of the distance. There all S
//! within a fifth of the distance form a row, with P's mean over a step.

use std::collections::HashMap;
use std::f64::consts::PI;
use std::sync::{Mutex, PoisonError};

use qrt_circuit::quantum::Window;

use super::distribution::{check_counts, ln_probability, register};
use super::error::CountingError;
use super::kernel::Register;
use super::likelihood::maximum_likelihood;
use super::phase::Phase;

/// The largest number of indices at which every S has a row of its own.
const FEW_IDS: u64 = 1024;
/// Distance from y, in steps, within which rows are not averages.
const NEAR: u64 = 16;
/// Number of rows per step within that distance.
const ROWS: u64 = 8;
/// The largest number of columns in the cache.
const KEPT: usize = 1 << 16;

/// The table's result for one reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    /// The likeliest S; the S nearest to y if only noise can produce y.
    pub good: u64,
    /// ln P(y | S) of that S; negative infinity if no S produces y.
    pub ln_likelihood: f64,
    /// The entry's fraction of the column: the confidence map. It is the posterior probability of
    /// this S under a uniform prior.
    pub certainty: f64,
    /// The range of S/N of the rows nearest to y that hold the table's fraction `mass` of the
    /// column.
    pub interval: (f64, f64),
}

/// The look-up table for N indices and a phase register of `T = 2^phase_bits`.
///
/// ```
/// use qrt_counting::LookupTable;
/// // Four by four subpixels and four phase qubits.
/// let table = LookupTable::new(16, 4, 0.95, 1.0)?;
/// assert_eq!(table.column(4)?.good, 8);
/// assert_eq!(table.column(8)?.good, 16);
/// # Ok::<(), qrt_counting::CountingError>(())
/// ```
#[derive(Debug)]
pub struct LookupTable {
    total: u64,
    phase_bits: u32,
    register: Register,
    mass: f64,
    intact: f64,
    columns: Mutex<HashMap<u64, Column>>,
}

/// A range of consecutive S.
struct Row {
    /// The distance from y, in steps.
    distance: f64,
    /// The smallest and the largest S/N of the row.
    low: f64,
    high: f64,
    /// Number of values of S.
    count: f64,
    /// The mean of P(y | S).
    probability: f64,
}

impl LookupTable {
    /// Creates a table for `total` indices and a register of `phase_bits` bits.
    ///
    /// Intervals hold the fraction `mass`, in (0, 1), of a column. The register reads a value from
    /// its distribution with probability `intact`, and otherwise any value.
    ///
    /// # Errors
    ///
    /// No indices, or a register out of range.
    pub fn new(total: u64, phase_bits: u32, mass: f64, intact: f64) -> Result<Self, CountingError> {
        check_counts(0, total)?;
        Ok(Self {
            total,
            phase_bits,
            register: register(phase_bits, Window::Rect)?,
            mass,
            intact,
            columns: Mutex::default(),
        })
    }

    /// N, the number of all indices.
    pub fn total(&self) -> u64 {
        self.total
    }

    /// The column of the reading `y`, folded onto `0 ..= T/2`.
    ///
    /// # Errors
    ///
    /// A reading beyond T/2.
    pub fn column(&self, y: u64) -> Result<Column, CountingError> {
        let columns = || self.columns.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(&column) = columns().get(&y) {
            return Ok(column);
        }
        let column = self.compute(y)?;
        let mut columns = columns();
        if columns.len() < KEPT {
            columns.insert(y, column);
        }
        Ok(column)
    }

    fn compute(&self, y: u64) -> Result<Column, CountingError> {
        let largest = self.register.size() / 2;
        if y > largest {
            return Err(CountingError::OutcomeOutOfRange {
                outcome: y,
                largest,
            });
        }
        let likeliest = maximum_likelihood(&[y], self.total, self.phase_bits, Window::Rect);
        let mut rows = self.rows(y);
        rows.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let (good, ln_likelihood) = match likeliest {
            Ok(best) => (best.good, best.ln_likelihood),
            // No S produces `y`, so noise has changed the reading: returns the nearest S.
            Err(CountingError::ImpossibleOutcomes) => {
                let nearest = rows.first().map_or(0.0, |row| 0.5 * (row.low + row.high));
                (
                    (nearest * self.total as f64).round() as u64,
                    f64::NEG_INFINITY,
                )
            }
            Err(error) => return Err(error),
        };
        // A destroyed register reads all T values equally often. Folding merges two of them, except
        // at the ends.
        let readings = if self.is_end(y) { 1.0 } else { 2.0 };
        let any = (1.0 - self.intact) * readings / self.register.size() as f64;
        let noisy = |probability: f64| self.intact * probability + any;
        let weight = |row: &Row| row.count * noisy(row.probability);
        let all: f64 = rows.iter().map(weight).sum();
        if all <= 0.0 {
            return Ok(Column {
                good,
                ln_likelihood,
                certainty: 0.0,
                interval: (0.0, 1.0),
            });
        }
        let middle = good as f64 / self.total as f64;
        let mut interval = (middle, middle);
        let mut gathered = 0.0;
        for row in &rows {
            if gathered >= self.mass * all {
                break;
            }
            gathered += weight(row);
            interval = (interval.0.min(row.low), interval.1.max(row.high));
        }
        Ok(Column {
            good,
            ln_likelihood,
            certainty: (noisy(libm::exp(ln_likelihood)) / all).min(1.0),
            interval,
        })
    }

    fn is_end(&self, y: u64) -> bool {
        y == 0 || y == self.register.size() / 2
    }

    fn rows(&self, y: u64) -> Vec<Row> {
        if self.total <= FEW_IDS {
            return self.single(y, 0, self.total);
        }
        let half = (self.register.size() / 2) as f64;
        let (low, high) = (y.saturating_sub(NEAR), (y + NEAR).min(half as u64));
        let first = (self.amplitude(low as f64) * self.total as f64) as u64;
        let last = (self.amplitude(high as f64) * self.total as f64) as u64;
        let mut near = if last - first <= FEW_IDS {
            // Adds rows beyond, so that there is a row even if a step holds no S.
            let beyond = FEW_IDS / 2;
            let last = last.saturating_add(beyond).min(self.total);
            self.single(y, first.saturating_sub(beyond), last)
        } else {
            self.fine(y, low, high)
        };
        let theta = |amplitude: f64| {
            2.0 * half / PI * libm::atan2(amplitude.sqrt(), (1.0 - amplitude).sqrt())
        };
        let left = near.iter().map(|row| row.low).fold(1.0, f64::min);
        let right = near.iter().map(|row| row.high).fold(0.0, f64::max);
        let (left, right) = (theta(left), theta(right));
        self.coarse(y, left, 0.0, &mut near);
        self.coarse(y, right, half, &mut near);
        near
    }

    /// One row for every S in `first ..= last`.
    fn single(&self, y: u64, first: u64, last: u64) -> Vec<Row> {
        let row = |good| {
            let phase = Phase::from_counts(good, self.total, &self.register);
            let amplitude = good as f64 / self.total as f64;
            Row {
                distance: ((phase.cell as f64 - y as f64) + phase.offset).abs(),
                low: amplitude,
                high: amplitude,
                count: 1.0,
                probability: libm::exp(ln_probability(&self.register, phase, y)),
            }
        };
        (first..=last).map(row).collect()
    }

    /// [`ROWS`] rows per step, from step `low` to step `high`.
    fn fine(&self, y: u64, low: u64, high: u64) -> Vec<Row> {
        let row = |(cell, part): (u64, u64)| {
            let at = |part: f64| cell as f64 + part / ROWS as f64;
            let (from, to) = (at(part as f64), at(part as f64 + 1.0));
            let remainder = (part as f64 + 0.5) / ROWS as f64;
            let phase = Phase::at(cell, remainder);
            Row {
                distance: ((cell as f64 - y as f64) + remainder).abs(),
                low: self.amplitude(from),
                high: self.amplitude(to),
                count: self.ids(from, to),
                probability: libm::exp(ln_probability(&self.register, phase, y)),
            }
        };
        let parts = |cell| (0..ROWS).map(move |part| (cell, part));
        (low..high).flat_map(parts).map(row).collect()
    }

    /// Adds rows from the phase `start` to the phase `end`, both in steps.
    ///
    /// The length of a row is a fifth of its distance from y, and at least one step.
    fn coarse(&self, y: u64, start: f64, end: f64, rows: &mut Vec<Row>) {
        let size = self.register.size() as f64;
        let mean = |distance: f64| {
            let sine = size * libm::sin(PI * (distance / size));
            0.5 / (sine * sine)
        };
        let y_steps = y as f64;
        let outwards = if end > start { 1.0 } else { -1.0 };
        let mut from = start;
        while outwards * (end - from) > 1e-3 {
            let step = (0.2 * (from - y_steps).abs()).max(1.0);
            let to = if step < outwards * (end - from) {
                from + outwards * step
            } else {
                end
            };
            let middle = 0.5 * (from + to);
            let mirrored = if self.is_end(y) {
                0.0
            } else {
                mean(middle + y_steps)
            };
            let (low, high) = (from.min(to), from.max(to));
            rows.push(Row {
                distance: (to - y_steps).abs(),
                low: self.amplitude(low),
                high: self.amplitude(high),
                count: self.ids(low, high),
                probability: (mean(middle - y_steps) + mirrored).min(1.0),
            });
            from = to;
        }
    }

    /// S/N for a phase of `steps` steps.
    fn amplitude(&self, steps: f64) -> f64 {
        let sine = libm::sin(PI * (steps / self.register.size() as f64));
        sine * sine
    }

    /// Number of S between two phases: `N (sin^2 b - sin^2 a)`, without cancellation.
    fn ids(&self, from: f64, to: f64) -> f64 {
        let size = self.register.size() as f64;
        let sines = libm::sin(PI * ((to - from) / size)) * libm::sin(PI * ((to + from) / size));
        self.total as f64 * sines
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PhaseDistribution;

    /// P(y | S), all rows.
    fn rows(total: u64, bits: u32, y: u64) -> Vec<f64> {
        let row = |good| {
            let distribution = PhaseDistribution::new(good, total, bits, Window::Rect);
            distribution.unwrap().probability(y)
        };
        (0..=total).map(row).collect()
    }

    /// Compares with Johnston's table for 4 x 4 subpixels and 4 phase qubits, and with other
    /// tables, entry by entry: the largest entry of each column, its fraction, and the rows around
    /// it.
    #[test]
    fn columns_are_those_of_the_whole_table() {
        for (total, bits) in [(16, 4), (16, 2), (64, 7), (1, 3), (7, 1), (1000, 5)] {
            let table = LookupTable::new(total, bits, 0.9, 1.0).unwrap();
            for y in 0..=1 << (bits - 1) {
                let rows = rows(total, bits, y);
                let sum: f64 = rows.iter().sum();
                let column = table.column(y).unwrap();
                if sum == 0.0 {
                    assert_eq!((column.certainty, column.interval), (0.0, (0.0, 1.0)));
                    continue;
                }
                let largest = rows.iter().copied().fold(0.0, f64::max);
                assert!((rows[column.good as usize] / largest - 1.0).abs() < 1e-9);
                assert!(
                    (column.certainty - largest / sum).abs() < 1e-9,
                    "{total} {bits} {y}"
                );
                assert!((libm::exp(column.ln_likelihood) - largest).abs() < 1e-9);
                let inside = |good: usize| {
                    let fraction = good as f64 / total as f64;
                    column.interval.0 <= fraction && fraction <= column.interval.1
                };
                let gathered: f64 = (0..rows.len())
                    .filter(|&i| inside(i))
                    .map(|i| rows[i])
                    .sum();
                assert!(inside(column.good as usize) && gathered >= 0.9 * sum * (1.0 - 1e-9));
                assert_eq!(table.column(y), Ok(column));
            }
            assert!(table.column((1 << (bits - 1)) + 1).is_err());
        }
    }

    /// Compares merged rows with single rows.
    #[test]
    fn gathered_rows_are_worth_the_single_ones() {
        for (total, bits) in [(20_000, 4), (20_000, 9), (3000, 12), (5000, 8)] {
            let table = LookupTable::new(total, bits, 0.95, 1.0).unwrap();
            let half = 1_u64 << (bits - 1);
            for y in [0, 1, 2, half / 3, half / 2, half - 1, half] {
                let rows = rows(total, bits, y);
                let sum: f64 = rows.iter().sum();
                let column = table.column(y).unwrap();
                let fraction = |i: usize| i as f64 / total as f64;
                let gathered: f64 = (0..rows.len())
                    .filter(|&i| {
                        column.interval.0 <= fraction(i) && fraction(i) <= column.interval.1
                    })
                    .map(|i| rows[i])
                    .sum();
                let mass = gathered / sum;
                assert!(mass > 0.945, "{total} {bits} {y}: {mass}");
                let certainty = rows[column.good as usize] / sum;
                assert!(
                    (column.certainty / certainty - 1.0).abs() < 0.02,
                    "{total} {bits} {y}"
                );
            }
        }
    }

    /// Computes columns for registers and numbers of indices of every magnitude.
    #[test]
    fn no_size_is_too_large() {
        for total in [1, 2, 1000, 1 << 30, 1 << 60] {
            for bits in [1, 2, 11, 30, 40] {
                for intact in [1.0, 0.99, 0.0] {
                    let table = LookupTable::new(total, bits, 0.95, intact).unwrap();
                    let half = 1_u64 << (bits - 1);
                    for y in [0, 1, half / 5, half / 2, half] {
                        let column = table.column(y).unwrap();
                        let (low, high) = column.interval;
                        let fraction = column.good as f64 / total as f64;
                        assert!(0.0 <= low && low <= fraction && fraction <= high && high <= 1.0);
                        assert!((0.0..=1.0).contains(&column.certainty));
                        if intact == 1.0 && bits == 30 && total == 1 << 60 && y == half / 5 {
                            // The interval has two steps on either side, of pi sin(2 pi / 10) / T
                            // each.
                            assert!((high - low) * (1 << 30) as f64 > 7.0);
                            assert!((high - low) * ((1 << 30) as f64) < 8.5);
                        }
                    }
                }
            }
        }
        assert!(LookupTable::new(0, 3, 0.95, 1.0).is_err());
        assert!(LookupTable::new(3, 41, 0.95, 1.0).is_err());
    }
}
