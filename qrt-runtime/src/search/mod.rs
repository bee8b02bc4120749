//! Quantum search for the nearest of the faces that a ray meets, with about as few queries as the
//! square root of the number of faces.
//!
//! Of the `N = 2^m` basis states of a face's number, the oracle of nearest hits
//! ([`crate::path_machines::NearestMachine`]) marks M: the faces that the ray meets nearer than the
//! nearest so far. After k iterations of Grover's iterate from the uniform superposition, the
//! measured number is a marked one with probability
//!
//! ```text
//! sin^2((2k + 1) theta),      sin theta = sqrt(M / N),
//! ```
//!
//! and each marked number is equally likely. The unmarked ones share the rest equally, because the
//! amplitudes stay in the plane of the two uniform superpositions. M is unknown, and so is the best
//! k; each round draws k anew ([`Rounds`]; Boyer, Brassard, Hoyer & Tapp, *Tight bounds on quantum
//! searching*, 1998). The measured face becomes the nearest so far, and the search begins again
//! until it finds nothing ([`Search`]; Durr & Hoyer, *A quantum algorithm for finding the minimum*,
//! 1996). The probability that the search misses the nearest face has a stated bound.
//!
//! In this simulation, the circuit is run on every basis state to find M and the marked numbers,
//! and the measurements are drawn from the resulting distribution. The search gets only the
//! measured numbers.
//!
//! # Queries
//!
//! A query is one application of the oracle: compute, flip, uncompute. A round of k iterations is k
//! queries. A round without an iteration counts as one query, because the measured number must be
//! checked for its mark. After an iteration this check is not counted, as for the estimators: one
//! more classical evaluation for each round would change no exponent. The check of a first guess
//! counts as one query.
//!
//! ```
//! use qrt_counting::random::Stream;
//! use qrt_runtime::search::{Rounds, Search};
//!
//! // The least of 1,000 numbers. What an oracle marks is what is below the least so far.
//! let numbers: Vec<i64> = (0..1000).map(|n| (617 * n + 300) % 1009).collect();
//! let rounds = Rounds::new(1024, 1000, 1e-6)?;
//! let mut search = Search::new(Stream::new(1, 0, 0, 0));
//! while !search.is_over() {
//!     let best = search.nearest();
//!     let below = |&number: &i64| best.is_none_or(|best| number < best.distance);
//!     let mut marks: Vec<bool> = numbers.iter().map(below).collect();
//!     marks.resize(1024, false);
//!     search.run_rounds(&rounds, &marks, &numbers);
//! }
//! let least = search.nearest().map(|nearest| nearest.distance);
//! assert_eq!(least, numbers.iter().copied().min());
//! assert!(search.queries() < 1000);
//! # Ok::<(), qrt_runtime::search::RoundsError>(())
//! ```

mod minimum;
mod primary_hits;
mod rounds;
#[cfg(test)]
mod tests;

pub use minimum::Search;
pub use primary_hits::{FoundHits, Guess, Method};
pub use rounds::{LEAST_FAILURE, Rounds, RoundsError, marked_probability, success};
