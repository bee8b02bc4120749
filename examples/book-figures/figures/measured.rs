//! Figures of measured tables: `book/data`.

use super::{Figure, root, style};
use qrt::drawing::{Drawn, Fit, Plot, PlotAxis, Point, Series};
use qrt::lab::trade::pareto;

/// A table: its columns' names and its rows.
pub(super) struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// Reads a table; lines that begin with `#` name its source.
    pub(super) fn read(name: &str) -> Self {
        let file = root().join("book/data").join(name);
        let text = std::fs::read_to_string(&file);
        let text = text.unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        let mut lines = text.lines().filter(|line| !line.starts_with('#'));
        let cells = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
        let columns = cells(lines.next().expect("a table names its columns"));
        let rows: Vec<Vec<String>> = lines.map(cells).collect();
        assert!(rows.iter().all(|row| row.len() == columns.len()), "{name}");
        Self { columns, rows }
    }

    fn column(&self, name: &str) -> usize {
        let at = self.columns.iter().position(|column| column == name);
        at.unwrap_or_else(|| panic!("no column {name}"))
    }

    /// Returns the different values of a column, in their order.
    fn values(&self, name: &str) -> Vec<String> {
        let at = self.column(name);
        let mut found: Vec<String> = Vec::new();
        for row in &self.rows {
            if !found.contains(&row[at]) {
                found.push(row[at].clone());
            }
        }
        found
    }

    /// Returns the numbers in the columns `of`, from rows whose cells have the values in `asked`.
    pub(super) fn numbers<const N: usize>(
        &self,
        asked: &[(&str, &str)],
        of: [&str; N],
    ) -> Vec<[f64; N]> {
        let columns = of.map(|name| self.column(name));
        let asked: Vec<(usize, &str)> = (asked.iter())
            .map(|(name, value)| (self.column(name), *value))
            .collect();
        let rows = self.rows.iter();
        let rows = rows.filter(|row| asked.iter().all(|(at, value)| row[*at] == *value));
        rows.map(|row| columns.map(|at| row[at].parse().expect("a number")))
            .collect()
    }
}

fn slope(points: &[[f64; 2]]) -> f64 {
    let logarithms = points
        .iter()
        .map(|[x, y]| (libm::log10(*x), libm::log10(*y)));
    Fit::from_points(logarithms).map_or(0.0, |fit| fit.slope)
}

/// Draws the error over the number of paths.
pub(super) fn truncation() -> Figure {
    let table = Table::read("truncation.csv");
    let names = table.values("paths");
    let of = |name: &str| table.numbers(&[("paths", name)], ["path_bits", "dark"]);
    let says: Vec<String> = names
        .iter()
        .map(|name| {
            let at = |bits: f64| of(name).iter().find(|p| p[0] == bits).map_or(0.0, |p| p[1]);
            let [a, b, c] = [12.0, 15.0, 18.0].map(|bits| 100.0 * at(bits));
            let points = of(name);
            let over: Vec<_> = points.iter().map(|p| [libm::exp2(p[0]), p[1]]).collect();
            format!(
                "{name}: {a:.1}, {b:.1}, {c:.1} % with 2^12, 2^15, 2^18 paths, slope {:.2}",
                slope(&over)
            )
        })
        .collect();
    let says = format!(
        "RMSE over the mean of the Cornell box, D = 3, 16 x 16 pixels without those that see the \
         lamp, to an independent renderer's picture. {}.",
        says.join("; ")
    );
    let series = names.iter().map(|name| {
        let points = of(name).into_iter().map(|[x, y]| (x, y));
        Series::new(name, points, Drawn::Fit).styled(style(name))
    });
    let plot = Plot {
        title: "Error of a picture over the number of paths".to_owned(),
        x: PlotAxis::bits("path bits, log₂ of the paths a pixel"),
        y: PlotAxis::log("RMSE over the mean"),
        series: series.collect(),
    };
    Figure::drawn(plot.draw(), says)
}

