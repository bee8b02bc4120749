//! The Pareto fronts of the total error against each price.

use super::figure::{Figure, series};
use super::setting::Sweep;
use super::styles::style;
use super::table::{Row, TOTAL};
use super::{Trade, pareto};
use qrt_drawing::{Drawn, Plot, PlotAxis, Series};

/// Rows that a front may hold: counted on all pixels, with the scene's own length of paths.
pub(super) fn candidates(trade: &Trade) -> Vec<&Row> {
    let rows = trade.rows.iter();
    let counted = |sweep: Sweep| sweep != Sweep::Depth && !sweep.leaves_lamps_out();
    rows.filter(|row| counted(row.setting.sweep)).collect()
}

/// A function that returns a price of a row.
pub(super) type Price = fn(&Row) -> f64;

/// The prices: the figure's name, the title, the axis, and the function.
pub(super) const PRICES: [(&str, &str, &str, Price); 4] = [
    ("front-queries", "queries", "queries of a pixel", |row| {
        row.queries
    }),
    (
        "front-toffoli",
        "Toffoli \u{d7} queries",
        "Toffoli \u{d7} queries of a pixel",
        |row| row.toffoli_x_queries(),
    ),
    ("front-qubits", "qubits", "qubits of the oracle", |row| {
        row.cost.qubits as f64
    }),
    (
        "front-seconds",
        "seconds of simulation",
        "seconds of a pixel",
        |row| row.seconds,
    ),
];

/// The front of `rows` under `price`, from the cheapest row on.
pub(super) fn front<'a>(rows: &[&'a Row], price: Price) -> Vec<&'a Row> {
    let points: Vec<(f64, f64)> = rows
        .iter()
        .map(|row| (price(row), row.errors[TOTAL].value))
        .collect();
    pareto(&points).into_iter().map(|at| rows[at]).collect()
}

pub(super) fn fronts(trade: &Trade) -> impl Iterator<Item = Figure> {
    PRICES.into_iter().map(|(name, title, axis, price)| {
        let rows = candidates(trade);
        let best = front(&rows, price);
        let others = rows.iter().map(|row| (price(row), row.errors[TOTAL].value));
        Figure {
            name,
            plot: Plot {
                title: format!("Total error against {title}"),
                x: PlotAxis::log(axis),
                y: PlotAxis::log("total: RMSE / mean radiance"),
                series: vec![
                    Series {
                        style: style("all settings"),
                        ..Series::new("all settings", others, Drawn::Points)
                    },
                    series("the front", best.into_iter(), price, TOTAL, Drawn::Steps),
                ],
            },
            says: "Settings that no other beats in both, from the cheapest to the best, among all \
                   settings.",
        }
    })
}
