//! `qrt count`: the distribution of the phase register's outcomes, without a scene.

use std::io::{self, Write};

use super::args::choice;
use super::failure::Failure;
use clap::Args;
use qrt_counting::MAX_REPETITIONS;
use qrt_counting::estimators::Estimate;
use qrt_lab::count::{CountFigures, CountOptions, DrawnOutcomes, Listed};
use qrt_lab::json;
use qrt_scene::Window;

pub(super) const WINDOWS: [(Window, &str); 2] = [
    (Window::Rect, "All phases alike: the paper's"),
    (
        Window::Sine,
        "w_j = sqrt(2/(T+1)) sin(pi (j+1)/(T+1)): far smaller tails",
    ),
];

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

impl CountArgs {
    fn options(&self) -> CountOptions {
        CountOptions {
            good: self.good,
            total: self.total,
            phase_bits: self.phase_bits,
            window: self.window,
            outcomes: self.outcomes.clone(),
            shots: self.shots,
            seed: self.seed,
        }
    }
}

/// Prints the result on standard output.
///
/// # Errors
///
/// Counts or outcomes out of range, or an output that cannot be written. A closed pipe is no error.
pub(crate) fn run(args: &CountArgs) -> Result<(), Failure> {
    let count = CountFigures::new(args.options())?;
    let mut out = io::BufWriter::new(io::stdout().lock());
    let written = if args.json {
        writeln!(out, "{:#}", json::count(&count))
    } else {
        tables(&count, &mut out)
    };
    match written.and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::Job(format!("cannot write the result: {error}")))
        }
        _ => Ok(()),
    }
}

fn tables(count: &CountFigures, out: &mut impl Write) -> io::Result<()> {
    let CountOptions {
        good,
        total,
        phase_bits,
        ..
    } = count.options;
    let window = match count.options.window {
        Window::Rect => "rectangular",
        Window::Sine => "sine",
    };
    writeln!(
        out,
        "S = {good} of N = {total}, T = 2^{phase_bits}, {window} window"
    )?;
    writeln!(out, "theta = {}", count.distribution.theta())?;
    if count.listed == Listed::Peak {
        let outcomes = count.distribution.largest_outcome() + 1;
        let (listed, rest) = (count.outcomes.len(), 1.0 - count.listed_probability());
        writeln!(
            out,
            "the {listed} outcomes about the peak, of {outcomes}; all others together have \
             probability {rest:.3e} (--outcomes lists any)"
        )?;
    }
    writeln!(out)?;
    let width = count
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
    for &y in &count.outcomes {
        let sine = libm::sin(std::f64::consts::PI * count.phase(y));
        let (phase, amplitude) = (count.phase(y), sine * sine);
        let probability = count.distribution.probability(y);
        writeln!(
            out,
            "{y:>width$}  {phase:<17.15}  {amplitude:<17.15}  {probability:.15e}"
        )?;
    }
    match &count.drawn {
        Some(drawn) => drawn_tables(drawn, count.options.seed, out),
        None => Ok(()),
    }
}

fn drawn_tables(drawn: &DrawnOutcomes, seed: u64, out: &mut impl Write) -> io::Result<()> {
    writeln!(out)?;
    let width = drawn
        .counts
        .keys()
        .max()
        .map_or(1, |y| y.to_string().len())
        .max(3);
    writeln!(out, "{:>width$}  drawn (seed {})", "y", seed)?;
    for (y, count) in &drawn.counts {
        writeln!(out, "{y:>width$}  {count}")?;
    }
    let Estimate {
        amplitude,
        interval,
        confidence,
        queries,
        ..
    } = drawn.estimate;
    writeln!(out)?;
    if let Some(good) = drawn.estimate.good {
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
    if let Some(posterior) = &drawn.posterior {
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
