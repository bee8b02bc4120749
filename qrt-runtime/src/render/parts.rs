//! Parts of pixels of very many paths, which are kept before the pixels are finished.

use super::RenderError;
use super::film::{Film, Kept};
use crate::checkpoint::{AT_STAKE, PixelPart};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// The checkpoint's parts of unfinished pixels, and the film that keeps new parts.
#[derive(Clone, Copy, Default)]
pub(super) struct Parts<'a> {
    pub(super) before: Option<&'a Kept>,
    /// The film, or `None` for a picture without a checkpoint.
    pub(super) film: Option<&'a Mutex<Film>>,
}

/// Keeps parts while they are traced.
pub(super) struct Keeper<'a> {
    film: Option<&'a Mutex<Film>>,
    kept: Instant,
}

impl<'a> Parts<'a> {
    /// Returns the number of a part's paths that were traced before, and their totals.
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
    /// Returns whether [`AT_STAKE`] has passed since parts were last kept.
    pub(super) fn is_due(&self) -> bool {
        self.kept.elapsed() >= AT_STAKE
    }

    /// Keeps `parts`; a part may have only the paths traced so far.
    pub(super) fn keep_parts(
        &mut self,
        parts: impl IntoIterator<Item = PixelPart>,
    ) -> Result<(), RenderError> {
        self.kept = Instant::now();
        let Some(film) = self.film else {
            return Ok(());
        };
        let mut film = film.lock().unwrap_or_else(PoisonError::into_inner);
        film.keep_parts(parts)
    }
}
