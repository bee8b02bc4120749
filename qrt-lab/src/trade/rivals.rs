//! Compares counting with two classical rivals: random paths, and the same net run classically.
//!
//! Both rivals sample lamps.

use super::bench::{Bench, picked};
use super::error::TradeError;
use super::figure::{Figure, series};
use super::setting::{FINE, Setting, Sweep};
use super::styles::free;
use super::sweep::most_paths;
use super::table::{COUNTING, Row, TOTAL};
use super::{Band, Trade, pareto};
use qrt_core::oracle::CallCost;
use qrt_drawing::{Drawn, Fit, Plot, PlotAxis};
use qrt_runtime::path_machines::Real;
use qrt_runtime::sample::{self, Means, SampleError, Sum};
use qrt_runtime::workers::Workers;
use qrt_scene::{Estimator, Lights, Sampling, Sequence};
use qrt_tracer::{PixelClass, PixelClasses};
use rayon::prelude::*;
use std::time::Instant;

/// The rivals and their names.
const RIVALS: [(Sweep, &str); 2] = [
    (Sweep::RandomPaths, "random paths"),
    (Sweep::ClassicalNet, "the net, classically"),
];

/// The page's text about the rivals.
pub(super) const ABOUT: &str = "Counting estimates a mean over paths that a classical renderer can take as well. Random paths \
     are the plain path tracer: their error falls as one over the square root of their number. \
     Averaging all paths of a smaller net with a random shift is quasi-Monte Carlo, and falls \
     faster. Counting falls as one over the queries, which is called Heisenberg scaling. Both rivals \
     sample lamps: by next-event estimation, or by multiple importance sampling where a connection \
     might weigh more than a ray. A path counts once, for it brings all three channels; counting \
     asks for each by itself, and a query traces its path twice, to compute and to undo. Counting's \
     error is that of counting alone, for more paths cost its circuit a qubit each. Compared are \
     pixels that see no lamp, if there are any: elsewhere its edge would be all that is measured. How \
     far a random path is off is measured, and the rest is the law of chance. Mitsuba 3 is not \
     asked here: `cargo bench --bench equal_error` compares with it.";

/// The sampling of rivals and of the reference.
///
/// It is the scene's own if that samples lamps. Otherwise it has, in addition, a point on a lamp
/// for each ray that leaves a surface.
pub(super) fn lit(sampling: &Sampling) -> Sampling {
    let mut lit = sampling.clone();
    if (0..sampling.depths.len()).any(|depth| sampling.light(depth).is_some()) {
        return lit;
    }
    lit.lights = Lights::Auto;
    for depth in lit.depths.iter_mut().skip(1) {
        depth.light = [FINE; 2].into();
    }
    lit
}

/// Number of random paths of a pixel that measure the error of one path.
const RANDOM: u64 = 1 << 13;
/// Number of nets of one size that are tried, if the largest net has room for them.
const NETS: u64 = 16;

impl Bench<'_> {
    /// Indices of the pixels that a setting's errors are about.
    ///
    /// Beside rivals these are the pixels that see no lamp, unless all of them are black. In a
    /// pixel that sees a lamp, the lamp's edge would be the whole error.
    pub(super) fn kept(&mut self, setting: Setting) -> Result<Vec<usize>, TradeError> {
        let all = 0..self.pixels.len();
        if setting.sweep.leaves_lamps_out() {
            let classes = PixelClasses::new(&self.lit_net(setting.depths, 0)?);
            let dim = |&at: &usize| classes.class(self.pixels[at]) == PixelClass::MeetsNoLamp;
            let kept: Vec<usize> = all.clone().filter(dim).collect();
            if sample::radiance(&picked(self.reference(setting.depths)?, &kept)) > 0.0 {
                return Ok(kept);
            }
        }
        Ok(all.collect())
    }

    /// Measures a rival: the classical mean of `2^path_bits` paths.
    pub(super) fn rival(&mut self, setting: Setting) -> Result<Row, TradeError> {
        let kept = self.kept(setting)?;
        let truth = picked(self.reference(setting.depths)?, &kept);
        let pixels = picked(&self.pixels, &kept);
        let mean = sample::radiance(&truth);
        let start = Instant::now();
        let paths = 1 << setting.path_bits;
        let (squares, traced) = if setting.sweep == Sweep::RandomPaths {
            // The errors of random paths are independent, so their variances add up.
            let scene = self.lit_net(setting.depths, 0)?;
            let real = Real::new(&scene, self.seed)?.monte_carlo(RANDOM);
            let squares = squares_of(&real, &pixels, &truth, 1, &self.workers)?;
            let by_path = squares.into_iter().map(|s| s / paths as f64).collect();
            (by_path, RANDOM)
        } else {
            let most =
                most_paths(&Setting::from_parameters(&self.parameters)).max(setting.path_bits);
            let bits = most.min(setting.path_bits + NETS.ilog2());
            let real = Real::new(&self.lit_net(setting.depths, bits)?, self.seed)?;
            let squares = squares_of(&real, &pixels, &truth, paths, &self.workers)?;
            (squares, 1 << bits)
        };
        let seconds = start.elapsed().as_secs_f64() / pixels.len().max(1) as f64;
        let relative: Vec<f64> = squares.iter().map(|s| s / (mean * mean)).collect();
        let off = Band::of_squares(&relative);
        let none = Band::default();
        let depth = self.depth_error(setting.depths, mean)?;
        Ok(Row {
            setting,
            queries: paths as f64,
            cost: CallCost {
                toffoli: 0,
                qubits: 0,
            },
            mean,
            errors: [off, none, none, none, depth, off],
            seconds: seconds * paths as f64 / traced as f64,
        })
    }
}

