//! Quantum search: the nearest of the faces that a ray meets, in about the square root of their
//! number of queries.
//!
//! Of the `N = 2^m` basis states of a face's number, M are marked by the oracle of nearest hits
//! ([`crate::machines::NearestMachine`]): those that the ray meets nearer than the nearest so far.
//! From the uniform superposition, k iterations of Grover's iterate make the measured number a
//! marked one with probability
//!
//! ```text
//! sin^2((2k + 1) theta),      sin theta = sqrt(M / N),
//! ```
//!
//! each marked one as likely as another; so do the unmarked ones share the rest, for the amplitudes
//! never leave the plane of the two uniform superpositions. M is unknown, and so is the best k: it
//! is drawn anew for each round ([`Rounds`]; Boyer, Brassard, Hoyer & Tapp, *Tight bounds on
//! quantum searching*, 1998). What is measured becomes the nearest so far, and the search begins
//! again until it finds nothing ([`Search`]; Durr & Hoyer, *A quantum algorithm for finding the
//! minimum*, 1996). It ends with a stated probability of having missed something.
//!
//! Here, M and the marked numbers are what the circuit says of every basis state, and the
//! measurements are drawn from that distribution. The search learns what it measures, and nothing
//! else.
//!
//! # Queries
//!
//! A query is one application of the oracle: compute, flip, uncompute. A round of k iterations is k
//! queries; one without an iteration counts as one, for whether what was measured is marked must be
//! asked of something. After an iteration that answer is not counted, as for the estimators: one
//! more evaluation a round, classical, would change no exponent. A first guess is asked about once:
//! one query.
//!
//! ```
//! use qrt_runtime::random::Stream;
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
//!     search.run(&rounds, &marks, &numbers);
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
