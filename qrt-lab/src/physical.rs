//! Logical counts that estimators of physical resources take as input: the counts of all that a
//! device runs for a call of the oracle, for a channel of a pixel, for a pixel and for a film.
//!
//! The counts are those of gates. [`lower::tally`] counts an oracle. The gates that counting adds
//! around the oracle (O_0, the controls of phase flips, the phase register's window and inverse
//! Fourier transform) come from [`CountingCircuit`], which emits them gate by gate around a
//! stand-in for the oracle: one phase flip on an index of the same number of qubits.
//!
//! Assumptions:
//!
//! * An estimator with a phase register runs the whole circuit B times, with T - 1 queries each. An
//!   estimator without one runs the planned number of iterates, or else at most (T - 1) B, without
//!   a control. It measures the index at most that number of times, because a shot takes at least
//!   one query. `auto` is counted as if it counted every pixel: the mean-phase circuit has no
//!   comparator, and a table of about 1 % of the oracle. Where parts of a comparator are
//!   counted one by one, qubits of the index are fixed. This saves part of O_0, and the counts ignore
//!   the saving.
//! * All channels of all pixels are counted one after another on the same qubits, except those
//!   whose proven bound is black. The oracle of all pixels is the oracle of one class of pixels,
//!   for example the most expensive.

use qrt_circuit::lower::{self, Cost};
use qrt_circuit::quantum::{
    Conjunction, CountingCircuit, LogicalCounts, PhaseOracle, QuantumError,
};
use qrt_core::oracle::{OracleError, OracleName, Oracles};
use qrt_counting::estimators::{EstimatorError, Settings};
use qrt_scene::Estimator;
use qrt_scene::valid::ValidScene;

/// Reason for which a picture has no logical counts.
#[derive(Debug, thiserror::Error)]
pub enum PhysicalError {
    /// The scene has no circuit.
    #[error("{0}")]
    Oracle(OracleError),
    /// The scene's estimator runs no iterates of G, or always other circuits as well.
    #[error(
        "the estimator `{0}` does not only iterate G, so that nothing is known of what it would run: \
         choose another `counting.estimator`"
    )]
    Estimator(Estimator),
    /// The scene's counting block is out of range.
    #[error(transparent)]
    Counting(#[from] EstimatorError),
    /// There is no counting circuit.
    #[error(transparent)]
    Quantum(#[from] QuantumError),
    /// A count leaves u64.
    #[error(
        "the film takes more gates than 2^64: use a smaller film, or fewer `counting.phase_bits`"
    )]
    TooMany,
}

/// The counts of one computation: once with unitary uncomputation, once with measurements.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// The counts of qrt's own circuits, where gates undo everything.
    pub unitary: LogicalCounts,
    /// The counts if measurements undo the ANDs into clean qubits.
    pub measured: LogicalCounts,
}

/// The counts of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChannelCounts {
    /// One call of O_f.
    pub oracle: Counts,
    /// All that a device runs to estimate the channel in a pixel.
    pub pixel: Counts,
    /// Queries: the planned number, or else the number that the estimator may use at most. 0 for a
    /// channel that is black in every pixel.
    pub queries: u64,
}

/// The counts of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureCounts {
    /// Red, green and blue.
    pub channels: [ChannelCounts; 3],
    /// All channels of a pixel, one after another.
    pub pixel: Counts,
    /// All pixels, one after another.
    pub film: Counts,
    /// Queries of a pixel, all channels together.
    pub queries: u64,
    /// Number of pixels of the film.
    pub pixels: u64,
}

impl PictureCounts {
    /// Counts of a scene's picture under the scene's estimator. The oracles of the class of pixels of
    /// `like` stand for the oracles of every pixel.
    ///
    /// An estimator that stops by itself uses fewer queries than it may. For it, `planned` gives
    /// the queries of a pixel on average, for red, green and blue ([`PlanFigures::channel_queries`]);
    /// they are rounded up. An estimator with a phase register has a fixed number of queries and
    /// ignores `planned`.
    ///
    /// [`PlanFigures::channel_queries`]: qrt_runtime::plan::PlanFigures::channel_queries
    ///
    /// # Errors
    /// If the scene has no circuit, the estimator runs no iterates, or a count exceeds u64.
    pub fn for_scene(
        oracles: &Oracles<'_>,
        like: OracleName,
        planned: Option<[f64; 3]>,
    ) -> Result<Self, PhysicalError> {
        let run = |channel: usize| {
            let planned = planned.map(|queries| queries[channel].ceil() as u64);
            Run::new(oracles, OracleName { channel, ..like })?.counts(planned)
        };
        let channels: [ChannelCounts; 3] = [run(0)?, run(1)?, run(2)?];
        let film = oracles.scene().scene().film;
        let pixels = u64::from(film.width) * u64::from(film.height);
        let all = channels.iter().map(|channel| Some(channel.pixel));
        let pixel = all
            .reduce(|sum, next| sum?.then(next?))
            .flatten()
            .ok_or(PhysicalError::TooMany)?;
        let queries = channels.iter().map(|channel| channel.queries).sum();
        Ok(Self {
            channels,
            pixel,
            film: pixel.times(pixels).ok_or(PhysicalError::TooMany)?,
            queries,
            pixels,
        })
    }
}

impl Counts {
    fn each(self, of: impl Fn(LogicalCounts) -> Option<LogicalCounts>) -> Option<Self> {
        Some(Self {
            unitary: of(self.unitary)?,
            measured: of(self.measured)?,
        })
    }