/// Draws every estimator on one kind of amplitudes.
fn estimators(amplitudes: &str, error: &str, title: &str, axis: &str, what: &str) -> Figure {
    let table = Table::read("estimators.csv");
    let names = table.values("estimator");
    let of = |name: &str| {
        let asked = [("amplitudes", amplitudes), ("estimator", name)];
        table.numbers(&asked, ["queries", error])
    };
    let says: Vec<String> = names
        .iter()
        .map(|name| {
            let points = of(name);
            let costs = points.iter().map(|[queries, error]| queries * error);
            let (low, high) = costs.fold((f64::INFINITY, 0.0_f64), |(low, high), cost| {
                (low.min(cost), high.max(cost))
            });
            format!(
                "{name}: slope {:.2}, queries x error {low:.2} to {high:.2}",
                slope(&points)
            )
        })
        .collect();
    let says = format!("{what} {}.", says.join("; "));
    let series = names.iter().map(|name| {
        let points = of(name).into_iter().map(|[x, y]| (x, y));
        Series::new(name, points, Drawn::Fit).styled(style(name))
    });
    let plot = Plot {
        title: title.to_owned(),
        x: PlotAxis::log("queries, applications of the oracle"),
        y: PlotAxis::log(axis),
        series: series.collect(),
    };
    Figure::drawn(plot.draw(), says)
}

pub(super) fn estimators_error() -> Figure {
    estimators(
        "even",
        "q95",
        "95th-percentile error: amplitudes even over [0, 1]",
        "95th-percentile error of S/N",
        "The 95th-percentile error of an estimated amplitude, over queries.",
    )
}

pub(super) fn estimators_rmse() -> Figure {
    estimators(
        "even",
        "rmse",
        "Root mean square error: amplitudes even over [0, 1]",
        "RMSE of S/N",
        "The root mean square error of an estimated amplitude over queries.",
    )
}

pub(super) fn estimators_pixels() -> Figure {
    estimators(
        "pixels",
        "q95",
        "95th-percentile error: pixels of the Cornell box",
        "95th-percentile error of S/N",
        "The 95th-percentile error of the amplitudes of the Cornell box's pixels, 64 x 64, \
         which are mostly small, over queries.",
    )
}

/// Returns the points (queries, error) of rows, in ascending order of queries.
fn points(table: &Table, asked: &[(&str, &str)], error: &str) -> Vec<Point> {
    let [low, high] = ["low", "high"].map(|end| format!("{error}_{end}"));
    let numbers = table.numbers(asked, ["queries", error, &low, &high]);
    let mut points: Vec<Point> = (numbers.into_iter())
        .map(|[x, y, low, high]| Point { x, y, low, high })
        .collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x));
    points
}

/// Draws a scene's settings: error against queries.
pub(super) fn trade() -> Figure {
    let table = Table::read("trade.csv");
    let bare = |point: Point| Point {
        low: point.y,
        high: point.y,
        ..point
    };
    let mut rest = Vec::new();
    // These sweeps have other lengths of paths, or fewer pixels and no circuit.
    let others = ["depth", "beside-rivals", "random-paths", "classical-net"];
    for sweep in table.values("sweep") {
        if !others.contains(&sweep.as_str()) {
            rest.extend(
                points(&table, &[("sweep", &sweep)], "e_total")
                    .into_iter()
                    .map(bare),
            );
        }
    }
    let all: Vec<(f64, f64)> = rest.iter().map(|point| (point.x, point.y)).collect();
    let front: Vec<Point> = pareto(&all).into_iter().map(|at| rest[at]).collect();
    let of = |estimator: &str| {
        let asked = [("sweep", "counting"), ("estimator", estimator)];
        points(&table, &asked, "e_total")
            .into_iter()
            .map(bare)
            .collect::<Vec<_>>()
    };
    let drawn = |name: &str, points: Vec<Point>, drawn: Drawn| Series {
        name: name.to_owned(),
        points,
        drawn,
        style: Some(style(name)),
    };
    let ends = [front.first(), front.last()].map(|p| p.map_or([0.0; 2], |p| [p.x, 100.0 * p.y]));
    let [own] = points(&table, &[("sweep", "scene")], "e_total")[..] else {
        panic!("one row of the scene as it is")
    };
    let says = format!(
        "Total error of the Cornell box's pixels over their mean against queries of a pixel (three \
         channels together), {} settings of `qrt trade`, and the Pareto front of those that no \
         other beats in both: from {:.0} % with {:.0} queries to {:.2} % with {:.0}. The scene as it \
         is: {:.2} % with {:.0} queries.",
        rest.len(),
        ends[0][1],
        ends[0][0],
        ends[1][1],
        ends[1][0],
        100.0 * own.y,
        own.x,
    );
    let plot = Plot {
        title: "The Cornell box: total error against queries".to_owned(),
        x: PlotAxis::log("queries of a pixel"),
        y: PlotAxis::log("total error: RMSE over the mean"),
        series: vec![
            drawn("all settings", rest, Drawn::Points),
            drawn("the front", front, Drawn::Steps),
            drawn("adaptive-bayes", of("adaptive-bayes"), Drawn::Joined),
            drawn("paper", of("paper"), Drawn::Joined),
            drawn("monte-carlo", of("monte-carlo"), Drawn::Joined),
        ],
    };
    Figure::drawn(plot.draw(), says)
}

