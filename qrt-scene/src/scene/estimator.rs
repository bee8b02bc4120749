//! Estimators by name, and the windows of their phase registers.

use super::record::keyword;
use super::{Window, shape};

keyword! {
    /// The estimator of the amplitude.
    pub enum Estimator = "an estimator";
    /// The amplitude itself.
    Exact = "exact";
    /// Classical sampling of paths.
    MonteCarlo = "monte-carlo";
    /// The paper's: repetitions of counting, maximum likelihood over S.
    Paper = "paper";
    /// The posterior mean of repeated counting, by default with the sine window.
    PosteriorMean = "posterior-mean";
    /// Counting with a sine window.
    Sine = "sine";
    /// Adaptive Bayesian estimation.
    AdaptiveBayes = "adaptive-bayes";
    /// The mean as a phase, in units of the colours' standard deviation.
    PhaseMean = "phase-mean";
    /// `adaptive-bayes` or `phase-mean`, whichever is expected to have less error.
    Auto = "auto";
    /// Random depths.
    RandomDepth = "random-depth";
    /// Maximum likelihood amplitude estimation.
    Mlae = "mlae";
    /// Iterative amplitude estimation.
    Iqae = "iqae";
    /// Modified iterative amplitude estimation.
    Miqae = "miqae";
    /// Chebyshev amplitude estimation.
    Chebyshev = "chebyshev";
    /// Quantum supersampling.
    Qss = "qss";
    /// Quantum coin.
    Qcoin = "qcoin";
    /// Abrams and Williams.
    AbramsWilliams = "abrams-williams";
}

impl Estimator {
    /// True if the estimator can count the strata of the comparator one by one. This requires that
    /// after every shot it knows the accuracy of each stratum, and can continue with any of them.
    pub const fn counts_strata(self) -> bool {
        match self {
            Self::AdaptiveBayes | Self::Auto | Self::RandomDepth => true,
            Self::Exact
            | Self::PhaseMean
            | Self::MonteCarlo
            | Self::Paper
            | Self::PosteriorMean
            | Self::Sine
            | Self::Qss
            | Self::Mlae
            | Self::Iqae
            | Self::Miqae
            | Self::Chebyshev
            | Self::Qcoin
            | Self::AbramsWilliams => false,
        }
    }

    /// True if the estimator may run the mean-phase circuit, which looks the phase of a path's level
    /// up and therefore takes a comparator of few bits.
    pub const fn reads_levels(self) -> bool {
        matches!(self, Self::PhaseMean | Self::Auto)
    }

    /// True if the estimator may read the colours of the paths that it measures: to count strata one by
    /// one, or to run the mean-phase circuit.
    pub const fn reads_colours(self) -> bool {
        self.counts_strata() || self.reads_levels()
    }

    /// True if the estimator reads a phase register: it repeatedly runs the circuit of quantum
    /// counting.
    pub const fn has_register(self) -> bool {
        match self {
            Self::Paper | Self::PosteriorMean | Self::Sine | Self::Qss => true,
            Self::Exact
            | Self::MonteCarlo
            | Self::Mlae
            | Self::Iqae
            | Self::Miqae
            | Self::Chebyshev
            | Self::RandomDepth
            | Self::AdaptiveBayes
            | Self::PhaseMean
            | Self::Auto
            | Self::Qcoin
            | Self::AbramsWilliams => false,
        }
    }

    /// True if the estimator can stop after any shot, by what it knows so far. `exact` makes no
    /// shots.
    pub const fn stops_itself(self) -> bool {
        !self.has_register() && !matches!(self, Self::Exact)
    }

    /// Returns the window in which the phase register is prepared. `paper`, `qss` and `sine` have a
    /// window of their own; all others use `asked`, the scene's `counting.window`.
    pub fn register_window(self, asked: Window) -> Window {
        match self {
            Self::Paper | Self::Qss => Window::Rect,
            Self::Sine => Window::Sine,
            _ => asked,
        }
    }
}

impl shape::Keyword for Window {
    const NOUN: &'static str = "a window";
    const NAMES: &'static [&'static str] = &["rect", "sine"];
    const DOCS: &'static [&'static str] = &[
        " Equal amplitudes, as in the paper.",
        " Amplitudes w_j proportional to sin(pi (j + 1) / (T + 1)).",
    ];
    const VALUES: &'static [Self] = &[Self::Rect, Self::Sine];
}
