//! The first hits of paths, found by asking the oracle of nearest hits.

use super::{Rounds, Search};
use crate::machines::{Answers, Asked, Candidate, Defect, FirstHits, NearestMachine, PathRun};
use crate::random::Stream;

/// Paths in turn of which each takes the hit of the one before as its first guess. Chains begin at
/// multiples of this; blocks of paths and the paths of a pixel are whole chains or shorter than
/// one, so that nothing depends on how paths are cut into blocks.
const CHAIN: usize = 16;

/// Basis states whose answers are held at a time, unless one ray alone has more.
const STATES: usize = 1 << 18;

/// The channel of [`Stream`] that searches draw from; counting has those of the colours.
const CHANNEL: u8 = 16;

/// What a search begins with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Guess {
    /// Whatever its first round measures.
    Random,
    /// What the path before it met (Santos 2024).
    #[default]
    Coherent,
}

impl Guess {
    /// As it is written.
    pub fn name(self) -> &'static str {
        match self {
            Self::Random => "random",
            Self::Coherent => "coherent",
        }
    }
}

/// How the nearest face is found.
#[derive(Clone, Debug, PartialEq)]
pub enum Method {
    /// By asking about every face: P queries.
    Exhaustive,
    /// By searching for it.
    Grover(Rounds, Guess),
}

/// What finds the first hits of paths: see [`FirstHits`].
pub struct FoundHits {
    machine: NearestMachine,
    method: Method,
    seed: u64,
}

impl FoundHits {
    /// Asks `machine`, by `method`; draws are keyed by seed, pixel and path.
    pub fn new(machine: NearestMachine, method: Method, seed: u64) -> Self {
        Self {
            machine,
            method,
            seed,
        }
    }

    /// The machine that is asked.
    pub fn machine(&self) -> &NearestMachine {
        &self.machine
    }

    /// The nearest of these rays' faces and how many queries it took, for as many rays as
    /// `guesses` has; a guess is a face's number.
    fn search(
        &self,
        rounds: &Rounds,
        rays: &[Asked],
        guesses: &[Option<u32>],
    ) -> Result<Vec<(Option<Candidate>, u64)>, Defect> {
        let mut answers = Answers::default();
        let mut searches: Vec<Search> = rays
            .iter()
            .map(|ray| {
                let [x, y] = ray.pixel;
                Search::new(Stream::of_path(self.seed, x, y, CHANNEL, ray.id))
            })
            .collect();
        let mut open: Vec<usize> = (0..rays.len()).collect();
        let mut first = true;
        while !open.is_empty() {
            let asked: Vec<Asked> = open
                .iter()
                .map(|&ray| Asked {
                    best: searches[ray].nearest(),
                    ..rays[ray]
                })
                .collect();
            self.machine.ask(&asked, &mut answers)?;
            for (place, &ray) in open.iter().enumerate() {
                let (marks, distances) = (answers.marks(place), answers.distances(place));
                let search = &mut searches[ray];
                if let (true, Some(guess)) = (first, guesses[ray]) {
                    let candidate = Candidate {
                        distance: distances[guess as usize],
                        primitive: guess,
                    };
                    search.guess(marks[guess as usize], candidate);
                    if search.nearest().is_some() {
                        continue;
                    }
                }
                search.run(rounds, marks, distances);
            }
            first = false;
            open.retain(|&ray| !searches[ray].is_over());
        }
        let found = searches.iter();
        Ok(found
            .map(|search| (search.nearest(), search.queries()))
            .collect())
    }

    /// The least of all.
    fn exhaust(&self, rays: &[Asked]) -> Result<Vec<(Option<Candidate>, u64)>, Defect> {
        let mut answers = Answers::default();
        self.machine.ask(rays, &mut answers)?;
        let least = |ray: usize| {
            let states = answers.marks(ray).iter().zip(answers.distances(ray));
            let met = states.zip(0..).filter(|((mark, _), _)| **mark);
            let met = met.map(|((_, &distance), primitive)| Candidate {
                distance,
                primitive,
            });
            met.min()
        };
        let queries = self.machine.oracle().faces() as u64;
        Ok((0..rays.len()).map(|ray| (least(ray), queries)).collect())
    }

    /// Rays whose answers fit into memory together.
    fn together(&self) -> usize {
        (STATES / self.machine.oracle().states()).max(1)
    }
}

impl FirstHits for FoundHits {
    fn find(&self, runs: &[PathRun], hits: &mut [u64], queries: &mut [u64]) -> Result<(), Defect> {
        let none = self.machine.oracle().faces() as u64;
        let number = |hit: Option<Candidate>| hit.map_or(none, |hit| u64::from(hit.primitive));
        // By lane: its run and its ray.
        let lanes: Vec<(usize, Asked)> = runs
            .iter()
            .enumerate()
            .flat_map(|(run, paths)| {
                let ids = paths.first..paths.first + paths.count as u64;
                ids.map(move |id| {
                    let pixel = paths.pixel;
                    (
                        run,
                        Asked {
                            pixel,
                            id,
                            best: None,
                        },
                    )
                })
            })
            .collect();
        let chained = matches!(&self.method, Method::Grover(_, Guess::Coherent));
        // Lanes that are found at the same time.
        let steps = if chained { CHAIN } else { 1 };
        for step in 0..steps {
            let now: Vec<usize> = (0..lanes.len())
                .filter(|&lane| lanes[lane].1.id as usize % steps == step)
                .collect();
            for lanes_now in now.chunks(self.together()) {
                let rays: Vec<Asked> = lanes_now.iter().map(|&lane| lanes[lane].1).collect();
                let found = match &self.method {
                    Method::Exhaustive => self.exhaust(&rays)?,
                    Method::Grover(rounds, _) => {
                        let guess = |&lane: &usize| {
                            let before = lane.checked_sub(1).filter(|_| step > 0)?;
                            let one_run = lanes[before].0 == lanes[lane].0;
                            let hit = Some(hits[before]).filter(|&hit| one_run && hit < none)?;
                            u32::try_from(hit).ok()
                        };
                        let guesses: Vec<Option<u32>> = lanes_now.iter().map(guess).collect();
                        self.search(rounds, &rays, &guesses)?
                    }
                };
                for (&lane, (hit, asked)) in lanes_now.iter().zip(found) {
                    hits[lane] = number(hit);
                    queries[lanes[lane].0] += asked;
                }
            }
        }
        Ok(())
    }
}