    /// Pairs `counts` with the counts in which `pairs` pairs of Toffolis are each an AND and a
    /// measurement.
    fn paired(counts: LogicalCounts, pairs: u64) -> Self {
        Self {
            unitary: counts,
            measured: counts.measuring(pairs),
        }
    }

    fn then(self, other: Self) -> Option<Self> {
        Some(Self {
            unitary: self.unitary.then(other.unitary)?,
            measured: self.measured.then(other.measured)?,
        })
    }

    fn times(self, n: u64) -> Option<Self> {
        self.each(|counts| counts.times(n))
    }
}

/// All that a device runs for a channel of a pixel.
struct Run<'a> {
    scene: &'a ValidScene,
    oracle: Counts,
    /// Qubits of the index: path and comparator.
    index: u32,
    black: bool,
}

impl<'a> Run<'a> {
    fn new(oracles: &'a Oracles<'_>, name: OracleName) -> Result<Self, PhysicalError> {
        let oracle = oracles.channel(name.channel, name.class);
        let oracle = oracle.map_err(PhysicalError::Oracle)?;
        let cost: Cost = lower::tally(&oracle.whole(0)).into_iter().sum();
        let counts = LogicalCounts {
            qubits: u64::from(oracle.qubits()),
            toffoli: cost.toffoli,
            ..LogicalCounts::default()
        };
        Ok(Self {
            scene: oracles.scene(),
            oracle: Counts::paired(counts, cost.toffoli - cost.and_measured),
            index: oracle.points.path_bits() + oracle.comparator_bits(),
            black: oracle.channels[0].scale <= 0.0,
        })
    }

    fn counts(&self, planned: Option<u64>) -> Result<ChannelCounts, PhysicalError> {
        let counting = self.scene.scene().counting;
        let estimator = counting.estimator();
        match estimator {
            Estimator::Exact
            | Estimator::MonteCarlo
            | Estimator::Qcoin
            | Estimator::AbramsWilliams
            | Estimator::PhaseMean => return Err(PhysicalError::Estimator(estimator)),
            Estimator::Paper
            | Estimator::PosteriorMean
            | Estimator::Sine
            | Estimator::Qss
            | Estimator::Mlae
            | Estimator::Iqae
            | Estimator::Miqae
            | Estimator::Chebyshev
            | Estimator::RandomDepth
            | Estimator::AdaptiveBayes
            | Estimator::Auto => {}
        }
        let settings = Settings::from_counting(&counting)?;
        let queries = match planned {
            _ if self.black => 0,
            Some(planned) if !estimator.has_register() => planned.min(settings.queries),
            _ => settings.queries,
        };
        let stand_in = PhaseOracle::polynomial(self.index, vec![vec![0]])?;
        let window = estimator.register_window(counting.window);
        let around = CountingCircuit::with(
            &stand_in,
            counting.phase_bits,
            window,
            Conjunction::Toffolis,
        )?;
        let pixel = if queries == 0 {
            Some(Counts::default())
        } else if estimator.has_register() {
            self.with_register(&around, u64::from(counting.repetitions))
        } else {
            self.without_register(&around, queries)
        };
        Ok(ChannelCounts {
            oracle: self.oracle,
            pixel: pixel.ok_or(PhysicalError::TooMany)?,
            queries,
        })
    }

    /// Counts of the circuit of counting, run `repetitions` times.
    fn with_register(&self, around: &CountingCircuit<'_>, repetitions: u64) -> Option<Counts> {
        let begin = LogicalCounts::from_circuit(|mut sink| around.prepare(&mut sink));
        let query = LogicalCounts::from_circuit(|mut sink| around.query(0, &mut sink));
        let end = LogicalCounts::from_circuit(|mut sink| around.inverse_fourier(&mut sink));
        let read = LogicalCounts {
            measurements: around.phase_register().len() as u64,
            ..LogicalCounts::default()
        };
        let ends = begin.then(end)?.then(read)?;
        let queries = self.query(query)?.times(around.queries())?;
        let run = queries.then(Counts::paired(ends, 0))?.times(repetitions)?;
        self.on(around, around.qubits() - around.iterate().qubits(), run)
    }

    /// Counts of `queries` iterates in shots of any length. Each iterate counts a measurement of
    /// the index.
    fn without_register(&self, around: &CountingCircuit<'_>, queries: u64) -> Option<Counts> {
        let query = LogicalCounts::from_circuit(|mut sink| around.iterate().apply(None, &mut sink));
        let query = LogicalCounts {
            measurements: u64::from(self.index),
            ..query
        };
        self.on(around, 0, self.query(query)?.times(queries)?)
    }

    /// Counts of a call of the oracle and of the gates `around` it: Toffolis into O_0's ancillas,
    /// and their inverse.
    fn query(&self, around: LogicalCounts) -> Option<Counts> {
        self.oracle.then(Counts::paired(around, around.toffoli / 2))
    }

    /// Sets the qubits of `run`: those of the oracle, from which O_0 borrows, or of the iterate if these
    /// are more, plus `more`.
    fn on(&self, around: &CountingCircuit<'_>, more: u32, run: Counts) -> Option<Counts> {
        let iterate = u64::from(around.iterate().qubits());
        run.each(|counts| {
            Some(LogicalCounts {
                qubits: self.oracle.unitary.qubits.max(iterate) + u64::from(more),
                ..counts
            })
        })
    }
}
