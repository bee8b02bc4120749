//! The figure `picture`: a small picture that sharpens as queries are spent.
//!
//! The scene is the Cornell box of `scenes-yaml/`, made smaller. Its numbers are those of `qrt render`
//! with the same overrides and the same estimator at seed 0: here a seed draws outcomes, but does not
//! change the paths. The page traces and counts a few pixels at a time, so that it stays responsive.

use qrt_counting::Comparators;
use qrt_counting::estimators::{
    AdaptiveBayes, AmplitudeEstimator, CountingProblem, Device, Estimate, EstimatorError, Noise,
    Settings, WindowedCounting,
};
use qrt_counting::random::Stream;
use qrt_lab::playground::Answer;
use qrt_runtime::path_machines::Real;
use qrt_scene::meshes::Meshes;
use qrt_scene::valid::validate;
use qrt_scene::{Counting, Estimator};
use std::error::Error;
use std::ops::Range;

/// The scene: see `build.rs`.
mod made {
    use qrt_scene::{
        Camera, Circuit, Comparator, ComparatorAt, Counting, DepthSampling, Emitter, Estimator,
        Film, Geometry, Lambertian, LightPoint, Lights, Map, Material, Nearest, Perspective,
        Precision, Reflectance::Uniform, Sampling, Scene, Sequence, Uncompute, Window,
    };
    include!(concat!(env!("OUT_DIR"), "/picture.rs"));
}

/// Estimators that the figure offers, by their names on the command line.
pub const ESTIMATORS: [&str; 4] = ["monte-carlo", "paper", "sine", "adaptive-bayes"];
/// Most phase bits that the figure offers: a channel has 2^t - 1 queries.
pub const MOST_PHASE_BITS: u32 = 16;
/// Factor of radiances for display, because the box is dark.
const EXPOSURE: f64 = 2.0;

/// The picture as far as it is traced and estimated.
pub struct Picture {
    real: Real,
    scale: [f64; 3],
    comparators: [Comparators; 3],
    counting: Counting,
    /// Columns and rows.
    film: [u32; 2],
    pixels: Vec<[u32; 2]>,
    /// Mean of the paths and number of good ids, by pixel, as far as pixels are traced.
    traced: Vec<Traced>,
    /// Latest estimate, by pixel.
    estimated: Vec<[f64; 3]>,
    /// Number of queries of the latest estimate, by pixel.
    queries: Vec<u64>,
}

#[derive(Clone, Default)]
struct Traced {
    mean: [f64; 3],
    good: [u64; 3],
}

impl Picture {
    /// Creates the scene, with nothing traced.
    ///
    /// # Errors
    /// An invalid scene.
    pub fn new() -> Result<Self, Box<dyn Error>> {
        let valid =
            validate(made::scene(), &Meshes::default()).map_err(|_| "the scene is wrong")?;
        let real = Real::new(&valid, 0)?;
        let scene = valid.scene();
        let scale = real.stage().bound();
        let [r, g, b] = scale.map(|scale| Comparators::new(scale, scene.comparator));
        let film = [scene.film.width, scene.film.height];
        let rows = (0..film[1]).flat_map(|y| (0..film[0]).map(move |x| [x, y]));
        Ok(Self {
            scale,
            comparators: [r?, g?, b?],
            counting: scene.counting,
            film,
            pixels: rows.collect(),
            traced: Vec::new(),
            estimated: Vec::new(),
            queries: Vec::new(),
            real,
        })
    }

    /// Returns the description of the picture.
    pub fn description(&self) -> Answer {
        Answer::default()
            .number("width", self.film[0].into())
            .number("height", self.film[1].into())
            .number("paths", self.real.paths() as f64)
            .number("ids", self.ids(0) as f64)
            .number("most_phase_bits", MOST_PHASE_BITS.into())
            .lines("estimators", &ESTIMATORS)
            .lines("sets", &made::SMALLER)
    }

    fn ids(&self, channel: usize) -> u64 {
        self.real.paths() * self.comparators[channel].count()
    }

    /// Traces every path of the next `count` pixels. Returns their levels of sRGB.
    pub fn trace(&mut self, count: usize) -> Answer {
        let first = self.traced.len();
        let last = (first + count).min(self.pixels.len());
        let pixels = &self.pixels[first..last];
        let paths = self.real.paths();
        let mut sums = vec![Traced::default(); pixels.len()];
        self.real.trace(pixels, |block| {
            let sum = &mut sums[block.pixel];
            for (channel, colours) in block.colours.into_iter().enumerate() {
                sum.mean[channel] += colours.iter().sum::<f64>() / paths as f64;
                sum.good[channel] += self.comparators[channel].good_total(colours);
            }
        });
        self.traced.append(&mut sums);
        let traced = self.traced[first..].iter();
        Answer::default()
            .number("first", first as f64)
            .number("traced", self.traced.len() as f64)
            .list("levels", traced.flat_map(|pixel| levels(&pixel.mean)))
    }

