//! The fringe of the mean phase, and its errors beside those of counting.

use super::measured::Table;
use super::{Figure, style};
use qrt::circuit::quantum::LevelPhases;
use qrt::counting::mean_phase_probabilities;
use qrt::drawing::{Canvas, Drawn, Panel, Plot, PlotAxis, Series, ticks};
use std::f64::consts::FRAC_PI_2;

/// Levels of a pixel's paths, of 1,024, and their numbers: as of a wall that a lamp lights.
const LEVELS: std::ops::Range<u64> = 60..110;
const BITS: u32 = 10;
/// The largest distance of the reference from the mean, in standard deviations.
const REACH: f64 = 0.6;

/// Draws the probability of the outcome 0 over the reference, and that of a good index of counting over
/// the mean.
pub(super) fn fringe() -> Figure {
    let levels: Vec<(u64, u64)> = LEVELS.map(|level| (level, 4)).collect();
    let count = levels.len() as f64;
    let scale = f64::from(1 << BITS);
    let mean = levels.iter().map(|(level, _)| *level as f64).sum::<f64>() / count / scale;
    let square = |(level, _): &(u64, u64)| (*level as f64 / scale - mean).powi(2);
    let sigma = (levels.iter().map(square).sum::<f64>() / count).sqrt();
    let phase = |k: u64, distance: f64| {
        let reference = mean - distance * sigma;
        let phases = LevelPhases::new(0.6 / sigma, reference, BITS, 40).expect("phases");
        let outcomes = mean_phase_probabilities(&levels, phases, k, FRAC_PI_2);
        outcomes.iter().map(|[zero, _]| zero).sum::<f64>()
    };
    // Counting, at the reference to which its phase is most sensitive.
    let counting = |k: f64, distance: f64| {
        let angle = |mean: f64| (2.0 * (2.0 * k + 1.0)) * libm::asin(mean.sqrt());
        0.5 + 0.5 * libm::sin(angle(mean + distance * sigma) - angle(mean))
    };
    let mut canvas = Canvas::new(
        "An outcome's probability over the mean: 4 and 16 iterates",
        580.0,
        360.0,
    );
    let panel = Panel {
        edges: [76.0, 40.0, 560.0, 290.0],
        x: [-REACH, REACH],
        y: [0.0, 1.2],
    };
    panel.axes(
        &mut canvas,
        [
            &ticks((-3..=3).map(|n| 0.2 * f64::from(n)), 1),
            &ticks((0..=5).map(|n| 0.2 * f64::from(n)), 1),
        ],
        ["mean less reference, in standard deviations", "probability"],
    );
    let places = (-120..=120).map(|n| REACH * f64::from(n) / 120.0);
    let curves: [(&str, &dyn Fn(f64) -> f64); 3] = [
        ("line s1", &|x| counting(4.0, x)),
        ("line s0", &|x| phase(4, x)),
        ("line s2", &|x| phase(16, x)),
    ];
    for (class, value) in curves {
        let curve = panel.curve(places.clone().map(|x| [x, value(x)]));
        canvas.path(class, &curve);
    }
    let names = ["counting, 4 iterates", "mean phase, 4", "mean phase, 16"];
    for (((class, _), name), left) in curves.iter().zip(names).zip([86.0, 272.0, 418.0]) {
        let at = [left, 57.0];
        canvas.line(class, at, [at[0] + 24.0, at[1]]);
        canvas.text("", [at[0] + 32.0, at[1] + 4.0], name);
    }
    let slope = |value: &dyn Fn(f64) -> f64| (value(0.01) - value(-0.01)) / 0.02;
    let [counted, four, sixteen] = curves.map(|(_, value)| slope(value));
    let says = format!(
        "Probability of an outcome over the distance of the mean from the reference, from -0.6 to 0.6 \
         standard deviations of 200 paths of levels 60 to 109 of 1,024. Slopes at 0, per standard \
         deviation: {counted:.2} for counting with 4 iterates, a nearly flat line; {four:.2} for the \
         mean phase with 4, a fringe of a period of 0.9; {sixteen:.2} with 16, one of 0.22."
    );
    Figure::drawn(canvas, says)
}

/// Draws the errors of `auto`, of counting with strata and of one register on the pixels of the lit box.
pub(super) fn errors() -> Figure {
    let table = Table::read("mean-phase.csv");
    let of = |name: &str| {
        let asked = [("scene", "box lit"), ("estimator", name)];
        table.numbers(&asked, ["queries", "q95"])
    };
    let names = ["auto", "adaptive-bayes", "one register"];
    let says: Vec<String> = (names.iter())
        .map(|name| {
            let all: Vec<String> = of(name)
                .iter()
                .map(|[queries, times]| format!("{times:.1} with {queries}"))
                .collect();
            format!("{name}: {}", all.join(", "))
        })
        .collect();
    let says = format!(
        "The 95th-percentile error over queries on pixels of the box with sampled lamps, in standard \
         deviations of a pixel's paths. Queries times error: {}.",
        says.join("; ")
    );
    let series = names.iter().map(|name| {
        let points = of(name).into_iter();
        let points = points.map(|[queries, times]| (queries, times / queries));
        let look = if *name == "one register" {
            "sine"
        } else {
            name
        };
        Series::new(name, points, Drawn::Joined).styled(style(look))
    });
    let plot = Plot {
        title: "Pixels of the lit box: error in standard deviations of the paths".to_owned(),
        x: PlotAxis::log("queries"),
        y: PlotAxis::log("95th-percentile error over sigma"),
        series: series.collect(),
    };
    Figure::drawn(plot.draw(), says)
}
