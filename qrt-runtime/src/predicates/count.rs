//! Counts the fraction of paths that satisfy a predicate.

use super::check;
use crate::image::{CropWindow, Image};
use crate::models::{MachineOptions, Model, path_machines};
use crate::path_machines::QueryCost;
use crate::render::{RenderError, RenderOptions, crop_of};
use crate::workers::{Progress, slow_build};
use qrt_circuit::format::{Bool, Reg};
use qrt_circuit::{Recorded, Recorder};
use qrt_core::oracle::paths::PathScene;
use qrt_core::oracle::{Marks, Oracles, PREDICATE_CHANNEL, Predicate};
use qrt_counting::estimators::{CountingProblem, Device, Estimate, Noise, Settings};
use qrt_counting::random::Stream;
use qrt_scene::Estimator;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Number of paths that a job traces without a check for cancellation.
const RUN: u64 = 1 << 16;

/// The count of good paths of one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelCount {
    /// Column and row on the film.
    pub pixel: [u32; 2],
    /// S, the number of good paths. The simulated device knows it, the estimator does not.
    pub good: u64,
    /// The estimate of S/R, with its interval and its number of queries.
    pub estimate: Estimate,
}

/// The count of the paths that satisfy a predicate.
#[derive(Clone, Debug)]
pub struct PredicateCount {
    /// x, y, width and height on the film, in pixels.
    pub crop: [u32; 4],
    /// The film's width and height, in pixels.
    pub film: [u32; 2],
    /// The pixels, row by row from the crop's top left corner.
    pub pixels: Vec<PixelCount>,
    /// R, the number of paths of a pixel.
    pub paths: u64,
    /// The model that traced the paths.
    pub model: Model,
    /// The estimator of the fractions.
    pub estimator: Estimator,
    /// The cost of a query; `None` under [`Model::Real`], which has no circuit.
    pub cost: Option<QueryCost>,
}

impl PredicateCount {
    /// The estimated fraction of good paths over all pixels, in [0, 1].
    pub fn fraction(&self) -> f64 {
        self.mean(|estimate| estimate.amplitude)
    }

    /// An interval that contains the fraction if every pixel's interval contains the fraction of
    /// that pixel. For a single pixel, it is that pixel's interval, with its confidence.
    pub fn interval(&self) -> (f64, f64) {
        let low = self.mean(|estimate| estimate.interval.0);
        (low, self.mean(|estimate| estimate.interval.1))
    }

    /// Number of queries of the oracle, over all pixels.
    pub fn queries(&self) -> u128 {
        let queries = self
            .pixels
            .iter()
            .map(|pixel| u128::from(pixel.estimate.queries));
        queries.sum()
    }

    /// S, the number of good paths, over all pixels.
    pub fn good(&self) -> u128 {
        self.pixels.iter().map(|pixel| u128::from(pixel.good)).sum()
    }

    /// Returns the pixel in this column and row of the film, if it is within the crop.
    pub fn at(&self, [column, row]: [u32; 2]) -> Option<&PixelCount> {
        let [x, y, width, height] = self.crop;
        let (column, row) = (column.checked_sub(x)?, row.checked_sub(y)?);
        if column >= width || row >= height {
            return None;
        }
        self.pixels
            .get(row as usize * width as usize + column as usize)
    }

    /// Converts the estimated fractions to a grey picture of the crop's size.
    pub fn image(&self) -> Image {
        let pixels = self.pixels.iter();
        let [x, y, width, height] = self.crop;
        let window = CropWindow {
            origin: [x, y],
            film: self.film,
        };
        Image {
            width,
            height,
            pixels: pixels.map(|pixel| [pixel.estimate.amplitude; 3]).collect(),
            window: (self.film != [width, height]).then_some(window),
        }
    }

    fn mean(&self, of: impl Fn(&Estimate) -> f64) -> f64 {
        let pixels = self.pixels.iter().map(|pixel| of(&pixel.estimate));
        pixels.sum::<f64>() / self.pixels.len() as f64
    }
}

