//! A summary of the measurements, in a few lines.

use super::figures::estimators;
use super::fronts::{PRICES, candidates, front};
use super::table::{COUNTING, ERRORS, TOTAL};
use super::{Sweep, Trade};
use super::{advice, rivals};
use qrt_drawing::Fit;
use std::fmt::Write as _;

/// Number of lines of a front that are shown.
const SHOWN: usize = 6;

pub(super) fn text(trade: &Trade) -> String {
    let mut out = String::new();
    let [pixels, film] = trade.pixels;
    let _ = writeln!(
        out,
        "{}: {} settings on {pixels} of {film} pixels, seed {}, against 2^{} paths of another seed",
        trade.name.escape_debug(),
        trade.rows.len(),
        trade.seed,
        trade.reference_bits,
    );
    if let Some(row) = trade.scene() {
        let errors: Vec<String> = ERRORS
            .iter()
            .zip(row.errors)
            .map(|(name, band)| format!("{name} {:.2} %", 100.0 * band.value))
            .collect();
        let _ = writeln!(out, "as it is: {}", errors.join(", "));
        let _ = writeln!(
            out,
            "          {:.0} queries a pixel, {} Toffoli, {} qubits",
            row.queries, row.cost.toffoli, row.cost.qubits
        );
    }
    for line in advice::sentences(trade) {
        let _ = writeln!(out, "{line}");
    }
    let slopes = slopes(trade);
    if !slopes.is_empty() {
        let _ = writeln!(out, "slope of E_T over queries: {}", slopes.join(", "));
    }
    let (_, title, _, price) = PRICES[0];
    let best = front(&candidates(trade), price);
    let _ = writeln!(out, "least total error by {title} of a pixel:");
    let step = best.len().div_ceil(SHOWN).max(1);
    for row in best
        .iter()
        .rev()
        .step_by(step)
        .collect::<Vec<_>>()
        .iter()
        .rev()
    {
        let _ = writeln!(
            out,
            "  {:>9.0}  {:>7.2} %  {}",
            row.queries,
            100.0 * row.errors[TOTAL].value,
            row.setting.described()
        );
    }
    for line in rivals::sentences(trade) {
        let _ = writeln!(out, "{line}");
    }
    for (setting, why) in &trade.left_out {
        let _ = writeln!(out, "left out: {}: {why}", setting.described());
    }
    out
}

/// For each estimator: the slope of its error over its queries.
fn slopes(trade: &Trade) -> Vec<String> {
    let slope = |name| {
        let rows = trade.rows_of(Sweep::Counting);
        let points = rows.filter(|row| row.setting.estimator == name).map(|row| {
            let error = row.errors[COUNTING].value;
            (libm::log10(row.queries), libm::log10(error))
        });
        let fit = Fit::from_points(points.filter(|(x, y)| x.is_finite() && y.is_finite()))?;
        Some(format!("{name} {:.2}", fit.slope))
    };
    let names = estimators(trade, Sweep::Counting).into_iter();
    names.filter_map(slope).collect()
}