/// For each pixel, the mean square error over channels of means over `paths` paths at a time.
fn squares_of(
    real: &Real,
    pixels: &[[u32; 2]],
    truth: &Means,
    paths: u64,
    workers: &Workers<'_>,
) -> Result<Vec<f64>, TradeError> {
    let runs = real.paths() / paths;
    let pixel = |(pixel, truth): (&[u32; 2], &[f64; 3])| {
        let (mut squares, mut sums) = (0.0, [Sum::default(); 3]);
        let mut left = paths;
        real.trace(&[*pixel], |block| {
            let mut at = 0;
            let length = block.colours[0].len();
            while at < length {
                let end = length.min(at.saturating_add(left as usize));
                for (sum, colours) in sums.iter_mut().zip(block.colours) {
                    sum.add(&colours[at..end]);
                }
                left -= (end - at) as u64;
                at = end;
                if left == 0 {
                    let means = sums.iter().map(|sum| sum.value() / paths as f64);
                    let off = means.zip(truth).map(|(mean, truth)| (mean - truth).powi(2));
                    squares += off.sum::<f64>() / 3.0;
                    (sums, left) = ([Sum::default(); 3], paths);
                }
            }
        });
        if workers.cancelled() {
            let pixels = pixels.len() as u64;
            return Err(SampleError::Interrupted { pixels }.into());
        }
        Ok(squares / runs as f64)
    };
    pixels.par_iter().zip(truth).map(pixel).collect()
}

/// A price and the error at that price.
type Point = (f64, f64);

/// The comparison of counting with a rival, at errors that both reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Verdict {
    /// Counting needs less, below this error.
    Wins {
        below: f64,
        /// The smallest error that both reach, and the factor by which counting needs fewer queries
        /// there.
        least: f64,
        fewer: f64,
    },
    /// The rival needs less, at least at the smallest error that both reach.
    Loses {
        least: f64,
        /// The factor by which counting needs more queries there.
        more: f64,
    },
    /// There is no error that both reach.
    Apart,
}

/// The price of `error`, interpolated between the points of a front on logarithmic axes.
fn price(front: &[Point], error: f64) -> Option<f64> {
    let at = front.iter().position(|point| point.1 <= error)?;
    let (p, e) = front[at];
    if e == error {
        return Some(p);
    }
    let (q, f) = front[at.checked_sub(1)?];
    let part = libm::log(f / error) / libm::log(f / e);
    Some(q * libm::pow(p / q, part))
}

/// Compares the prices of counting and of a rival, from their smallest common error upwards.
pub(super) fn verdict(counting: &[Point], rival: &[Point]) -> Verdict {
    let fronts = [counting, rival].map(|points| {
        let best = pareto(points).into_iter().map(|at| points[at]);
        best.filter(|point| point.0 > 0.0 && point.1 > 0.0)
            .collect::<Vec<_>>()
    });
    let mut errors: Vec<f64> = fronts.iter().flatten().map(|point| point.1).collect();
    errors.sort_by(f64::total_cmp);
    let ratio = |error: f64| Some((error, price(&fronts[1], error)? / price(&fronts[0], error)?));
    let ratios: Vec<Point> = errors.into_iter().filter_map(ratio).collect();
    let Some(&(least, fewer)) = ratios.first() else {
        return Verdict::Apart;
    };
    if fewer <= 1.0 {
        let more = 1.0 / fewer;
        return Verdict::Loses { least, more };
    }
    let below = match ratios.iter().position(|(_, ratio)| *ratio <= 1.0) {
        Some(at) => {
            let ((e, r), (f, s)) = (ratios[at - 1], ratios[at]);
            e * libm::pow(f / e, libm::log(r) / libm::log(r / s))
        }
        None => ratios.last().map_or(least, |last| last.0),
    };
    Verdict::Wins {
        below,
        least,
        fewer,
    }
}

