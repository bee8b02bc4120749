//! The minimum, by searching again for what is nearer than what was found.

use super::rounds::{Rounds, marked_probability};
use crate::machines::Candidate;
use crate::random::Stream;

/// A search for the nearest face of one ray.
#[derive(Clone, Debug)]
pub struct Search {
    stream: Stream,
    best: Option<Candidate>,
    queries: u64,
    over: bool,
}

impl Search {
    /// A search that knows of nothing yet, and draws from `stream`.
    pub fn new(stream: Stream) -> Self {
        Self {
            stream,
            best: None,
            queries: 0,
            over: false,
        }
    }

    /// Asks whether the ray meets the face that was guessed: one query.
    pub fn guess(&mut self, meets: bool, guess: Candidate) {
        self.queries += 1;
        if meets {
            self.best = Some(guess);
        }
    }

    /// The rounds of one search for a marked state: until one is measured, or all have failed and
    /// the search is over. `marks` and `distances` are the oracle's for [`Search::nearest`].
    pub fn run(&mut self, rounds: &Rounds, marks: &[bool], distances: &[i64]) {
        let marked = marks.iter().filter(|&&mark| mark).count();
        for &count in rounds.counts() {
            let iterations = self.below(count);
            self.queries += iterations.max(1);
            let probability = marked_probability(iterations, marked, rounds.states());
            if self.stream.uniform() >= probability {
                // An unmarked state: which one, says nothing.
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

    /// The nearest face so far.
    pub fn nearest(&self) -> Option<Candidate> {
        self.best
    }

    /// How many queries were used so far.
    pub fn queries(&self) -> u64 {
        self.queries
    }

    /// Whether it has given up, and so ended.
    pub fn is_over(&self) -> bool {
        self.over
    }

    /// A number below `bound`, each as likely as another up to `bound 2^-53`.
    fn below(&mut self, bound: u64) -> u64 {
        (self.stream.uniform() * bound as f64) as u64
    }
}
