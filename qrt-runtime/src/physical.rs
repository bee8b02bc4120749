//! What estimators of physical resources take of a picture: the logical counts of all that a device
//! runs for a call of the oracle, for a channel of a pixel, for a pixel and for a film.
//!
//! They are those of gates. An oracle's are counted by [`lower::tally`]. What counting puts around it
//! (O_0, the controls of phase flips, the phase register's window and inverse Fourier transform) is
//! handed over gate by gate by [`Counting`], around a stand-in for the oracle: one phase flip on an
//! index of as many qubits.
//!
//! What is assumed:
//!
//! * An estimator with a phase register runs the whole circuit B times, T - 1 queries each. One
//!   without runs as many iterates as were planned, or else at most (T - 1) B, without a control, and
//!   measures the index at most as often: a shot takes a query at least. Strata fix qubits of the index, which saves some of O_0
//!   and is not reckoned with.
//! * All channels of all pixels are counted, one after another on the same qubits, but those whose
//!   proven bound is black. The oracle of all pixels is that of one class of pixels, such as the
//!   most expensive.

use crate::estimators::{EstimatorError, Settings};
use qrt_circuit::lower::{self, Cost};
use qrt_circuit::quantum::{Conjunction, Counting, LogicalCounts, PhaseOracle, QuantumError};
use qrt_core::oracle::{Options, Oracle, OracleError};
use qrt_core::scene::Estimator;
use qrt_core::tracer::PixelClass;
use qrt_core::valid::ValidScene;

/// Why a picture has no logical counts.
#[derive(Debug, thiserror::Error)]
pub enum PhysicalError {
    /// The scene has no circuit.
    #[error("{0}")]
    Oracle(OracleError),
    /// The scene's estimator runs no iterates of G.
    #[error(
        "the estimator `{0}` does not iterate G, so that nothing is known of what it would run: \
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

/// The counts of one computation, each kind for itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// As qrt's circuits are: everything is undone by gates.
    pub unitary: LogicalCounts,
    /// ANDs into clean qubits are undone by measurement.
    pub measured: LogicalCounts,
}

/// The counts of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChannelCounts {
    /// One call of O_f.
    pub oracle: Counts,
    /// All that estimates the channel in a pixel.
    pub pixel: Counts,
    /// Queries: as planned, or else as many as may be used; 0 of a channel that is black in every
    /// pixel.
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
    /// How many pixels the film has.
    pub pixels: u64,
}

impl PictureCounts {
    /// The counts of a scene's picture, by the scene's estimator, with the oracles for pixels of `class`
    /// in every pixel.
    ///
    /// Estimators that stop by themselves use fewer queries than they may: `planned` says how many, of
    /// a pixel on average, of red, green and blue ([`Figures::channel_queries`]). They are rounded
    /// up. Those of an estimator with a phase register are fixed, and are not read.
    ///
    /// [`Figures::channel_queries`]: crate::plan::Figures::channel_queries
    ///
    /// # Errors
    /// A scene without a circuit, an estimator that runs no iterates, and counts beyond u64.
    pub fn of(
        scene: &ValidScene,
        class: PixelClass,
        planned: Option<[f64; 3]>,
    ) -> Result<Self, PhysicalError> {
        let run = |channel: usize| {
            let planned = planned.map(|queries| queries[channel].ceil() as u64);
            Run::new(scene, channel, class)?.counts(planned)
        };
        let channels: [ChannelCounts; 3] = [run(0)?, run(1)?, run(2)?];
        let film = scene.scene().film;
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

    /// `counts`, of whose Toffolis so many pairs may be an AND and a measurement.
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

/// What a device runs for a channel of a pixel.
struct Run<'a> {
    scene: &'a ValidScene,
    oracle: Counts,
    /// The index: path and comparator.
    index: u32,
    black: bool,
}

impl<'a> Run<'a> {
    fn new(
        scene: &'a ValidScene,
        channel: usize,
        class: PixelClass,
    ) -> Result<Self, PhysicalError> {
        let oracle = Oracle::new(scene, channel, Options::of_class(class));
        let oracle = oracle.map_err(PhysicalError::Oracle)?;
        let cost: Cost = lower::tally(&oracle.whole(0)).into_iter().sum();
        let counts = LogicalCounts {
            qubits: u64::from(oracle.qubits()),
            toffoli: cost.toffoli,
            ..LogicalCounts::default()
        };
        Ok(Self {
            scene,
            oracle: Counts::paired(counts, cost.toffoli - cost.and_measured),
            index: oracle.points.path_bits() + oracle.comparator_bits(),
            black: oracle.channels[0].scale <= 0.0,
        })
    }

    fn counts(&self, planned: Option<u64>) -> Result<ChannelCounts, PhysicalError> {
        let counting = self.scene.scene().counting;
        let estimator = counting.estimator;
        match estimator {
            Estimator::Exact
            | Estimator::MonteCarlo
            | Estimator::Qcoin
            | Estimator::AbramsWilliams => return Err(PhysicalError::Estimator(estimator)),
            Estimator::Paper
            | Estimator::PosteriorMean
            | Estimator::Sine
            | Estimator::Qss
            | Estimator::Mlae
            | Estimator::Iqae
            | Estimator::Miqae
            | Estimator::Chebyshev
            | Estimator::RandomDepth
            | Estimator::AdaptiveBayes => {}
        }
        let settings = Settings::of(&counting)?;
        let queries = match planned {
            _ if self.black => 0,
            Some(planned) if !estimator.has_register() => planned.min(settings.queries),
            _ => settings.queries,
        };
        let stand_in = PhaseOracle::polynomial(self.index, vec![vec![0]])?;
        let window = estimator.register_window(counting.window);
        let around = Counting::with(
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

    /// The circuit of counting, so many times.
    fn with_register(&self, around: &Counting<'_>, repetitions: u64) -> Option<Counts> {
        let begin = LogicalCounts::of(|mut sink| around.prepare(&mut sink));
        let query = LogicalCounts::of(|mut sink| around.query(0, &mut sink));
        let end = LogicalCounts::of(|mut sink| around.inverse_fourier(&mut sink));
        let read = LogicalCounts {
            measurements: around.phase_register().len() as u64,
            ..LogicalCounts::default()
        };
        let ends = begin.then(end)?.then(read)?;
        let queries = self.query(query)?.times(around.queries())?;
        let run = queries.then(Counts::paired(ends, 0))?.times(repetitions)?;
        self.on(around, around.qubits() - around.iterate().qubits(), run)
    }

    /// So many iterates in shots of any length; after each the index is measured.
    fn without_register(&self, around: &Counting<'_>, queries: u64) -> Option<Counts> {
        let query = LogicalCounts::of(|mut sink| around.iterate().apply(None, &mut sink));
        let query = LogicalCounts {
            measurements: u64::from(self.index),
            ..query
        };
        self.on(around, 0, self.query(query)?.times(queries)?)
    }

    /// A call of the oracle, and what is `around` it: Toffolis into O_0's ancillas, and their inverse.
    fn query(&self, around: LogicalCounts) -> Option<Counts> {
        self.oracle.then(Counts::paired(around, around.toffoli / 2))
    }

    /// With the qubits of the oracle, of which O_0 borrows, and so many `more`.
    fn on(&self, around: &Counting<'_>, more: u32, run: Counts) -> Option<Counts> {
        let iterate = u64::from(around.iterate().qubits());
        run.each(|counts| {
            Some(LogicalCounts {
                qubits: self.oracle.unitary.qubits.max(iterate) + u64::from(more),
                ..counts
            })
        })
    }
}
