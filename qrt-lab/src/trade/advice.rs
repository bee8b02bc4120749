//! Advice on the next change: the parameter that reduces the error most for its price.

use super::fronts::candidates;
use super::setting::Setting;
use super::table::{Row, TOTAL};
use super::{Sweep, Trade};
use crate::shell;

/// Names of the parts of the error, in the order of [`super::ERRORS`], without the total.
const PARTS: [&str; 5] = ["paths", "comparators", "width", "counting", "depth"];
/// Index of the error of depth, which is not in the total.
const DEPTH: usize = 4;

/// The ratio of error, or of price, from which a change is worthwhile: a tenth less.
const WORTH: f64 = 0.9;

/// Returns sentences that advise on the next change.
///
/// They name the largest part of the error, the best change at no greater price, the change that
/// reduces the error most for its price, and the change that saves most at about the same error.
pub(super) fn sentences(trade: &Trade) -> Vec<String> {
    let Some(own) = trade.scene() else {
        return Vec::new();
    };
    let mut said = Vec::new();
    let parts = own.errors[..DEPTH].iter().zip(PARTS);
    let largest = parts.max_by(|(a, _), (b, _)| a.value.total_cmp(&b.value));
    if let Some((band, name)) = largest.filter(|(band, _)| band.value > 0.0) {
        said.push(format!(
            "The largest part of the error is that of {name}, {}.",
            percent(band.value)
        ));
    }
    let error = own.errors[TOTAL].value;
    let price = own.toffoli_x_queries();
    let measured = [error, price]
        .iter()
        .all(|figure| figure.is_finite() && *figure > 0.0);
    if !measured {
        return said;
    }
    let others: Vec<Change<'_>> = candidates(trade)
        .into_iter()
        .filter_map(|row| Change::between(own, row, error, price))
        .collect();
    let free = others
        .iter()
        .filter(|change| change.price <= 1.0 && change.error <= WORTH);
    let free = free.min_by(|a, b| a.error.total_cmp(&b.error));
    if let Some(change) = free {
        said.push(format!(
            "Better at no greater price: {}, with a total error of {} in place of {} and {} times the \
             Toffolis.",
            change.sets,
            percent(change.row.errors[TOTAL].value),
            percent(error),
            times(change.price),
        ));
    }
    // Errors fall by powers of the price, so the steepest change reduces the error most.
    let dearer = others
        .iter()
        .filter(|change| change.price > 1.0 && change.error <= WORTH);
    let steepest = dearer.min_by(|a, b| a.slope().total_cmp(&b.slope()));
    match steepest {
        Some(change) => said.push(format!(
            "Most for its price: {}, with a total error of {} in place of {}, for {} times the Toffolis.",
            change.sets,
            percent(change.row.errors[TOTAL].value),
            percent(error),
            times(change.price),
        )),
        None if free.is_none() => said.push(
            "No change of one parameter alone takes a tenth off the total error: change those of the \
             two largest parts together."
                .to_owned(),
        ),
        None => {}
    }
    let cheaper = others
        .iter()
        .filter(|change| change.error <= 1.02 && change.price <= WORTH);
    if let Some(change) = cheaper.min_by(|a, b| a.price.total_cmp(&b.price)) {
        said.push(format!(
            "As good for less: {}, for {} times the Toffolis.",
            change.sets,
            times(change.price)
        ));
    }
    said
}

/// A row compared with the scene's own.
struct Change<'a> {
    row: &'a Row,
    /// The options of the command line that make the change.
    sets: String,
    /// Total error, as a fraction of the scene's.
    error: f64,
    /// Toffolis of all queries, as a fraction of the scene's.
    price: f64,
}

impl<'a> Change<'a> {
    fn between(own: &Row, row: &'a Row, error: f64, price: f64) -> Option<Self> {
        if matches!(row.setting.sweep, Sweep::Scene | Sweep::Model) {
            return None;
        }
        let change = Self {
            row,
            sets: sets(&own.setting, &row.setting)?,
            error: row.errors[TOTAL].value / error,
            price: row.toffoli_x_queries() / price,
        };
        (change.price > 0.0).then_some(change)
    }

    /// The power of the price with which the error falls; below 0.
    fn slope(&self) -> f64 {
        // A smaller increase of the price than a twentieth counts as a twentieth.
        libm::log(self.error) / libm::log(self.price).max(0.05)
    }
}

/// The options of the command line that change `own` into `other`; `None` if nothing changes.
fn sets(own: &Setting, other: &Setting) -> Option<String> {
    let keys = own.keys().into_iter().zip(other.keys());
    let changed: Vec<String> = keys
        .filter(|(own, other)| own != other)
        .map(|(_, (key, other))| format!("--set {}", shell::word(&format!("{key}={other}"))))
        .collect();
    (!changed.is_empty()).then(|| changed.join(" "))
}

fn percent(value: f64) -> String {
    format!("{:.2} %", 100.0 * value)
}

fn times(value: f64) -> String {
    let digits = usize::from(value < 10.0) + usize::from(value < 1.0);
    format!("{value:.digits$}")
}
