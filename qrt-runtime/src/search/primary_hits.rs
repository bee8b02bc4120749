//! Finds the primary hits of paths with the oracle of nearest hits.

use super::{Rounds, Search};
use crate::named::named;
use crate::path_machines::{
    Answers, Candidate, Defect, NearestMachine, NearestQuery, PathRun, PrimaryHits,
};
use qrt_counting::random::Stream;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Number of successive paths in a chain: each takes the hit of the path before it as its first
/// guess. Chains begin at multiples of this number. Blocks of paths and the paths of a pixel are
/// whole chains or shorter than one, so the result does not depend on how paths are cut into
/// blocks.
const CHAIN: usize = 16;

/// Number of successive pixels of a row in a group. For the first path of each chain, a pixel takes
/// the hit of the same path of the pixel on its left. Groups begin at multiples of this number, so
/// a pixel depends on few others. A call also searches those pixels of the group that it needs but
/// was not called for, and does not count their queries: the call for these pixels counts them. The
/// result therefore does not depend on how a film is cut into tiles.
const ROW: u32 = 8;

/// The largest number of basis states whose answers are in memory at a time, unless one ray has
/// more.
const STATES: usize = 1 << 18;

/// The channel of [`Stream`] from which searches draw; counting uses those of the colours.
const CHANNEL: u8 = 16;

named! {
    /// The first guess of a search.
    #[derive(Default)]
    #[cfg_attr(feature = "parts", derive(serde::Serialize, serde::Deserialize))]
    pub enum Guess {
        /// No guess: the search begins with its first round.
        Random = "random",
        /// The face that the path before it met. The first path of a pixel takes the face that the
        /// same path of the neighbouring pixel met: coherence between pixels (Santos 2024).
        #[default]
        Coherent = "coherent",
    }
}

/// The method that finds the nearest face.
#[derive(Clone, Debug, PartialEq)]
pub enum Method {
    /// Queries the oracle about every face: P queries for each ray.
    Exhaustive,
    /// Grover's search for the nearest face.
    Grover(Rounds, Guess),
}

/// The primary hit of a ray, and the number of queries that found it.
type Found = (Option<Candidate>, u64);

/// Finds the primary hits of paths: see [`PrimaryHits`].
pub struct FoundHits {
    machine: Arc<NearestMachine>,
    method: Method,
    seed: u64,
}

/// The place of a path on the film, ordered by row, path index and column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct PathPlace {
    row: u32,
    id: u64,
    column: u32,
}

/// The primary hit of a lane's path.
struct LaneHit {
    lane: usize,
    /// The hit; `None` if the ray meets nothing.
    hit: Option<Candidate>,
    /// Number of queries of the search.
    queries: u64,
}

impl FoundHits {
    /// Creates a finder that queries `machine` by `method`. Draws are keyed by `seed`, pixel and
    /// path.
    pub fn new(machine: impl Into<Arc<NearestMachine>>, method: Method, seed: u64) -> Self {
        Self {
            machine: machine.into(),
            method,
            seed,
        }
    }

    /// Returns the machine with the oracle of nearest hits.
    pub fn machine(&self) -> &NearestMachine {
        &self.machine
    }

    /// Searches for the nearest face of each of `rays`, and counts the queries. A guess is the
    /// number of a face; `guesses` has an entry for each ray.
    fn search(
        &self,
        rounds: &Rounds,
        rays: &[NearestQuery],
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
            let asked: Vec<NearestQuery> = open
                .iter()
                .map(|&ray| NearestQuery {
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
                search.run_rounds(rounds, marks, distances);
            }
            first = false;
            open.retain(|&ray| !searches[ray].is_over());
        }
        let found = searches.iter();
        Ok(found
            .map(|search| (search.nearest(), search.queries()))
            .collect())
    }

    /// Finds the nearest face of each ray by querying all faces.
    fn exhaust(&self, rays: &[NearestQuery]) -> Result<Vec<Found>, Defect> {
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

    /// Finds the nearest face of each ray, for any number of rays, and counts the queries of each.
    fn all(&self, rays: &[NearestQuery], guesses: &[Option<u32>]) -> Result<Vec<Found>, Defect> {
        // Number of rays whose answers fit into memory together.
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

    /// Finds the hits of the lanes that begin a chain.
    fn chains_first(&self, lanes: &[(usize, NearestQuery)]) -> Result<Vec<LaneHit>, Defect> {
        // The lane of each ray; `None` for a path of a pixel that was not requested.
        let mut firsts: BTreeMap<PathPlace, Option<usize>> = BTreeMap::new();
        for (lane, &(_, NearestQuery { pixel, id, .. })) in lanes.iter().enumerate() {
            if (id as usize).is_multiple_of(CHAIN) {
                let [column, row] = pixel;
                for column in column - column % ROW..column {
                    firsts.entry(PathPlace { row, id, column }).or_insert(None);
                }
                firsts.insert(PathPlace { row, id, column }, Some(lane));
            }
        }
        let mut met: BTreeMap<PathPlace, u32> = BTreeMap::new();
        let mut found = Vec::new();
        for column in 0..ROW {
            let now = firsts
                .iter()
                .filter(|(place, _)| place.column % ROW == column);
            let (places, lanes): (Vec<_>, Vec<_>) = now.unzip();
            let guess = |&&place: &&PathPlace| {
                let before = place.column.checked_sub(1).filter(|_| column > 0)?;
                let before = PathPlace {
                    column: before,
                    ..place
                };
                met.get(&before).copied()
            };
            let guesses: Vec<Option<u32>> = places.iter().map(guess).collect();
            let ray = |place: &&PathPlace| NearestQuery {
                pixel: [place.column, place.row],
                id: place.id,
                best: None,
            };
            let rays: Vec<NearestQuery> = places.iter().map(ray).collect();
            for ((&&place, &lane), (hit, queries)) in
                places.iter().zip(lanes).zip(self.all(&rays, &guesses)?)
            {
                met.extend(hit.map(|hit| (place, hit.primitive)));
                found.extend(lane.map(|lane| LaneHit { lane, hit, queries }));
            }
        }
        Ok(found)
    }
}

impl PrimaryHits for FoundHits {
    fn find(&self, runs: &[PathRun], hits: &mut [u64], queries: &mut [u64]) -> Result<(), Defect> {
        let none = self.machine.oracle().faces() as u64;
        let number = |hit: Option<Candidate>| hit.map_or(none, |hit| u64::from(hit.primitive));
        // The run and the ray of each lane.
        let lanes: Vec<(usize, NearestQuery)> = runs
            .iter()
            .enumerate()
            .flat_map(|(run, paths)| {
                let ids = paths.first..paths.first + paths.count as u64;
                ids.map(move |id| {
                    let pixel = paths.pixel;
                    (
                        run,
                        NearestQuery {
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
            for LaneHit { lane, hit, queries } in self.chains_first(&lanes)? {
                store(lane, hit, queries, hits);
            }
        }
        // Each step searches for the lanes at the same place of their chains together.
        let steps = if chained { 1..CHAIN } else { 0..1 };
        for step in steps {
            let now = |lane: &usize| !chained || lanes[*lane].1.id as usize % CHAIN == step;
            let now: Vec<usize> = (0..lanes.len()).filter(now).collect();
            let rays: Vec<NearestQuery> = now.iter().map(|&lane| lanes[lane].1).collect();
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
