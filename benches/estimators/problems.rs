//! The estimation problems: amplitudes spread evenly, or the pixels of a picture.

use qrt::counting::estimators::CountingProblem;
use qrt::runtime::render::{Model, RenderOptions, render};
use qrt::scene::Estimator;
use qrt::scene::front;
use std::fmt;
use std::path::Path;

/// Amplitudes to run estimators on.
pub(crate) enum Problems {
    /// Amplitudes spread evenly over [0, 1], one for each run.
    Even,
    /// Every channel of the Cornell box's pixels, in their order, as often as needed.
    Pixels {
        film: u32,
        list: Vec<CountingProblem>,
    },
}

/// Number of indices for amplitudes that are spread evenly.
pub(crate) const TOTAL: u64 = 1 << 40;

impl Problems {
    pub(crate) fn even() -> Self {
        Self::Even
    }

    /// Counts the pixels on the fixed machine, path by path.
    pub(crate) fn pixels(quick: bool) -> Self {
        let (film, path_bits) = if quick { (16, 8) } else { (64, 12) };
        let sets = [
            format!("film.width={film}"),
            format!("film.height={film}"),
            format!("sampling.path_bits={path_bits}"),
        ];
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes-yaml/cornell-box.yaml");
        let loaded = front::load(&scene, &sets).unwrap_or_else(|report| panic!("{report}"));
        let options = RenderOptions {
            model: Some(Model::Fixed),
            estimator: Some(Estimator::Exact),
            ..RenderOptions::default()
        };
        let rendered = render(&loaded.valid, &options).unwrap_or_else(|error| panic!("{error}"));
        let list = rendered
            .counts()
            .map(|count| CountingProblem {
                good: count.good.expect("the fixed machine counts ids"),
                total: count.total,
            })
            .collect();
        Self::Pixels { film, list }
    }

    /// Returns its name in files.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Even => "even",
            Self::Pixels { .. } => "pixels",
        }
    }

    pub(crate) fn problem(&self, run: u32, runs: u32) -> CountingProblem {
        match self {
            Self::Even => {
                let fraction = (f64::from(run) + 0.5) / f64::from(runs);
                CountingProblem {
                    good: (fraction * TOTAL as f64) as u64,
                    total: TOTAL,
                }
            }
            Self::Pixels { list, .. } => list[run as usize % list.len()],
        }
    }
}

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Even => write!(f, "Amplitudes spread evenly over [0, 1]"),
            Self::Pixels { film, list } => {
                let fractions = list.iter().map(|p| p.good as f64 / p.total as f64);
                let mut fractions: Vec<f64> = fractions.collect();
                fractions.sort_by(f64::total_cmp);
                let at = |percent: usize| fractions[(fractions.len() - 1) * percent / 100];
                write!(
                    f,
                    "Pixels of the Cornell box, {film} x {film}, amplitudes of {:.4} ({:.4} to \
                     {:.4} for 90 %)",
                    at(50),
                    at(5),
                    at(95)
                )
            }
        }
    }
}
