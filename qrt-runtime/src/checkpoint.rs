//! What an interrupted render has finished, so that it can go on.
//!
//! A checkpoint is a file that only grows: a header that says which render it belongs to, then one
//! record for each finished tile, in the order they were finished. Every part ends in a CRC-32. A
//! write that was torn (the process killed, the disk full) leaves a last record that is short or
//! fails its sum: it is dropped, and the file is cut back to the tiles that are whole.

mod error;
mod format;
#[cfg(test)]
mod tests;

pub use error::{CheckpointError, Difference};

use format::MAGIC;
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Which render a checkpoint belongs to: whatever decides a pixel's value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Header {
    /// A hash of the scene and of every file it refers to.
    pub scene_hash: String,
    /// What keys its shifts and draws.
    pub seed: u64,
    /// Names and values of everything else that decides a pixel: model, estimator, version.
    pub options: BTreeMap<String, String>,
    /// The film, in pixels.
    pub width: u32,
    /// The film, in pixels.
    pub height: u32,
    /// x, y, width and height of the part that is rendered.
    pub crop: [u32; 4],
}

/// A finished rectangle of the film.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    /// Leftmost column, counted on the film.
    pub x: u32,
    /// Topmost row, counted on the film.
    pub y: u32,
    /// Columns, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
    /// Linear RGB, row by row.
    pub pixels: Vec<[f64; 3]>,
    /// Oracle queries that each pixel used.
    pub queries: Vec<u64>,
    /// Good indices of each pixel's channels; 0 where none are counted.
    pub good: Vec<[u64; 3]>,
    /// Strata in which each pixel's channels were counted; 0 where nothing is.
    pub strata: Vec<[u8; 3]>,
}

impl Tile {
    /// A tile without pixels yet: its x, y, width and height on the film.
    pub(crate) fn of([x, y, width, height]: [u32; 4]) -> Self {
        Self {
            x,
            y,
            width,
            height,
            pixels: Vec::new(),
            queries: Vec::new(),
            good: Vec::new(),
            strata: Vec::new(),
        }
    }
}

/// An open checkpoint, locked against other processes.
///
/// ```
/// use qrt_runtime::checkpoint::{Checkpoint, Header, Tile};
/// let path = std::env::temp_dir().join(format!("qrt-doc-{}.tiles", std::process::id()));
/// let header = Header {
///     scene_hash: "9f86d081".into(),
///     seed: 1,
///     options: [("model".into(), "real".into())].into(),
///     width: 2,
///     height: 1,
///     crop: [0, 0, 2, 1],
/// };
/// let (pixels, queries) = (vec![[0.5; 3]], vec![4096]);
/// let (good, strata) = (vec![[512; 3]], vec![[1; 3]]);
/// let tile = Tile { x: 1, y: 0, width: 1, height: 1, pixels, queries, good, strata };
/// Checkpoint::create(&path, &header)?.append(&tile)?;
/// let (_, finished) = Checkpoint::open(&path, &header)?;
/// assert_eq!(finished, [tile]);
/// # std::fs::remove_file(path).ok();
/// # Ok::<(), qrt_runtime::checkpoint::CheckpointError>(())
/// ```
#[derive(Debug)]
pub struct Checkpoint {
    file: File,
    path: PathBuf,
    crop: [u32; 4],
    /// Where the last whole record ends.
    end: u64,
}

impl Checkpoint {
    /// Starts a checkpoint without tiles, in place of any that was there.
    ///
    /// # Errors
    /// If the file can't be written, another process has it open, or it is not a checkpoint: no
    /// other file is overwritten.
    pub fn create(path: &Path, header: &Header) -> Result<Self, CheckpointError> {
        let mut checkpoint = Self::lock(path, header, true)?;
        let mut start = Vec::new();
        let read = (&checkpoint.file)
            .take(MAGIC.len() as u64)
            .read_to_end(&mut start);
        checkpoint.io(read)?;
        if !MAGIC.starts_with(&start) {
            return Err(CheckpointError::Foreign {
                path: path.to_path_buf(),
            });
        }
        checkpoint.restart(header)?;
        Ok(checkpoint)
    }

