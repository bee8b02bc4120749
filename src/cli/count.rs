//! `qrt count`: the distribution of the phase register's outcomes, without a scene.

use std::collections::BTreeMap;
use std::io::{self, Write};

use super::args::choice;
use super::failure::Failure;
use clap::Args;
use qrt_counting::estimators::{
    DEFAULT_CONFIDENCE, Device, Estimate, EstimatorError, Noise, Problem, WindowedCounting,
};
use qrt_counting::random::Stream;
use qrt_counting::{CountingError, MAX_REPETITIONS, PhaseDistribution, posterior};
use qrt_scene::Window;
use serde_json::{Value, json};

const WINDOWS: [(Window, &str); 2] = [
    (Window::Rect, "All phases alike: the paper's"),
    (
        Window::Sine,
        "w_j = sqrt(2/(T+1)) sin(pi (j+1)/(T+1)): far smaller tails",
    ),
];

/// Largest number of phase bits for which all outcomes are listed; above it, those near the peak.
const MAX_LISTED_BITS: u32 = 16;
/// Number of outcomes listed on either side of the peak.
const PEAK_REACH: u64 = 16;
/// Largest number of indices for which the posterior is summed index by index.
const MAX_POSTERIOR_IDS: u64 = 1 << 16;
/// Number of most likely values of S that the output shows of a posterior.
const LIKELIEST: usize = 10;

/// The distribution of quantum counting's outcomes, and draws from it
///
/// S of N indices are good. A phase register of T = 2^t phases reads y in 0..=T/2 (y and T - y are
/// one outcome), which estimates theta = asin(sqrt(S/N))/pi by y/T, and S by N sin^2(pi y/T).
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Examples:
  qrt count --good 300 --total 1000 --phase-bits 6
  qrt count --good 300 --total 1000 --phase-bits 20 --window sine --shots 5 --seed 1
  qrt count --good 1 --total 1048576 --phase-bits 16 --outcomes 20,41 --json")]
pub(crate) struct CountArgs {
    /// S, the number of good indices
    #[arg(long, value_name = "S")]
    good: u64,
    /// N, the number of indices
    #[arg(long, value_name = "N")]
    total: u64,
    /// t, of T = 2^t, in 1..=40
    #[arg(long, value_name = "BITS", value_parser = clap::value_parser!(u32).range(1..=40))]
    phase_bits: u32,
    /// The window on the phase register
    #[arg(long, value_parser = choice(WINDOWS, Window::name), default_value = "rect")]
    window: Window,
    /// Only these outcomes; otherwise all of them, or above 16 phase bits those about the peak
    #[arg(long, value_name = "Y,Y,...", value_delimiter = ',')]
    outcomes: Vec<u64>,
    /// Draw B outcomes and estimate S from them; up to N = 65536 also S's posterior
    #[arg(
        long,
        value_name = "B",
        value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_REPETITIONS))
    )]
    shots: Option<u32>,
    /// The same seed draws the same outcomes
    #[arg(long, value_name = "SEED", default_value_t = 0, requires = "shots")]
    seed: u64,
    /// JSON instead of tables
    #[arg(long)]
    json: bool,
}

/// The selection of outcomes that are listed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shown {
    All,
    Asked,
    Peak,
}

struct Answer<'a> {
    args: &'a CountArgs,
    distribution: PhaseDistribution,
    shown: Shown,
    outcomes: Vec<u64>,
    drawn: Option<Drawn>,
}

struct Drawn {
    counts: BTreeMap<u64, u64>,
    estimate: Estimate,
    posterior: Option<Posterior>,
}

/// P(S | outcomes) for a prior that is uniform over 0..=N.
struct Posterior {
    mean: f64,
    deviation: f64,
    likeliest: Vec<(u64, f64)>,
}

/// Prints the result on standard output.
///
/// # Errors
///
/// Counts or outcomes out of range, or an output that cannot be written. A closed pipe is no error.
pub(crate) fn run(args: &CountArgs) -> Result<(), Failure> {
    let answer = Answer::new(args)?;
    let mut out = io::BufWriter::new(io::stdout().lock());
    let written = if args.json {
        answer.json(&mut out)
    } else {
        answer.tables(&mut out)
    };
    match written.and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::Job(format!("cannot write the result: {error}")))
        }
        _ => Ok(()),
    }
}

