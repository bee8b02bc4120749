//! The plots of `qrt trade`.

use super::Trade;
use super::figure::{Figure, series};
use super::fronts::fronts;
use super::rivals;
use super::setting::Sweep;
use super::styles::{free, hollow, style};
use super::table::{COMPARATORS, COUNTING, DEPTH, ERROR_NAMES, PATHS, Row, TOTAL, WIDTH};
use qrt_drawing::{Drawn, Plot, PlotAxis, Series};
use qrt_scene::{Estimator, Sequence};

/// All plots, in the page's order.
pub(super) fn all(trade: &Trade) -> Vec<Figure> {
    let mut figures = vec![
        split(trade),
        counting(trade),
        rivals::figure(trade),
        repetitions(trade),
        paths(trade),
    ];
    figures.extend([
        comparators(trade),
        fraction(trade),
        price(trade),
        depth(trade),
    ]);
    figures.extend(fronts(trade));
    figures.retain(|figure| {
        figure
            .plot
            .series
            .iter()
            .any(|series| !series.points.is_empty())
    });
    figures
}

fn relative() -> PlotAxis {
    PlotAxis::log("RMSE / mean radiance")
}

/// Estimators of a sweep, in its order.
pub(super) fn estimators(trade: &Trade, sweep: Sweep) -> Vec<Estimator> {
    let mut found: Vec<Estimator> = Vec::new();
    for row in trade.rows_of(sweep) {
        if !found.contains(&row.setting.estimator) {
            found.push(row.setting.estimator);
        }
    }
    found
}

fn split(trade: &Trade) -> Figure {
    let own = trade.scene().map(|row| row.setting.estimator);
    let rows = || {
        let rows = trade.rows_of(Sweep::Counting);
        rows.filter(move |row| Some(row.setting.estimator) == own)
    };
    let parts = [TOTAL, COUNTING, PATHS, COMPARATORS, WIDTH, DEPTH];
    let of = |error: usize| {
        series(
            ERROR_NAMES[error],
            rows(),
            |row| row.queries,
            error,
            Drawn::Joined,
        )
    };
    Figure {
        name: "split",
        plot: Plot {
            title: "Where the error comes from".to_owned(),
            x: PlotAxis::log("queries of a pixel"),
            y: relative(),
            series: parts.map(of).to_vec(),
        },
        says: "The scene's own estimator with more and more queries, and every other part of the \
               error, which queries do not change. More queries pay until counting is no longer the \
               largest part. The error of depth is not in the total.",
    }
}

fn counting(trade: &Trade) -> Figure {
    let of = |estimator: Estimator| {
        let rows = trade.rows_of(Sweep::Counting);
        let rows = rows.filter(|row| row.setting.estimator == estimator);
        series(
            estimator.name(),
            rows,
            |row| row.queries,
            COUNTING,
            Drawn::Fit,
        )
    };
    Figure {
        name: "counting",
        plot: Plot {
            title: "Counting: every estimator".to_owned(),
            x: PlotAxis::log("queries of a pixel"),
            y: PlotAxis::log("counting (E_T): RMSE / mean radiance"),
            series: estimators(trade, Sweep::Counting)
                .into_iter()
                .map(of)
                .collect(),
        },
        says: "How far estimates are from S/N. Classical sampling falls with the square root of the \
               queries, a slope of \u{2212}0.5; a quantum estimator without outliers with a slope of \
               \u{2212}1.",
    }
}

fn repetitions(trade: &Trade) -> Figure {
    let mut all: Vec<Series> = Vec::new();
    let own = trade.scene().map(|row| row.setting.estimator);
    for estimator in estimators(trade, Sweep::Repetitions) {
        // The scene's own estimator needs no name.
        let name = if Some(estimator) == own {
            String::new()
        } else {
            format!("{estimator}, ")
        };
        let filled = style(estimator.name()).unwrap_or(0);
        for (sweep, name, style) in [
            (Sweep::Counting, format!("{name}larger"), filled),
            (Sweep::Repetitions, format!("{name}again"), hollow(filled)),
        ] {
            let rows = trade.rows_of(sweep);
            let rows = rows.filter(|row| row.setting.estimator == estimator);
            let found = series(&name, rows, |row| row.queries, COUNTING, Drawn::Fit);
            let style = free(style, &all);
            all.push(found.styled(style));
        }
    }
    Figure {
        name: "repetitions",
        plot: Plot {
            title: "A larger phase register, or the same one again".to_owned(),
            x: PlotAxis::log("queries of a pixel"),
            y: PlotAxis::log("counting (E_T): RMSE / mean radiance"),
            series: all,
        },
        says: "The same queries used for more phase bits (larger) or for more repetitions (again), with \
               the scene's estimator and with the others that count with a register.",
    }
}