fn sentence(name: &str, verdict: Verdict) -> String {
    match verdict {
        Verdict::Wins {
            below,
            least,
            fewer,
        } => format!(
            "against {name} counting wins below an error of {}: {fewer:.1} times fewer queries than \
             paths at {}",
            percent(below),
            percent(least)
        ),
        Verdict::Loses { least, more } => format!(
            "against {name} counting does not win: {more:.1} times as many queries as paths at {}, \
             the least error of both",
            percent(least)
        ),
        Verdict::Apart => format!("against {name}: no error was reached by both"),
    }
}

fn percent(error: f64) -> String {
    format!("{:.3} %", 100.0 * error)
}

/// The slope of a rival's error over its paths, on logarithmic axes.
fn slope(points: &[Point]) -> Option<f64> {
    let logarithms = points
        .iter()
        .map(|(n, e)| (libm::log10(*n), libm::log10(*e)));
    Some(Fit::from_points(logarithms.filter(|(_, e)| e.is_finite()))?.slope)
}

/// One line for each rival: its comparison with counting.
pub(super) fn sentences(trade: &Trade) -> Vec<String> {
    let points = |rows: &mut dyn Iterator<Item = &Row>, error: usize| -> Vec<Point> {
        rows.map(|row| (row.queries, row.errors[error].value))
            .collect()
    };
    let ours = points(&mut trade.rows_of(Sweep::BesideRivals), COUNTING);
    let line = |(sweep, name): (Sweep, &str)| {
        let theirs = points(&mut trade.rows_of(sweep), TOTAL);
        let slope = slope(&theirs).map_or(String::new(), |slope| format!(" (slope {slope:.2})"));
        sentence(&format!("{name}{slope}"), verdict(&ours, &theirs))
    };
    RIVALS.map(line).to_vec()
}

/// The plot of counting and both rivals: errors over queries or paths.
pub(super) fn figure(trade: &Trade) -> Figure {
    let mut ours = trade.rows_of(Sweep::BesideRivals).peekable();
    let name = ours.peek().map(|row| row.setting.estimator);
    let name = name.map_or("counting", Estimator::name);
    let price = |row: &Row| row.queries;
    let mut ours = series(name, ours, price, COUNTING, Drawn::Fit);
    let rivals = RIVALS.map(|(sweep, name)| {
        // The net's own name: the name in `RIVALS` is part of sentences, and too long for a legend.
        let net = Sequence::DigitalNet.name();
        let name = if sweep == Sweep::ClassicalNet {
            net
        } else {
            name
        };
        series(name, trade.rows_of(sweep), price, TOTAL, Drawn::Fit)
    });
    // `monte-carlo` has the style of random paths, but is another series.
    ours.style = ours.style.map(|style| free(style, &rivals));
    let mut all = vec![ours];
    all.extend(rivals);
    Figure {
        name: "rivals",
        plot: Plot {
            title: "Counting and its rivals".to_owned(),
            x: PlotAxis::log("queries, or paths, of a pixel"),
            y: PlotAxis::log("RMSE / mean radiance"),
            series: all,
        },
        says: "The queries of counting (all channels) and the paths of classical renderers that \
               sample lamps (each brings all channels), by error, on pixels that see no lamp.",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(scale: f64, slope: f64) -> Vec<Point> {
        let power = |k: i32| libm::exp2(f64::from(k));
        (0..=16)
            .map(|k| (power(k), scale * libm::pow(power(k), slope)))
            .collect()
    }

    /// Checks that counting with an error of c/Q wins against random paths, sigma/sqrt(n), below
    /// sigma^2/c.
    #[test]
    fn the_verdict_follows_the_curves() {
        let counting = law(30.0, -1.0);
        let found = verdict(&counting, &law(1.0, -0.5));
        let Verdict::Wins {
            below,
            least,
            fewer,
        } = found
        else {
            panic!("{found:?}");
        };
        assert!((below * 30.0 - 1.0).abs() < 1e-9, "{below}");
        assert!((least * 256.0 - 1.0).abs() < 1e-9, "{least}");
        // 2^16 paths against 30 x 256 queries.
        assert!((fewer * 30.0 / 256.0 - 1.0).abs() < 1e-9, "{fewer}");
        let said = sentence("random paths", found);
        assert!(said.contains("wins below an error of 3.333 %"), "{said}");
        assert!(said.contains("8.5 times fewer"), "{said}");

        let lost = verdict(&counting, &law(1.0, -1.0));
        let said = sentence("the net", lost);
        assert!(said.contains("does not win: 30.0 times as many"), "{said}");

        // If counting is ahead at all errors, it wins below the largest.
        let ahead = verdict(&law(0.1, -1.0), &law(1.0, -0.5));
        assert!(matches!(ahead, Verdict::Wins { below, .. } if (below - 0.1).abs() < 1e-9));
        let apart = verdict(&[(1.0, 2.0)], &[(1.0, 1.0)]);
        assert_eq!(apart, Verdict::Apart);
        assert_eq!(verdict(&[], &law(1.0, -0.5)), Verdict::Apart);
    }
}
