//! The work on a picture, tile by tile on all threads.

use super::classes::Classes;
use super::film::{Film, Kept};
use super::parts::Parts;
use super::request::Request;
use super::stop::{Stop, go_on};
use super::tiles::{self, Tiles};
use super::totals::Totals;
use super::{RenderError, Rendered};
use crate::checkpoint::{Checkpoint, CheckpointError, Header, Tile};
use crate::workers::{Progress, Workers, slow_build};
use rayon::prelude::*;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// A picture that is being rendered.
pub(super) struct Job<'a> {
    request: Request<'a>,
    pixels: Classes,
    tiles: Tiles,
    /// For each pixel, true if the checkpoint has it; empty if the checkpoint has none.
    resumed: Vec<bool>,
    /// The checkpoint's parts of other pixels.
    kept: Kept,
    film: Mutex<Film>,
}

impl<'a> Job<'a> {
    /// Prepares the work, and opens the checkpoint if there is one.
    pub(super) fn new(request: Request<'a>, pixels: Classes) -> Result<Self, RenderError> {
        let whole = &request.scene.scene().film;
        let mut film = Film::new(request.crop, [whole.width, whole.height])?;
        let (resumed, kept) = film.open(request.options, || header(&request))?;
        Ok(Self {
            tiles: request.tiles,
            pixels,
            resumed,
            kept,
            film: Mutex::new(film),
            request,
        })
    }