/// Draws the parts of the error.
pub(super) fn parts() -> Figure {
    const PARTS: [(&str, &str); 5] = [
        ("total", "e_total"),
        ("counting, E_T", "e_t"),
        ("paths, E_R", "e_r"),
        ("width, E_W", "e_w"),
        ("comparators, E_C", "e_c"),
    ];
    let table = Table::read("trade.csv");
    let asked = [("sweep", "counting"), ("estimator", "adaptive-bayes")];
    let says: Vec<String> = (PARTS.iter())
        .map(|(name, error)| {
            let own = points(&table, &[("sweep", "scene")], error);
            format!(
                "{name} {:.3} %",
                own.first().map_or(0.0, |point| 100.0 * point.y)
            )
        })
        .collect();
    let says = format!(
        "Parts of the Cornell box's error over its mean, by adaptive-bayes with more and more \
         queries; with the scene's own settings: {}. Only counting's part falls with queries.",
        says.join(", ")
    );
    let series = PARTS.map(|(name, error)| Series {
        name: name.to_owned(),
        points: points(&table, &asked, error),
        drawn: Drawn::Joined,
        style: Some(style(name)),
    });
    let plot = Plot {
        title: "Where the Cornell box's error comes from".to_owned(),
        x: PlotAxis::log("queries of a pixel"),
        y: PlotAxis::log("RMSE over the mean"),
        series: series.into(),
    };
    Figure::drawn(plot.draw(), says)
}

/// Compares counting with random paths, and with a net that is run classically.
pub(super) fn rivals() -> Figure {
    const ALL: [(&str, &str, &str); 3] = [
        ("beside-rivals", "e_t", "counting"),
        ("random-paths", "e_total", "random paths"),
        ("classical-net", "e_total", "digital net"),
    ];
    let table = Table::read("trade.csv");
    let mut said = Vec::new();
    let series = ALL.map(|(sweep, error, name)| {
        let points = points(&table, &[("sweep", sweep)], error);
        let over: Vec<_> = points.iter().map(|p| [p.x, p.y]).collect();
        said.push(format!("{name}: slope {:.2}", slope(&over)));
        let bare = points.iter().map(|p| (p.x, p.y));
        Series::new(name, bare, Drawn::Fit).styled(style(name))
    });
    let says = format!(
        "Error of a pixel of the Cornell box over its mean: of counting over the queries of all three \
         channels, of random paths and of the same net of paths run classically over the paths, both \
         with sampled lamps; by `qrt trade`, quick, on pixels that see no lamp. {}.",
        said.join("; ")
    );
    let plot = Plot {
        title: "Counting and its rivals, Cornell box".to_owned(),
        x: PlotAxis::log("queries, or paths, of a pixel"),
        y: PlotAxis::log("RMSE over the mean"),
        series: series.into(),
    };
    Figure::drawn(plot.draw(), says)
}