/// Counts the paths of a scene of `qrt!` that satisfy a predicate, pixel by pixel, as quantum
/// counting over the predicate's oracle would. Of the number S of good paths among R, the estimator
/// learns only what its measurements show.
///
/// The predicate gets a bit that is 0, and flips it on good paths. Its code runs once, on a
/// [`Recorder`]. Of `options`, the count uses `seed`, `crop` (a pixel, a part of the film, or all
/// of it), `model`, `estimator`, `noise`, `workers` and `quiet`. The estimator `exact` queries all
/// R paths, with one query each. The scene's `counting.error` is a radiance and has no effect here:
/// all queries of its counting block may be used.
///
/// # Errors
/// As [`crate::render::render`]; a [`qrt_core::oracle::PredicateError`] if the code is not a
/// predicate, and a [`super::PredicateRefusal`] for options that predicates don't support.
pub fn count_where<S: PathScene>(
    options: &RenderOptions<'_>,
    predicate: impl FnOnce(&mut Recorder, &S::Path, &mut Reg<Recorded, Bool>),
) -> Result<PredicateCount, RenderError> {
    let predicate = Predicate::record::<S>(predicate)?;
    check(&predicate, options)?;
    let scene = predicate.scene();
    let name = options.counted_by(scene.scene())?;
    if name == Estimator::Exact && options.noise != Noise::NONE {
        return Err(RenderError::NothingNoisy);
    }
    options.check_memory(scene)?;
    let crop = crop_of(scene, options)?;
    let [x, y, width, height] = crop;
    let rows = (y..y + height).flat_map(|row| (x..x + width).map(move |column| [column, row]));
    let pixels: Vec<[u32; 2]> = rows.collect();
    let path_bits = scene.scene().sampling.path_bits;
    let (paths, area) = (1_u64 << path_bits, pixels.len() as u64);
    let Some(total) = area.checked_mul(paths) else {
        return Err(RenderError::TooManyPaths {
            pixels: area,
            path_bits,
        });
    };
    let machines = path_machines(
        &Oracles::new(scene),
        &MachineOptions {
            model: options.model(),
            seed: options.seed,
            simd: options.simd,
            predicate: Some((&predicate, Marks::Paths)),
            ..MachineOptions::default()
        },
    )?;
    let machine = &**machines.by_class.at([x, y]);
    let cost = machine.query_cost();
    // A job traces several pixels of few paths, or a part of a pixel of many paths.
    let together = (RUN / paths).max(1) as usize;
    let chunks: Vec<&[[u32; 2]]> = pixels.chunks(together).collect();
    let runs = paths.div_ceil(RUN);
    let finished = AtomicU64::new(0);
    let counted = slow_build::noting(&options.workers, options.quiet, |workers| {
        workers.report(Progress::Started { total, resumed: 0 });
        workers.on_threads(|| {
            let jobs = (0..chunks.len() as u64 * runs).into_par_iter();
            let counted = jobs.map(|job| {
                if workers.cancelled() {
                    return Err(RenderError::Interrupted {
                        finished: finished.load(Ordering::Relaxed) / paths,
                        pixels: area,
                        checkpoint: None,
                    });
                }
                let (pixels, first) = (chunks[(job / runs) as usize], job % runs * RUN);
                let ids = first..(first + RUN).min(paths);
                let mut sums = vec![0; pixels.len()];
                let done = (ids.end - ids.start) * pixels.len() as u64;
                let mut unheld = None;
                machine.trace_paths(None, pixels, ids, &mut |traced| {
                    let pixel = traced.pixel();
                    match traced.marked() {
                        Some(good) => sums[pixel] += good,
                        None => {
                            unheld.get_or_insert(pixels[pixel]);
                        }
                    }
                })?;
                if let Some(pixel) = unheld {
                    return Err(RenderError::Unheld { pixel });
                }
                finished.fetch_add(done, Ordering::Relaxed);
                workers.report(Progress::Finished(done));
                Ok(sums)
            });
            counted.collect::<Result<Vec<Vec<u64>>, RenderError>>()
        })
    })??;
    let mut good = vec![0; pixels.len()];
    for (job, sums) in counted.into_iter().enumerate() {
        let first = job / runs as usize * together;
        for (good, sum) in good[first..].iter_mut().zip(sums) {
            *good += sum;
        }
    }
    // There are no comparators.
    let settings = Settings::from_counting(&scene.scene().counting)?.of_whole();
    let estimator = options.estimator_of(name, &settings)?;
    let estimated = pixels.into_iter().zip(good).map(|(pixel, good)| {
        let channel = PREDICATE_CHANNEL as u8;
        let mut stream = Stream::new(options.seed, pixel[0], pixel[1], channel);
        let problem = CountingProblem { good, total: paths };
        let mut device = Device::new(problem, options.noise, &mut stream)?;
        Ok(PixelCount {
            pixel,
            good,
            estimate: estimator.estimate(&mut device)?,
        })
    });
    let film = scene.scene().film;
    Ok(PredicateCount {
        crop,
        film: [film.width, film.height],
        pixels: estimated.collect::<Result<_, RenderError>>()?,
        paths,
        model: options.model(),
        estimator: name,
        cost,
    })
}