    /// Estimates the colours of `pixels` again, with 2^`phase_bits` - 1 queries a channel. Returns their
    /// levels of sRGB.
    ///
    /// # Errors
    /// An unknown estimator, or phase bits out of range.
    pub fn estimate(
        &mut self,
        name: &str,
        phase_bits: u32,
        seed: u32,
        pixels: Range<usize>,
    ) -> Result<Answer, Box<dyn Error>> {
        let counting = Counting {
            phase_bits,
            repetitions: 1,
            ..self.counting
        };
        let estimator = estimator(name, &Settings::from_counting(&counting)?)?;
        let first = pixels.start.min(self.traced.len());
        let last = pixels.end.min(self.traced.len());
        self.estimated.resize(self.traced.len(), [0.0; 3]);
        self.queries.resize(self.traced.len(), 0);
        for place in first..last {
            let (colour, queries) = self.pixel(&*estimator, seed, place)?;
            self.estimated[place] = colour;
            self.queries[place] = queries;
        }
        let estimated = self.estimated[first..last].iter();
        Ok(Answer::default()
            .number("first", first as f64)
            .list("levels", estimated.flat_map(levels)))
    }

    fn pixel(
        &self,
        estimator: &dyn AmplitudeEstimator,
        seed: u32,
        place: usize,
    ) -> Result<([f64; 3], u64), EstimatorError> {
        let [x, y] = self.pixels[place];
        let mut colour = [0.0; 3];
        let mut queries = 0;
        for (channel, value) in colour.iter_mut().enumerate() {
            let comparators = self.comparators[channel];
            // The channel is proven black, so there is nothing to count.
            if self.scale[channel] == 0.0 {
                continue;
            }
            let problem = CountingProblem {
                good: self.traced[place].good[channel],
                total: self.ids(channel),
            };
            let mut stream = Stream::new(seed.into(), x, y, channel as u8);
            let mut device = Device::new(problem, Noise::NONE, &mut stream)?;
            let estimate = estimator.estimate(&mut device)?;
            queries += estimate.queries;
            *value = comparators.pixel_of_amplitude(estimate.amplitude);
        }
        Ok((colour, queries))
    }

    /// Returns the exact means of the paths, the estimates, and their RMSE relative to the mean.
    pub fn summary(&self) -> Answer {
        let pairs = self.traced.iter().zip(&self.estimated);
        let values = 3 * pairs.len().max(1);
        let (mut sum, mut squares) = (0.0, 0.0);
        for (traced, estimated) in pairs {
            for (exact, found) in traced.mean.iter().zip(estimated) {
                sum += exact;
                squares += (found - exact) * (found - exact);
            }
        }
        let mean = sum / values as f64;
        let queries = self.queries.iter().sum::<u64>() as f64 / self.queries.len().max(1) as f64;
        Answer::default()
            .number("mean", mean)
            .number("rmse", (squares / values as f64).sqrt() / mean)
            .number("queries", queries)
            .list("exact", self.traced.iter().flat_map(|pixel| pixel.mean))
            .list("estimated", self.estimated.iter().copied().flatten())
    }
}

/// The estimator `monte-carlo` without a requested error: the fraction of good paths among a fixed number.
struct Paths(u64);

impl AmplitudeEstimator for Paths {
    fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError> {
        let start = device.usage();
        let amplitude = device.paths(self.0) as f64 / self.0 as f64;
        Ok(device.estimate(start, amplitude, (0.0, 1.0), 1.0))
    }
}

/// Returns the estimator `name`, one of those that the figure offers. A lookup among all of qrt's
/// estimators would send the code of all of them to browsers.
fn estimator(
    name: &str,
    settings: &Settings,
) -> Result<Box<dyn AmplitudeEstimator>, Box<dyn Error>> {
    Ok(match name {
        "monte-carlo" => Box::new(Paths(settings.queries)),
        "paper" => Box::new(WindowedCounting::new(Estimator::Paper, settings)?),
        "sine" => Box::new(WindowedCounting::new(Estimator::Sine, settings)?),
        "adaptive-bayes" => Box::new(AdaptiveBayes::new(settings)?),
        _ => return Err("the figure has no such estimator".into()),
    })
}