impl<'a> Answer<'a> {
    fn new(args: &'a CountArgs) -> Result<Self, EstimatorError> {
        let distribution =
            PhaseDistribution::new(args.good, args.total, args.phase_bits, args.window)?;
        let largest = distribution.largest_outcome();
        if let Some(&outcome) = args.outcomes.iter().find(|&&y| y > largest) {
            return Err(CountingError::OutcomeOutOfRange { outcome, largest }.into());
        }
        let (shown, outcomes) = if !args.outcomes.is_empty() {
            (Shown::Asked, args.outcomes.clone())
        } else if args.phase_bits <= MAX_LISTED_BITS {
            (Shown::All, (0..=largest).collect())
        } else {
            let peak = distribution.nearest_outcome();
            let first = peak.saturating_sub(PEAK_REACH);
            (
                Shown::Peak,
                (first..=(peak + PEAK_REACH).min(largest)).collect(),
            )
        };
        let drawn = match args.shots {
            Some(shots) => Some(Drawn::new(args, shots)?),
            None => None,
        };
        Ok(Self {
            args,
            distribution,
            shown,
            outcomes,
            drawn,
        })
    }

    fn phase(&self, y: u64) -> f64 {
        y as f64 / (1_u64 << self.args.phase_bits) as f64
    }

    fn shown_probability(&self) -> f64 {
        self.outcomes
            .iter()
            .map(|&y| self.distribution.probability(y))
            .sum()
    }

    fn json(&self, out: &mut impl Write) -> io::Result<()> {
        let outcomes: Vec<Value> = self
            .outcomes
            .iter()
            .map(|&y| {
                let probability = self.distribution.probability(y);
                json!({ "y": y, "theta": self.phase(y), "probability": probability })
            })
            .collect();
        let shown = match self.shown {
            Shown::All => "all",
            Shown::Asked => "asked",
            Shown::Peak => "peak",
        };
        let mut answer = json!({
            "version": 1,
            "good": self.args.good,
            "total": self.args.total,
            "phase_bits": self.args.phase_bits,
            "window": self.args.window.name(),
            "theta": self.distribution.theta(),
            "shown": shown,
            "outcomes": outcomes,
        });
        if let Some(drawn) = &self.drawn {
            answer["seed"] = json!(self.args.seed);
            answer["draws"] = drawn
                .counts
                .iter()
                .map(|(y, count)| json!({ "y": y, "count": count }))
                .collect();
            let estimate = &drawn.estimate;
            answer["estimate"] = json!({
                "good": estimate.good,
                "amplitude": estimate.amplitude,
                "interval": [estimate.interval.0, estimate.interval.1],
                "confidence": estimate.confidence,
                "queries": estimate.queries,
                "shots": estimate.shots,
                "ln_likelihood": estimate.ln_likelihood,
            });
            if let Some(posterior) = &drawn.posterior {
                let likeliest: Vec<Value> = posterior
                    .likeliest
                    .iter()
                    .map(|(good, p)| json!({ "good": good, "probability": p }))
                    .collect();
                answer["posterior"] = json!({
                    "mean": posterior.mean,
                    "standard_deviation": posterior.deviation,
                    "likeliest": likeliest,
                });
            }
        }
        serde_json::to_writer_pretty(&mut *out, &answer)?;
        writeln!(out)
    }