fn paths(trade: &Trade) -> Figure {
    let of = |sequence: Sequence| {
        let rows = trade.rows_of(Sweep::Paths);
        let rows = rows.filter(|row| row.setting.sequence == sequence);
        let bits = |row: &Row| f64::from(row.setting.path_bits);
        series(sequence.name(), rows, bits, PATHS, Drawn::Fit)
    };
    Figure {
        name: "paths",
        plot: Plot {
            title: "Paths, by their sequence".to_owned(),
            x: PlotAxis::bits("path bits"),
            y: PlotAxis::log("paths (E_R): RMSE / mean radiance"),
            series: Sequence::ALL.iter().copied().map(of).collect(),
        },
        says: "A path bit is one qubit and hardly a gate, but it doubles what a simulation traces. \
               Slopes are over the number of paths.",
    }
}

fn comparators(trade: &Trade) -> Figure {
    let bits = |row: &Row| f64::from(row.setting.comparator_bits);
    let rows = trade.rows_of(Sweep::Comparator);
    Figure {
        name: "comparators",
        plot: Plot {
            title: "Comparators".to_owned(),
            x: PlotAxis::bits("comparator bits"),
            y: PlotAxis::log("comparators (E_C): RMSE / mean radiance"),
            series: vec![series(
                ERROR_NAMES[COMPARATORS],
                rows,
                bits,
                COMPARATORS,
                Drawn::Fit,
            )],
        },
        says: "Counts of thresholds against the mean of the same paths. Slopes are over the number of \
               comparators.",
    }
}

fn fraction(trade: &Trade) -> Figure {
    let bits = |row: &Row| f64::from(row.setting.fraction);
    let of = |(error, drawn)| {
        series(
            ERROR_NAMES[error],
            trade.rows_of(Sweep::Fraction),
            bits,
            error,
            drawn,
        )
    };
    Figure {
        name: "fraction",
        plot: Plot {
            title: "Width of the circuit's numbers".to_owned(),
            x: PlotAxis::bits("fraction bits"),
            y: relative(),
            series: [(WIDTH, Drawn::Fit), (TOTAL, Drawn::Joined)]
                .map(of)
                .to_vec(),
        },
        says: "The circuit's numbers against real ones, on the same paths and comparators. Beyond some \
               width the total no longer falls.",
    }
}

fn price(trade: &Trade) -> Figure {
    let of = |name: &str, y: fn(&Row) -> u64| {
        let rows = trade.rows_of(Sweep::Fraction);
        let points = rows.map(|row| (f64::from(row.setting.fraction), y(row) as f64));
        Series::new(name, points, Drawn::Joined)
    };
    Figure {
        name: "price",
        plot: Plot {
            title: "What width costs".to_owned(),
            x: PlotAxis::bits("fraction bits"),
            y: PlotAxis::log("one call of the oracle"),
            series: vec![
                of("Toffoli", |row| row.cost.toffoli),
                of("qubits", |row| row.cost.qubits),
            ],
        },
        says: "Gates and qubits of the most expensive channel's oracle.",
    }
}

fn depth(trade: &Trade) -> Figure {
    let rays = |row: &Row| row.setting.depths as f64;
    let rows = trade.rows_of(Sweep::Depth);
    Figure {
        name: "depth",
        plot: Plot {
            title: "Length of paths".to_owned(),
            x: PlotAxis::bits("D, rays of a path"),
            y: PlotAxis::log("depth (E_D): RMSE / mean radiance"),
            series: vec![series(ERROR_NAMES[DEPTH], rows, rays, DEPTH, Drawn::Joined)],
        },
        says: "Light that longer paths would bring, in units of the scene's own mean radiance. It is \
               not an error of the circuit but of what it was asked.",
    }
}
