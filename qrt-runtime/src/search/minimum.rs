//! Finds the minimum by repeated searches for a nearer face than the nearest so far.

use super::rounds::{Rounds, marked_probability};
use crate::path_machines::Candidate;
use qrt_counting::random::Stream;

/// A search for the nearest face of one ray.
#[derive(Clone, Debug)]
pub struct Search {
    stream: Stream,
    best: Option<Candidate>,
    queries: u64,
    over: bool,
}

impl Search {
    /// Creates a search without a known face. It draws from `stream`.
    pub fn new(stream: Stream) -> Self {
        Self {
            stream,
            best: None,
            queries: 0,
            over: false,
        }
    }

    /// Records the oracle's answer for a guessed face: `meets` is true if the ray meets it. Costs
    /// one query.
    pub(crate) fn guess(&mut self, meets: bool, guess: Candidate) {
        self.queries += 1;
        if meets {
            self.best = Some(guess);
        }
    }

    /// Runs the rounds of one search for a marked state. They end when a marked state is measured;
    /// if all rounds fail, the search is over. `marks` and `distances` are the oracle's for
    /// [`Search::nearest`].
    pub fn run_rounds(&mut self, rounds: &Rounds, marks: &[bool], distances: &[i64]) {
        let marked = marks.iter().filter(|&&mark| mark).count();
        for &count in rounds.counts() {
            let iterations = self.below(count);
            self.queries += iterations.max(1);
            let probability = marked_probability(iterations, marked, rounds.states());
            if self.stream.uniform() >= probability {
                // The measured state is unmarked, and its number carries no information.
                continue;
            }
            let chosen = self.below(marked as u64) as usize;
            let mut places = (0..marks.len()).filter(|&place| marks[place]);
            if let Some(place) = places.nth(chosen) {
                self.best = Some(Candidate {
                    distance: distances[place],
                    primitive: place as u32,
                });
                return;
            }
        }
        self.over = true;
    }

    /// Returns the nearest face found so far.
    pub fn nearest(&self) -> Option<Candidate> {
        self.best
    }

    /// Returns the number of queries used so far.
    pub fn queries(&self) -> u64 {
        self.queries
    }

    /// Returns whether the search is over: all rounds of its last search failed.
    pub fn is_over(&self) -> bool {
        self.over
    }

    /// Draws a number below `bound`, uniformly up to `bound 2^-53`.
    fn below(&mut self, bound: u64) -> u64 {
        (self.stream.uniform() * bound as f64) as u64
    }
}