    fn tables(&self, out: &mut impl Write) -> io::Result<()> {
        let CountArgs {
            good,
            total,
            phase_bits,
            ..
        } = *self.args;
        let window = match self.args.window {
            Window::Rect => "rectangular",
            Window::Sine => "sine",
        };
        writeln!(
            out,
            "S = {good} of N = {total}, T = 2^{phase_bits}, {window} window"
        )?;
        writeln!(out, "theta = {}", self.distribution.theta())?;
        if self.shown == Shown::Peak {
            let outcomes = self.distribution.largest_outcome() + 1;
            let (listed, rest) = (self.outcomes.len(), 1.0 - self.shown_probability());
            writeln!(
                out,
                "the {listed} outcomes about the peak, of {outcomes}; all others together have \
                 probability {rest:.3e} (--outcomes lists any)"
            )?;
        }
        writeln!(out)?;
        let width = self
            .outcomes
            .iter()
            .max()
            .map_or(1, |y| y.to_string().len())
            .max(3);
        writeln!(
            out,
            "{:>width$}  {:<17}  {:<17}  probability",
            "y", "y/T", "S/N"
        )?;
        for &y in &self.outcomes {
            let sine = libm::sin(std::f64::consts::PI * self.phase(y));
            let (phase, amplitude) = (self.phase(y), sine * sine);
            let probability = self.distribution.probability(y);
            writeln!(
                out,
                "{y:>width$}  {phase:<17.15}  {amplitude:<17.15}  {probability:.15e}"
            )?;
        }
        match &self.drawn {
            Some(drawn) => drawn.tables(self.args, out),
            None => Ok(()),
        }
    }
}

impl Drawn {
    fn new(args: &CountArgs, shots: u32) -> Result<Self, EstimatorError> {
        let window = args.window;
        let run = WindowedCounting {
            phase_bits: args.phase_bits,
            repetitions: shots,
            window,
            confidence: DEFAULT_CONFIDENCE,
        };
        let mut stream = Stream::new(args.seed, 0, 0, 0);
        let problem = Problem {
            good: args.good,
            total: args.total,
        };
        let mut device = Device::new(problem, Noise::NONE, &mut stream)?;
        let outcomes = device.phases(args.phase_bits, window, shots)?;
        let mut counts = BTreeMap::new();
        for &y in &outcomes {
            *counts.entry(y).or_insert(0) += 1;
        }
        let posterior = if args.total <= MAX_POSTERIOR_IDS {
            Some(Posterior::new(&posterior(
                &outcomes,
                args.total,
                args.phase_bits,
                window,
            )?))
        } else {
            None
        };
        Ok(Self {
            counts,
            estimate: run.infer(&outcomes, args.total)?,
            posterior,
        })
    }

    fn tables(&self, args: &CountArgs, out: &mut impl Write) -> io::Result<()> {
        writeln!(out)?;
        let width = self
            .counts
            .keys()
            .max()
            .map_or(1, |y| y.to_string().len())
            .max(3);
        writeln!(out, "{:>width$}  drawn (seed {})", "y", args.seed)?;
        for (y, count) in &self.counts {
            writeln!(out, "{y:>width$}  {count}")?;
        }
        let Estimate {
            amplitude,
            interval,
            confidence,
            queries,
            ..
        } = self.estimate;
        writeln!(out)?;
        if let Some(good) = self.estimate.good {
            writeln!(out, "likeliest S   {good}")?;
        }
        writeln!(out, "S/N           {amplitude}")?;
        let (low, high) = interval;
        writeln!(
            out,
            "interval      {low} to {high}, at {:.1} %",
            100.0 * confidence
        )?;
        writeln!(out, "queries       {queries}")?;
        if let Some(posterior) = &self.posterior {
            let (mean, deviation) = (posterior.mean, posterior.deviation);
            writeln!(out, "posterior S   {mean:.6} +- {deviation:.6}")?;
            let width = posterior
                .likeliest
                .iter()
                .map(|(good, _)| good.to_string().len())
                .max();
            let width = width.unwrap_or(1).max(3);
            writeln!(out, "\n{:>width$}  posterior", "S")?;
            for (good, probability) in &posterior.likeliest {
                writeln!(out, "{good:>width$}  {probability:.6e}")?;
            }
        }
        Ok(())
    }
}

impl Posterior {
    fn new(probabilities: &[f64]) -> Self {
        let values = || (0_u64..).zip(probabilities.iter().copied());
        let mean: f64 = values().map(|(good, p)| good as f64 * p).sum();
        let variance: f64 = values()
            .map(|(good, p)| {
                let distance = good as f64 - mean;
                p * distance * distance
            })
            .sum();
        let mut likeliest: Vec<_> = values().filter(|&(_, p)| p > 0.0).collect();
        likeliest.sort_by(|a, b| b.1.total_cmp(&a.1));
        likeliest.truncate(LIKELIEST);
        Self {
            mean,
            deviation: variance.sqrt(),
            likeliest,
        }
    }
}
