//! The finished pixels of a picture, and the checkpoint that keeps them.

use super::tiles::{pixels, rows};
use super::{RenderError, RenderOptions};
use crate::checkpoint::{AT_STAKE, Checkpoint, CheckpointError, Header, PixelPart, Tile};
use crate::counted_pixels::{CountedPixels, filled};
use crate::image::{CropWindow, Image};
use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::Path;
use std::time::{Duration, Instant};

/// Parts of pixels, by pixel and number.
pub(super) type Kept = BTreeMap<([u32; 2], u64), PixelPart>;

/// The finished pixels of a picture, with its checkpoint.
pub(super) struct Film {
    crop: [u32; 4],
    pub(super) image: Image,
    pub(super) counted: CountedPixels,
    /// Number of finished pixels.
    pub(super) finished: u64,
    pub(super) checkpoint: Option<Checkpoint>,
    /// Parts of unfinished pixels that are not in the checkpoint yet, and the time of the last
    /// flush.
    pending: Vec<PixelPart>,
    flushed: Instant,
}

impl Film {
    /// Creates an empty picture of the part `crop` (x, y, width, height) of a film of `film`
    /// columns and rows.
    pub(super) fn new(crop: [u32; 4], film: [u32; 2]) -> Result<Self, RenderError> {
        let pixels = u64::from(crop[2]) * u64::from(crop[3]);
        let memory = || RenderError::Memory { pixels };
        let area = usize::try_from(pixels).map_err(|_| memory())?;
        let window = CropWindow {
            origin: [crop[0], crop[1]],
            film,
        };
        Ok(Self {
            crop,
            image: Image {
                width: crop[2],
                height: crop[3],
                pixels: filled([0.0; 3], area).map_err(|_| memory())?,
                window: (film != [crop[2], crop[3]]).then_some(window),
            },
            counted: CountedPixels::zeros(area).map_err(|_| memory())?,
            finished: 0,
            checkpoint: None,
            pending: Vec::new(),
            flushed: Instant::now(),
        })
    }

    /// Opens the checkpoint. Returns for each pixel whether the checkpoint has it, and the parts of
    /// other pixels. The list of pixels is empty if the checkpoint has none, or if there is no
    /// checkpoint.
    pub(super) fn open(
        &mut self,
        options: &RenderOptions<'_>,
        header: impl FnOnce() -> Header,
    ) -> Result<(Vec<bool>, Kept), RenderError> {
        let (mut finished, mut kept) = (Vec::new(), Kept::new());
        let Some(path) = &options.checkpoint else {
            return Ok((finished, kept));
        };
        let header = header();
        let there = if options.resume {
            there(path, &header)?
        } else {
            None
        };
        if let Some((mut checkpoint, tiles)) = there {
            let parts = checkpoint.take_parts().into_iter();
            kept.extend(parts.map(|part| ((part.pixel, part.number), part)));
            if !tiles.is_empty() {
                finished.resize(self.image.pixels.len(), false);
            }
            for tile in &tiles {
                self.paint(tile);
                for row in rows(tile, self.crop) {
                    finished[row].fill(true);
                }
            }
            self.finished = finished.iter().filter(|&&f| f).count() as u64;
            self.checkpoint = Some(checkpoint);
        } else {
            self.checkpoint = Some(Checkpoint::create(path, &header)?);
        }
        Ok((finished, kept))
    }

    /// Adds the totals of parts of unfinished pixels.
    pub(super) fn keep_parts(
        &mut self,
        parts: impl IntoIterator<Item = PixelPart>,
    ) -> Result<(), RenderError> {
        self.pending.extend(parts);
        // Parts arrive every `AT_STAKE`. Half of it here, so that parts which arrive a little early
        // are not held for another interval.
        if self.flushed.elapsed() >= AT_STAKE / 2 {
            self.flush()?;
        }
        Ok(())
    }

    /// Appends the pending parts to the checkpoint.
    pub(super) fn flush(&mut self) -> Result<(), CheckpointError> {
        let pending = std::mem::take(&mut self.pending);
        if let Some(checkpoint) = &mut self.checkpoint {
            checkpoint.append_parts(&pending)?;
        }
        self.flushed = Instant::now();
        Ok(())
    }

    /// Adds a tile that took the time `took`, after writing it to the checkpoint.
    pub(super) fn keep_tile(&mut self, tile: &Tile, took: Duration) -> Result<(), RenderError> {
        if let Some(checkpoint) = &mut self.checkpoint {
            checkpoint.append(tile)?;
            // The next tile may take as long, so this one must not wait for it to become durable.
            if took >= AT_STAKE {
                checkpoint.sync()?;
            }
        }
        if !self.pending.is_empty() {
            let finished: Vec<[u32; 2]> =
                pixels([tile.x, tile.y, tile.width, tile.height]).collect();
            self.pending.retain(|part| !finished.contains(&part.pixel));
        }
        self.paint(tile);
        self.finished += tile.pixels.len() as u64;
        Ok(())
    }

    /// Copies a tile's pixels into the picture.
    pub(super) fn paint(&mut self, tile: &Tile) {
        let width = tile.width as usize;
        for (number, row) in rows(tile, self.crop).enumerate() {
            let own = number * width..(number + 1) * width;
            self.image.pixels[row.clone()].copy_from_slice(&tile.pixels[own.clone()]);
            self.counted.replace(row, &tile.counted, own);
        }
    }
}

/// Opens the checkpoint at `path`, if there is one.
fn there(path: &Path, header: &Header) -> Result<Option<(Checkpoint, Vec<Tile>)>, CheckpointError> {
    match Checkpoint::open(path, header) {
        Err(CheckpointError::Io { source, .. }) if source.kind() == ErrorKind::NotFound => Ok(None),
        opened => opened.map(Some),
    }
}
