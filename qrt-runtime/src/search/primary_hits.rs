//! The primary hits of paths, found by asking the oracle of nearest hits.

use super::{Rounds, Search};
use crate::machines::{Answers, Asked, Candidate, Defect, NearestMachine, PathRun, PrimaryHits};
use crate::named::named;
use crate::random::Stream;
use std::collections::BTreeMap;

/// Paths in turn of which each takes the hit of the one before as its first guess. Chains begin at
/// multiples of this; blocks of paths and the paths of a pixel are whole chains or shorter than
/// one, so that nothing depends on how paths are cut into blocks.
const CHAIN: usize = 16;

/// Pixels of a row of which each takes, for the first path of each chain, the hit of the same path
/// of the pixel on its left. Such rows begin at multiples of this, so that a pixel depends on few
/// others; those that a call does not ask for are searched, too, and their queries not counted:
/// the call that asks for them does. So nothing depends on how a film is cut into tiles.
const ROW: u32 = 8;

/// Basis states whose answers are held at a time, unless one ray alone has more.
const STATES: usize = 1 << 18;

/// The channel of [`Stream`] that searches draw from; counting has those of the colours.
const CHANNEL: u8 = 16;

named! {
    /// What a search begins with.
    #[derive(Default)]
    pub enum Guess {
        /// Whatever its first round measures.
        Random = "random",
        /// What the path before it met, and for the first one of a pixel what the same path of the
        /// pixel beside it met: coherence between pixels (Santos 2024).
        #[default]
        Coherent = "coherent",
    }
}

/// How the nearest face is found.
#[derive(Clone, Debug, PartialEq)]
pub enum Method {
    /// By asking the oracle about every face: P queries a ray.
    Exhaustive,
    /// By Grover's search for the nearest face.
    Grover(Rounds, Guess),
}

/// What a ray meets first, and the queries that finding it took.
type Found = (Option<Candidate>, u64);

/// What finds the primary hits of paths: see [`PrimaryHits`].
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
    ) -> Result<Vec<Found>, Defect> {
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
    fn exhaust(&self, rays: &[Asked]) -> Result<Vec<Found>, Defect> {
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

    /// The nearest of any number of rays' faces, and how many queries each took.
    fn all(&self, rays: &[Asked], guesses: &[Option<u32>]) -> Result<Vec<Found>, Defect> {
        // Rays whose answers fit into memory together.
        let together = (STATES / self.machine.oracle().states()).max(1);
        let mut found = Vec::with_capacity(rays.len());
        for (rays, guesses) in rays.chunks(together).zip(guesses.chunks(together)) {
            found.extend(match &self.method {
                Method::Exhaustive => self.exhaust(rays)?,
                Method::Grover(rounds, _) => self.search(rounds, rays, guesses)?,
            });
        }
        Ok(found)
    }

    /// Of the lanes that begin a chain: the lane, what it met, and its queries.
    fn chains_first(
        &self,
        lanes: &[(usize, Asked)],
    ) -> Result<Vec<(usize, Option<Candidate>, u64)>, Defect> {
        // By row, path and column: the lane, if it is one.
        let mut firsts: BTreeMap<(u32, u64, u32), Option<usize>> = BTreeMap::new();
        for (lane, &(_, Asked { pixel, id, .. })) in lanes.iter().enumerate() {
            if (id as usize).is_multiple_of(CHAIN) {
                let [x, y] = pixel;
                for before in x - x % ROW..x {
                    firsts.entry((y, id, before)).or_insert(None);
                }
                firsts.insert((y, id, x), Some(lane));
            }
        }
        let mut met: BTreeMap<(u32, u64, u32), u32> = BTreeMap::new();
        let mut found = Vec::new();
        for column in 0..ROW {
            let now = firsts.iter().filter(|((_, _, x), _)| x % ROW == column);
            let (places, lanes): (Vec<_>, Vec<_>) = now.unzip();
            let guess = |&&(y, id, x): &&(u32, u64, u32)| {
                let before = x.checked_sub(1).filter(|_| column > 0)?;
                met.get(&(y, id, before)).copied()
            };
            let guesses: Vec<Option<u32>> = places.iter().map(guess).collect();
            let ray = |&&(y, id, x): &&(u32, u64, u32)| Asked {
                pixel: [x, y],
                id,
                best: None,
            };
            let rays: Vec<Asked> = places.iter().map(ray).collect();
            for ((&&place, &lane), (hit, asked)) in
                places.iter().zip(lanes).zip(self.all(&rays, &guesses)?)
            {
                met.extend(hit.map(|hit| (place, hit.primitive)));
                found.extend(lane.map(|lane| (lane, hit, asked)));
            }
        }
        Ok(found)
    }
}

impl PrimaryHits for FoundHits {
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
        let mut store = |lane: usize, hit: Option<Candidate>, asked: u64, hits: &mut [u64]| {
            hits[lane] = number(hit);
            queries[lanes[lane].0] += asked;
        };
        if chained {
            for (lane, hit, asked) in self.chains_first(&lanes)? {
                store(lane, hit, asked, hits);
            }
        }
        // Lanes that are found at the same time.
        let steps = if chained { 1..CHAIN } else { 0..1 };
        for step in steps {
            let now = |lane: &usize| !chained || lanes[*lane].1.id as usize % CHAIN == step;
            let now: Vec<usize> = (0..lanes.len()).filter(now).collect();
            let rays: Vec<Asked> = now.iter().map(|&lane| lanes[lane].1).collect();
            let guess = |&lane: &usize| {
                let before = lane.checked_sub(1).filter(|_| chained)?;
                let one_run = lanes[before].0 == lanes[lane].0;
                let hit = Some(hits[before]).filter(|&hit| one_run && hit < none)?;
                u32::try_from(hit).ok()
            };
            let guesses: Vec<Option<u32>> = now.iter().map(guess).collect();
            for (&lane, (hit, asked)) in now.iter().zip(self.all(&rays, &guesses)?) {
                store(lane, hit, asked, hits);
            }
        }
        Ok(())
    }
}