/// Returns the 8-bit levels of sRGB (IEC 61966-2-1) that show a radiance.
fn levels(radiance: &[f64; 3]) -> [f64; 3] {
    radiance.map(|linear| {
        let linear = (EXPOSURE * linear).clamp(0.0, 1.0);
        let encoded = if linear <= 0.003_130_8 {
            12.92 * linear
        } else {
            1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055
        };
        libm::round(255.0 * encoded)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Traces the picture all at once, or `step` pixels at a time.
    fn picture(step: usize) -> Picture {
        let mut picture = Picture::new().unwrap();
        let all = picture.pixels.len();
        while picture.traced.len() < all {
            picture.trace(step);
        }
        picture
    }

    fn estimated(picture: &mut Picture, name: &str, phase_bits: u32, step: usize) -> Answer {
        let all = picture.pixels.len();
        for first in (0..all).step_by(step) {
            let pixels = first..first + step;
            picture.estimate(name, phase_bits, 0, pixels).unwrap();
        }
        picture.summary()
    }

    #[test]
    fn it_does_not_matter_how_many_pixels_are_made_at_a_time() {
        let (mut one, mut other) = (picture(7), picture(1000));
        let one = estimated(&mut one, "sine", 6, 11);
        assert_eq!(one, estimated(&mut other, "sine", 6, 1000));
    }

    /// Expects the standard error of Monte Carlo from q queries, over all pixels, within a tenth for 1,728
    /// values; the good ids that were counted give its value.
    #[test]
    fn the_error_of_monte_carlo_is_the_binomial_one() {
        let mut picture = picture(1000);
        let variance = |traced: &Traced, channel: usize| {
            let p = traced.good[channel] as f64 / picture.ids(channel) as f64;
            let scale = picture.scale[channel];
            scale * scale * p * (1.0 - p) / 255.0
        };
        let traced = picture.traced.iter();
        let squares: f64 = traced
            .flat_map(|traced| [0, 1, 2].map(|channel| variance(traced, channel)))
            .sum();
        let expected = (squares / (3 * picture.traced.len()) as f64).sqrt();
        let summary = estimated(&mut picture, "monte-carlo", 8, 1000);
        let found = summary.number_of("rmse").unwrap() * summary.number_of("mean").unwrap();
        assert!((found / expected - 1.0).abs() < 0.1, "{found} {expected}");
        assert_eq!(summary.number_of("queries"), Some(3.0 * 255.0));
    }

    #[test]
    fn every_estimator_sharpens_and_keeps_to_its_queries() {
        let mut picture = picture(1000);
        for name in ESTIMATORS {
            let mut last = f64::INFINITY;
            for phase_bits in [4, 8, 12] {
                let summary = estimated(&mut picture, name, phase_bits, 1000);
                let rmse = summary.number_of("rmse").unwrap();
                assert!(rmse < last, "{name} {phase_bits}: {rmse}, {last}");
                last = rmse;
                let most = 3 * ((1 << phase_bits) - 1);
                assert!(summary.number_of("queries").unwrap() <= f64::from(most));
            }
        }
    }

    /// Compares the scene with the front end's, and the estimates with those of `qrt render`.
    #[test]
    fn it_is_the_scene_of_the_repository() {
        use qrt_runtime::render::{RenderOptions, render};
        use qrt_scene::Estimator;
        let path = "../../scenes-yaml/cornell-box.yaml".as_ref();
        let mut sets = made::SMALLER.map(str::to_owned).to_vec();
        let scene = qrt_scene::front::load(path, &sets).unwrap().valid;
        assert_eq!(*scene.scene(), made::scene());
        let mut picture = picture(1000);
        sets.push("counting.phase_bits=7".to_owned());
        let scene = qrt_scene::front::load(path, &sets).unwrap().valid;
        for name in ESTIMATORS {
            let rendered = render(
                &scene,
                &RenderOptions {
                    estimator: Estimator::from_name(name),
                    ..RenderOptions::default()
                },
            );
            let summary = estimated(&mut picture, name, 7, 1000);
            let expected: Vec<f64> = rendered.unwrap().image.pixels.concat();
            assert_eq!(summary.list_of("estimated").unwrap(), expected, "{name}");
        }
    }

    #[test]
    fn white_is_white_and_black_is_black() {
        assert_eq!(levels(&[0.0, 0.5, 9.0]), [0.0, 255.0, 255.0]);
        // 0.5 linear is 188 in sRGB.
        assert_eq!(levels(&[0.25; 3]), [188.0; 3]);
    }
}