    /// Renders all tiles that the checkpoint does not have. Returns the checkpoint open.
    pub(super) fn render(self) -> Result<(Rendered, Option<Checkpoint>), RenderError> {
        let Request {
            scene,
            options,
            crop,
            estimator,
            paths,
            ..
        } = self.request;
        let area = self.tiles.area();
        let resumed = self.resumed.iter().filter(|&&pixel| pixel).count() as u64;
        let parts = self.kept.values().map(|part| part.paths);
        let resumed_paths = resumed * paths + parts.sum::<u64>();
        let worked = slow_build::noting(&options.workers, options.quiet, |workers| {
            workers.report(Progress::Started {
                total: area * paths,
                resumed: resumed_paths,
            });
            workers.on_threads(|| {
                let start = Instant::now();
                // Threads take tiles one by one, because halves of a film rarely take equally long.
                let tiles = (0..self.tiles.count() as usize).into_par_iter();
                let done = tiles
                    .with_max_len(1)
                    .try_for_each(|number| self.tile(number as u64, workers));
                let seconds = start.elapsed().as_secs_f64();
                (done, seconds, rayon::current_num_threads())
            })
        });
        let (done, seconds, threads) =
            worked.unwrap_or_else(|error| (Err(Stop::from(error)), 0.0, 0));
        let mut film = self
            .film
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner);
        let finished = film.finished;
        match done {
            Ok(()) => {
                let rendered = Rendered {
                    scene_name: scene.scene().name.clone(),
                    scene_hash: scene.fingerprint().to_string(),
                    film: [scene.scene().film.width, scene.scene().film.height],
                    image: film.image,
                    counted: film.counted,
                    model: options.model(),
                    primary_hits: options.primary_hits(),
                    crop,
                    estimator,
                    own_estimator: options.own_estimator.map(|own| own.name().to_owned()),
                    colour: options.colour,
                    noise: options.noise,
                    seed: options.seed,
                    parameters: scene.parameters(),
                    plan: None,
                    scales: self.pixels.scales(),
                    ids: paths << scene.scene().comparator.bits,
                    paths: area * paths,
                    resumed_paths,
                    seconds,
                    threads,
                };
                Ok((rendered, film.checkpoint))
            }
            Err(Stop::Cancelled) => {
                film.flush()?;
                let kept = closed(film.checkpoint)?;
                Err(RenderError::Interrupted {
                    finished,
                    pixels: area,
                    checkpoint: options.checkpoint.clone().filter(|_| kept),
                })
            }
            Err(Stop::Failed(error)) => {
                // Report the first error, and ignore one of closing.
                let _ = closed(film.checkpoint);
                Err(error)
            }
        }
    }

    fn tile(&self, number: u64, workers: &Workers<'_>) -> Result<(), Stop> {
        let crop = self.request.crop;
        let mut tile = Tile::new(self.tiles.rectangle(number));
        let resumed = |row| {
            self.resumed
                .get(row)
                .is_some_and(|row: &[bool]| row.iter().all(|&r| r))
        };
        if tiles::rows(&tile, crop).all(resumed) {
            return Ok(());
        }
        go_on(workers)?;
        let start = Instant::now();
        let places: Vec<[u32; 2]> = tiles::pixels(self.tiles.rectangle(number)).collect();
        if self.pixels.splits() {
            for &place in &places {
                let totals = self
                    .pixels
                    .at(place)
                    .trace_in_parts(place, workers, &self.parts())?;
                self.finish(&mut tile, place, &totals)?;
            }
        } else {
            let mut totals = vec![None; places.len()];
            let kept = self.parts();
            let traced = self
                .pixels
                .trace_group(&places, &mut totals, workers, &kept);
            let of_pixels = || {
                let all = places.iter().zip(&totals);
                all.filter_map(|(&place, totals)| Some((place, totals.as_ref()?)))
            };
            let finished = traced.and_then(|()| {
                of_pixels().try_for_each(|(place, totals)| {
                    go_on(workers)?;
                    self.finish(&mut tile, place, totals)
                })
            });
            if let Err(stop) = finished {
                // Keep the pixels that are traced but not counted yet, so that a resumed render
                // does not trace them again.
                let part = |(place, totals)| self.pixels.at(place).whole(place, totals);
                kept.keeper().keep_parts(of_pixels().map(part))?;
                return Err(stop);
            }
        }
        let mut film = self.film.lock().unwrap_or_else(PoisonError::into_inner);
        film.keep_tile(&tile, start.elapsed())?;
        Ok(())
    }

    /// Returns the place where parts of pixels are kept.
    fn parts(&self) -> Parts<'_> {
        Parts {
            before: Some(&self.kept),
            film: (self.request.options.checkpoint.as_ref()).map(|_| &self.film),
        }
    }

    /// Adds a pixel to its tile.
    fn finish(&self, tile: &mut Tile, place: [u32; 2], totals: &Totals) -> Result<(), Stop> {
        let workers = &self.request.options.workers;
        let pixel = self.pixels.at(place).finish(place, totals, workers)?;
        tile.pixels.push(pixel.colour);
        tile.counted.push(&pixel.counted);
        Ok(())
    }
}

/// Closes the checkpoint, and returns whether a later render can continue from it.
fn closed(checkpoint: Option<Checkpoint>) -> Result<bool, CheckpointError> {
    checkpoint.map_or(Ok(false), Checkpoint::close)
}

/// Creates the checkpoint's header: all options that decide a pixel's value, and the rendered
/// pixels.
pub(super) fn header(request: &Request<'_>) -> Header {
    let Request { scene, options, .. } = *request;
    let decisive = [
        ("model", options.model().name().to_owned()),
        ("estimator", options.estimator_name(request.estimator)),
        ("colour", options.colour.name().to_owned()),
        ("noise", options.noise.to_string()),
        ("version", env!("CARGO_PKG_VERSION").to_owned()),
        ("build", crate::BUILD.to_owned()),
    ];
    let decisive = decisive.map(|(key, value)| (key.to_owned(), value));
    Header {
        scene_hash: scene.fingerprint().to_string(),
        seed: options.seed,
        options: (decisive.into_iter())
            .chain(options.primary_hits().entries())
            .chain(request.part.clone())
            .collect(),
        width: scene.scene().film.width,
        height: scene.scene().film.height,
        crop: request.crop,
    }
}
