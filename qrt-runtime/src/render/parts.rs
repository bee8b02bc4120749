//! Pixels of very many paths, which are kept before they are finished.

use super::RenderError;
use super::film::Film;
use crate::checkpoint::{AT_STAKE, Part};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// Parts of pixels, by pixel and number.
pub(super) type Kept = BTreeMap<([u32; 2], u64), Part>;

/// What a checkpoint has of the parts of unfinished pixels, and where they are kept from now on.
#[derive(Clone, Copy, Default)]
pub(super) struct Parts<'a> {
    pub(super) before: Option<&'a Kept>,
    /// Of a picture without a checkpoint, none.
    pub(super) film: Option<&'a Mutex<Film>>,
}

/// Keeps one part while it is traced.
pub(super) struct Keeper<'a> {
    film: Option<&'a Mutex<Film>>,
    pixel: [u32; 2],
    number: u64,
    kept: Instant,
}

impl<'a> Parts<'a> {
    /// How many paths of a part were traced before, and what they add up to.
    pub(super) fn before(&self, pixel: [u32; 2], number: u64) -> Option<(u64, &'a [u64])> {
        let part = self.before?.get(&(pixel, number))?;
        Some((part.paths, &part.totals))
    }

    pub(super) fn keeper(&self, pixel: [u32; 2], number: u64) -> Keeper<'a> {
        Keeper {
            film: self.film,
            pixel,
            number,
            kept: Instant::now(),
        }
    }
}

impl Keeper<'_> {
    /// After a run of paths: so many of the part are traced, perhaps all, and add up to `totals`.
    pub(super) fn traced(
        &mut self,
        paths: u64,
        all: bool,
        totals: impl FnOnce() -> Vec<u64>,
    ) -> Result<(), RenderError> {
        if all || self.kept.elapsed() >= AT_STAKE {
            self.interrupted(paths, totals)?;
        }
        Ok(())
    }

    /// So many paths are traced, and no more for now.
    pub(super) fn interrupted(
        &mut self,
        paths: u64,
        totals: impl FnOnce() -> Vec<u64>,
    ) -> Result<(), RenderError> {
        let Some(film) = self.film.filter(|_| paths > 0) else {
            return Ok(());
        };
        self.kept = Instant::now();
        let part = Part {
            pixel: self.pixel,
            number: self.number,
            paths,
            totals: totals(),
        };
        let mut film = film.lock().unwrap_or_else(PoisonError::into_inner);
        film.keep_part(part)
    }
}