    /// Opens a checkpoint to go on from, and reads its finished tiles in the order they were
    /// appended. Whatever follows the last whole tile is cut off.
    ///
    /// # Errors
    /// If there is none, it belongs to another render (the error says in what they differ), another
    /// process has it open, or it is not a checkpoint.
    pub fn open(path: &Path, header: &Header) -> Result<(Self, Vec<Tile>), CheckpointError> {
        let mut checkpoint = Self::lock(path, header, false)?;
        let mut bytes = Vec::new();
        let read = checkpoint.file.read_to_end(&mut bytes);
        checkpoint.io(read)?;
        let expected = header.encode();
        if bytes.len() < expected.len() && expected.starts_with(&bytes) {
            // Killed while it was created.
            checkpoint.restart(header)?;
            return Ok((checkpoint, Vec::new()));
        }
        let mut rest = bytes.as_slice();
        let found = Header::decode(&mut rest, path)?;
        let differences = found.differences(header);
        if !differences.is_empty() {
            return Err(CheckpointError::Differs {
                path: path.to_path_buf(),
                differences,
            });
        }
        let mut tiles = Vec::new();
        let mut whole = bytes.len() - rest.len();
        while let Some(tile) = Tile::decode(&mut rest, header.crop) {
            tiles.push(tile);
            whole = bytes.len() - rest.len();
        }
        let cut = checkpoint.file.set_len(whole as u64);
        checkpoint.io(cut)?;
        let end = checkpoint.file.seek(SeekFrom::End(0));
        checkpoint.end = checkpoint.io(end)?;
        Ok((checkpoint, tiles))
    }

    /// Adds a finished tile.
    ///
    /// # Errors
    /// If the tile does not lie in the crop or its vectors don't fill it, or if it can't be
    /// written.
    pub fn append(&mut self, tile: &Tile) -> Result<(), CheckpointError> {
        let area = tile.area_within(self.crop);
        let lengths = [
            tile.pixels.len(),
            tile.queries.len(),
            tile.good.len(),
            tile.strata.len(),
        ];
        if lengths.iter().any(|&length| area != Some(length as u64)) {
            let &Tile {
                x,
                y,
                width,
                height,
                ..
            } = tile;
            return Err(CheckpointError::Tile {
                x,
                y,
                width,
                height,
            });
        }
        let record = tile.encode();
        // One write, so that a kill between two of them tears nothing; and when the disk is full,
        // no torn record stands before those that may follow.
        let write = self.file.write_all(&record).or_else(|e| {
            self.file.set_len(self.end)?;
            self.file.seek(SeekFrom::Start(self.end))?;
            Err(e)
        });
        self.io(write)?;
        self.end += record.len() as u64;
        Ok(())
    }

    fn lock(path: &Path, header: &Header, create: bool) -> Result<Self, CheckpointError> {
        let options = OpenOptions::new()
            .read(true)
            .write(true)
            .create(create)
            .truncate(false)
            .open(path);
        let io = |source| CheckpointError::Io {
            path: path.to_path_buf(),
            source,
        };
        let file = options.map_err(io)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(CheckpointError::InUse {
                    path: path.to_path_buf(),
                });
            }
            // Some network file systems have no locks.
            Err(TryLockError::Error(e)) if e.kind() == io::ErrorKind::Unsupported => {}
            Err(TryLockError::Error(e)) => return Err(io(e)),
        }
        Ok(Self {
            file,
            path: path.to_path_buf(),
            crop: header.crop,
            end: 0,
        })
    }

    fn restart(&mut self, header: &Header) -> Result<(), CheckpointError> {
        let bytes = header.encode();
        let done = self
            .file
            .set_len(0)
            .and_then(|()| self.file.rewind())
            .and_then(|()| self.file.write_all(&bytes));
        self.end = bytes.len() as u64;
        self.io(done)
    }

    fn io<T>(&self, result: io::Result<T>) -> Result<T, CheckpointError> {
        result.map_err(|source| CheckpointError::Io {
            path: self.path.clone(),
            source,
        })
    }
}
