//! A picture that is refined: with more and more paths, and with more and more queries.

use super::{Answer, Refused};
use qrt_core::oracle::Oracles;
use qrt_counting::estimators::Noise;
use qrt_counting::{Comparators, CountingError};
use qrt_runtime::models::{MachineOptions, Model, path_machines};
use qrt_runtime::path_machines::PathMachine;
use qrt_runtime::sample::{Countable, Draws, Tally, tallies};
use qrt_runtime::workers::Workers;
use qrt_scene::{Counting, Estimator};
use qrt_tracer::ByClass;
use std::ops::Range;

/// The estimator that is used if the scene's own is `exact`.
const BESIDE_EXACT: Estimator = Estimator::Auto;

/// A part of a picture, as far as it is traced.
pub(super) struct Picture {
    machines: ByClass<Machine>,
    counting: Counting,
    comparator_bits: u32,
    path_bits: u32,
    seed: u64,
    film: [u32; 2],
    pixels: Vec<[u32; 2]>,
    /// By pixel, up to the last one of which paths are traced, the sums over its traced paths.
    tallies: Vec<Tally>,
    /// By pixel, the number of traced paths.
    paths: Vec<u64>,
    /// By pixel, the last estimate, and the queries that it took.
    estimated: Vec<([f64; 3], u64)>,
}

/// The machine that traces the pixels of a class, and their comparators.
struct Machine {
    paths: Box<dyn PathMachine>,
    bound: [f64; 3],
    comparators: [Comparators; 3],
}

impl Machine {
    fn tallies(&self, pixels: &[[u32; 2]], ids: Range<u64>) -> Result<Vec<Tally>, Refused> {
        let workers = Workers::default();
        let machine = &*self.paths;
        Ok(tallies(
            machine,
            pixels,
            ids,
            &[self.comparators],
            &workers,
        )?)
    }

    /// The mean of `paths` paths: of their colours, or of the thresholds that the colours exceed.
    fn mean(&self, tally: &Tally, paths: u64, comparator_bits: u32) -> [f64; 3] {
        let ids = (paths << comparator_bits) as f64;
        let counts = self.paths.fraction().is_some();
        std::array::from_fn(|c| {
            if counts {
                self.bound[c] * (tally.good[0][c] as f64 / ids)
            } else {
                tally.colour[c] / paths as f64
            }
        })
    }
}

impl Picture {
    /// Creates the part of the picture with every `parts`-th pixel, beginning with pixel `part`.
    pub(super) fn new(
        oracles: &Oracles<'_>,
        model: Model,
        seed: u64,
        (part, parts): (u64, u64),
    ) -> Result<Self, Refused> {
        let options = MachineOptions {
            model,
            seed,
            ..MachineOptions::default()
        };
        let written = oracles.scene().scene();
        let machine = |machine: Box<dyn PathMachine>| {
            let bound = machine.bounds();
            Ok::<_, CountingError>(Machine {
                paths: machine,
                bound,
                comparators: Comparators::rgb(bound, written.comparator)?,
            })
        };
        let machines = path_machines(oracles, &options)?
            .by_class
            .try_map(machine)?;
        let film = [written.film.width, written.film.height];
        let all = (0..film[1]).flat_map(|y| (0..film[0]).map(move |x| [x, y]));
        let pixels: Vec<[u32; 2]> = all.skip(part as usize).step_by(parts as usize).collect();
        let comparator_bits = written.comparator.bits;
        Ok(Self {
            machines,
            counting: written.counting,
            comparator_bits,
            path_bits: written.sampling.path_bits,
            seed,
            film,
            tallies: Vec::new(),
            paths: vec![0; pixels.len()],
            estimated: vec![([0.0; 3], 0); pixels.len()],
            pixels,
        })
    }

    pub(super) fn description(&self) -> Answer {
        let estimators: Vec<&str> = Estimator::ALL
            .iter()
            .filter(|&&estimator| estimator != Estimator::Exact)
            .map(|estimator| estimator.name())
            .collect();
        Answer::default()
            .number("width", self.film[0].into())
            .number("height", self.film[1].into())
            .number("pixels", self.pixels.len() as f64)
            .number("path_bits", self.path_bits.into())
            .number("comparator_bits", self.comparator_bits.into())
            .number("phase_bits", self.counting.phase_bits.into())
            .number("repetitions", self.counting.repetitions.into())
            .text("estimator", self.estimator().name())
            .lines("estimators", &estimators)
    }

    /// The scene's estimator, or `auto` if the scene's own is `exact`, which does not measure.
    fn estimator(&self) -> Estimator {
        match self.counting.estimator() {
            Estimator::Exact => BESIDE_EXACT,
            other => other,
        }
    }

    fn machine(&self, pixel: [u32; 2]) -> &Machine {
        self.machines.at(pixel)
    }

    fn range(&self, first: usize, count: usize) -> Range<usize> {
        let first = first.min(self.pixels.len());
        first..first.saturating_add(count).min(self.pixels.len())
    }

