//! Rounds of a search with an unknown number of marked states. After the last round it gives up.

/// The growth factor, from round to round, of the range from which the number of iterations is
/// drawn.
const GROWTH: f64 = 1.2;

/// The smallest failure probability that [`Rounds::new`] accepts.
pub const LEAST_FAILURE: f64 = 1e-15;

/// An error of choosing rounds.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RoundsError {
    /// The failure probability is outside [`LEAST_FAILURE`]` .. 1`.
    #[error(
        "a search cannot fail with probability {0}: give one from {LEAST_FAILURE} on and below 1"
    )]
    Failure(f64),
}

/// The probability that k = `iterations` iterations end in a marked state, if `marked` of `states`
/// states are marked: `sin^2((2k + 1) theta)`.
pub fn marked_probability(iterations: u64, marked: usize, states: usize) -> f64 {
    let theta = angle(marked, states);
    let sine = libm::sin((2.0 * iterations as f64 + 1.0) * theta);
    sine * sine
}

/// The mean of [`marked_probability`] over `0 .. count` iterations, all equally likely:
/// `1/2 - sin(4 count theta) / (4 count sin(2 theta))` (Boyer et al. 1998, Lemma 2).
pub fn success(count: u64, marked: usize, states: usize) -> f64 {
    if marked == 0 || marked >= states {
        // With no state or all states marked, the probability is the same after any number of
        // iterations.
        return f64::from(u8::from(marked > 0));
    }
    let theta = angle(marked, states);
    let count = count as f64;
    0.5 - libm::sin(4.0 * count * theta) / (4.0 * count * libm::sin(2.0 * theta))
}

fn angle(marked: usize, states: usize) -> f64 {
    libm::asin(libm::sqrt(marked as f64 / states as f64))
}

/// The rounds of a search. If all of them fail, the search concludes that no state is marked.
///
/// Round r iterates k times, with k drawn from `0 .. c_r`, `c_r = ceil(m_r)`, `m_0 = 1` and
/// `m_{r+1} = min(6/5 m_r, sqrt(N))` (Boyer et al. 1998). So the probability that all rounds miss
/// all M marked states is exactly
///
/// ```text
/// miss(M) = prod_r (1 - success(c_r, M, N)).
/// ```
///
/// A search for the minimum of P numbers fails if it gives up at any number but the minimum. The
/// number of rank M + 1 has M nearer ones. The search reaches it with probability at most
/// `1 / (M + 1)`, because each of the remaining numbers is equally likely to be found; only the
/// number where the search starts is reached for certain. So for every guess and every ray, the
/// failure probability is at most
///
/// ```text
/// failure = max_M miss(M) + sum_{M=1}^{P-1} miss(M) / (M + 1),
/// ```
///
/// and the number of rounds is the smallest for which this is at most the requested failure
/// probability. This termination criterion is that of Santos (2024), with its constant derived.
#[derive(Clone, Debug, PartialEq)]
pub struct Rounds {
    pub(super) states: usize,
    pub(super) counts: Vec<u64>,
    pub(super) failure: f64,
}

impl Rounds {
    /// Chooses the smallest number of rounds with which the minimum of at most `faces` numbers
    /// among `states` is missed with a probability of at most `failure`.
    ///
    /// # Errors
    /// If `failure` is not in [`LEAST_FAILURE`]` .. 1`.
    pub fn new(states: usize, faces: usize, failure: f64) -> Result<Self, RoundsError> {
        if !(LEAST_FAILURE..1.0).contains(&failure) {
            return Err(RoundsError::Failure(failure));
        }
        let root = libm::sqrt(states as f64);
        let mut missed = vec![1.0; faces];
        let mut rounds = Self {
            states,
            counts: Vec::new(),
            failure: 1.0,
        };
        let mut most: f64 = 1.0;
        while rounds.failure > failure || rounds.counts.is_empty() {
            let count = most.ceil() as u64;
            rounds.counts.push(count);
            most = (GROWTH * most).min(root);
            let (mut worst, mut later) = (0.0_f64, 0.0);
            for (place, missed) in missed.iter_mut().enumerate() {
                let marked = place + 1;
                *missed *= (1.0 - success(count, marked, states)).max(0.0);
                worst = worst.max(*missed);
                if marked < faces {
                    later += *missed / (marked as f64 + 1.0);
                }
            }
            rounds.failure = worst + later;
        }
        Ok(rounds)
    }

    /// N, the number of states that are searched.
    pub fn states(&self) -> usize {
        self.states
    }

    /// Returns `c_r` for each round: iterations are drawn from `0 .. c_r`.
    pub fn counts(&self) -> &[u64] {
        &self.counts
    }

    /// Returns the bound on the probability that the minimum is missed.
    pub fn failure(&self) -> f64 {
        self.failure
    }

    /// The probability that all rounds miss all of `marked` states.
    pub fn miss(&self, marked: usize) -> f64 {
        let counts = self.counts.iter();
        counts.fold(1.0, |missed, &count| {
            missed * (1.0 - success(count, marked, self.states))
        })
    }

    /// The mean number of queries until a search without any marked state gives up.
    pub fn fruitless(&self) -> f64 {
        let counts = self.counts.iter();
        // The mean of max(k, 1), the queries of a round, over k below c.
        let mean = |count: u64| (count as f64 - 1.0) / 2.0 + 1.0 / count as f64;
        counts.map(|&count| mean(count)).sum()
    }
}
