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

/// Keeps parts while they are traced.
pub(super) struct Keeper<'a> {
    film: Option<&'a Mutex<Film>>,
    kept: Instant,
}

impl<'a> Parts<'a> {
    /// How many paths of a part were traced before, and what they add up to.
    pub(super) fn before(&self, pixel: [u32; 2], number: u64) -> Option<(u64, &'a [u64])> {
        let part = self.before?.get(&(pixel, number))?;
        Some((part.paths, &part.totals))
    }

    pub(super) fn keeper(&self) -> Keeper<'a> {
        Keeper {
            film: self.film,
            kept: Instant::now(),
        }
    }
}

impl Keeper<'_> {
    /// Whether as much would be lost as may be.
    pub(super) fn is_due(&self) -> bool {
        self.kept.elapsed() >= AT_STAKE
    }

    /// Keeps these parts, or what is traced of them.
    pub(super) fn keep(
        &mut self,
        parts: impl IntoIterator<Item = Part>,
    ) -> Result<(), RenderError> {
        self.kept = Instant::now();
        let Some(film) = self.film else {
            return Ok(());
        };
        let mut film = film.lock().unwrap_or_else(PoisonError::into_inner);
        film.keep_parts(parts)
    }
}