    /// Traces the missing ones of the first `2^bits` paths, at most all paths of the scene. It
    /// traces the pixels of the range up to the first one whose number of traced paths differs from
    /// that of the first pixel. Answers the means, and which pixels they are of.
    pub(super) fn trace(
        &mut self,
        first: usize,
        count: usize,
        bits: u32,
    ) -> Result<Answer, Refused> {
        let range = self.range(first, count);
        let before = self.paths.get(range.start).copied().unwrap_or(0);
        let alike = self.paths[range.clone()]
            .iter()
            .take_while(|&&paths| paths == before)
            .count();
        let range = range.start..range.start + alike;
        let until = 1_u64 << bits.min(self.path_bits);
        if before < until && !range.is_empty() {
            let pixels = &self.pixels[range.clone()];
            let trace = |machine: &Machine, pixels: &[_]| machine.tallies(pixels, before..until);
            let found = self.machines.apart(pixels, trace)?;
            if self.tallies.len() < range.end {
                self.tallies.resize_with(range.end, Tally::default);
            }
            for (place, more) in range.clone().zip(found) {
                let tally = &mut self.tallies[place];
                if before == 0 {
                    *tally = more;
                } else {
                    tally.add(&more);
                }
                self.paths[place] = until;
            }
        }
        let means: Vec<[f64; 3]> = range.clone().map(|place| self.mean(place)).collect();
        Ok(Answer::default()
            .number("first", range.start as f64)
            .number("count", range.len() as f64)
            .list("radiance", means.into_iter().flatten()))
    }

    /// Adds to the answer `traced` the difference from `other` on the same paths: the sum of the
    /// other's values, and the sum of the squares of the differences.
    pub(super) fn against(&self, other: &Self, traced: Answer) -> Result<Answer, Refused> {
        let [first, count] = ["first", "count"].map(|name| traced.number_of(name).unwrap_or(0.0));
        let range = self.range(first as usize, count as usize);
        let (mut sum, mut squares) = (0.0, 0.0);
        for place in range {
            if other.paths.get(place) != self.paths.get(place) {
                return Err(Refused::NotTraced);
            }
            for (own, expected) in self.mean(place).iter().zip(other.mean(place)) {
                sum += expected;
                squares += (own - expected) * (own - expected);
            }
        }
        Ok(traced.number("sum", sum).number("squares", squares))
    }

    /// The mean of the traced paths of a pixel; black before the first.
    fn mean(&self, place: usize) -> [f64; 3] {
        let machine = self.machine(self.pixels[place]);
        let paths = self.paths[place];
        if paths == 0 {
            return [0.0; 3];
        }
        machine.mean(&self.tallies[place], paths, self.comparator_bits)
    }

    /// Estimates these pixels anew from all their paths, as `qrt render` does with `phase_bits`
    /// phase bits. It uses the estimator `name`, or the scene's if that is empty. Answers the
    /// colours and, over these pixels, the sums of the exact values, of the squared errors, and of
    /// the queries.
    pub(super) fn estimate(
        &mut self,
        name: &str,
        phase_bits: u32,
        first: usize,
        count: usize,
    ) -> Result<Answer, Refused> {
        let range = self.range(first, count);
        let estimator = match name {
            "" => self.estimator(),
            name => Estimator::from_name(name)
                .filter(|&estimator| estimator != Estimator::Exact)
                .ok_or_else(|| Refused::NoSuchEstimator(name.to_owned()))?,
        };
        let all = 1_u64 << self.path_bits;
        if self.paths[range.clone()].iter().any(|&paths| paths < all) {
            return Err(Refused::NotTraced);
        }
        let counting = Counting {
            estimator: Some(estimator),
            phase_bits,
            ..self.counting
        };
        let pixels = &self.pixels[range.clone()];
        let scales: Vec<[f64; 3]> = pixels.iter().map(|&p| self.machine(p).bound).collect();
        let draws = Draws {
            counting: &counting,
            scales: &scales,
            noise: Noise::NONE,
            seed: self.seed,
            count: 1,
            total: all << self.comparator_bits,
        };
        // No pixel, or pixels whose paths are all traced.
        let tallies = self.tallies.get(range.clone()).unwrap_or_default();
        let drawn = if counting.reads_levels() {
            let levels: Vec<_> = tallies.iter().map(|t| t.levels.clone()).collect();
            draws.draw(pixels, &Countable::Levels(&levels))?
        } else {
            let good: Vec<[u64; 3]> = tallies.iter().map(|t| t.good[0]).collect();
            draws.draw(pixels, &Countable::Whole(&good))?
        };
        let (mut sum, mut squares, mut queries) = (0.0, 0.0, 0);
        for (place, drawn) in range.clone().zip(drawn) {
            let comparators = self.machine(self.pixels[place]).comparators;
            let colour = std::array::from_fn(|c| {
                // A channel whose scale is 0 is proven black.
                match self.machine(self.pixels[place]).bound[c] {
                    0.0 => 0.0,
                    _ => comparators[c].pixel_of_amplitude(drawn.amplitudes[0][c]),
                }
            });
            for (exact, found) in self.mean(place).iter().zip(&colour) {
                sum += exact;
                squares += (found - exact) * (found - exact);
            }
            let spent: u64 = drawn.queries.iter().sum();
            queries += spent;
            self.estimated[place] = (colour, spent);
        }
        let colours = self.estimated[range.clone()].iter().map(|of| of.0);
        Ok(Answer::default()
            .number("first", range.start as f64)
            .number("count", range.len() as f64)
            .list("radiance", colours.flatten())
            .number("sum", sum)
            .number("squares", squares)
            .number("queries", queries as f64))
    }
}
