//! What an interrupted render has finished, so that it can go on.
//!
//! A checkpoint is a file that only grows: a header that says which render it belongs to, then one
//! record for each finished tile, in the order they were finished. Every part ends in a CRC-32. A
//! write that was torn (the process killed, the disk full) leaves a last record that is short or
//! fails its sum: it is dropped, and the file is cut back to the tiles that are whole.
//!
//! The file is locked from its first byte until the picture is safe and the file is removed, so that
//! two renders never write one checkpoint, and none removes another's. What is appended reaches the
//! disk itself within a second or two: that much a power cut may take.

mod error;
mod format;
#[cfg(test)]
mod tests;

pub use error::{CheckpointError, Difference};

use crate::disk::{self, DiskFile, Lock};
use format::MAGIC;
use std::collections::BTreeMap;
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Tiles that were finished in less may wait together to be made durable.
pub(crate) const AT_STAKE: Duration = Duration::from_secs(1);
/// How often the file of a name is opened that changes meanwhile.
const ATTEMPTS: u32 = 64;

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
    file: DiskFile,
    path: PathBuf,
    crop: [u32; 4],
    /// The header, while the file still holds another render's tiles.
    waiting: Option<Vec<u8>>,
    /// Where the header ends, and the last whole record.
    start: u64,
    end: u64,
    /// Whether a record that failed may stand behind it.
    torn: bool,
    /// When all of it was last made durable.
    synced: Instant,
}

impl Checkpoint {
    /// Starts a checkpoint without tiles. One that is there is replaced when the first tile is
    /// appended, and not before: work that never begins costs no finished work.
    ///
    /// # Errors
    /// If the file can't be written, another process has it open, or it is not a checkpoint: no
    /// other file is overwritten, and no link followed.
    pub fn create(path: &Path, header: &Header) -> Result<Self, CheckpointError> {
        let mut checkpoint = Self::lock(path, header, true)?;
        let mut start = Vec::new();
        let read = (&mut checkpoint.file)
            .take(MAGIC.len() as u64)
            .read_to_end(&mut start);
        checkpoint.io(read)?;
        if !MAGIC.starts_with(&start) {
            return Err(CheckpointError::Foreign {
                path: path.to_path_buf(),
            });
        }
        if start.is_empty() {
            let begun = checkpoint.restart(&header.encode());
            if begun.is_err() {
                // It holds nothing.
                let _ = checkpoint.remove_own();
            }
            begun?;
        } else {
            checkpoint.waiting = Some(header.encode());
        }
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
            checkpoint.restart(&expected)?;
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
        checkpoint.start = whole as u64;
        while let Some(tile) = Tile::decode(&mut rest, header.crop) {
            tiles.push(tile);
            whole = bytes.len() - rest.len();
        }
        checkpoint.end = whole as u64;
        let cut = checkpoint.cut_back();
        checkpoint.io(cut)?;
        Ok((checkpoint, tiles))
    }

    /// Adds a finished tile. It is durable within a second, if another follows; [`Self::sync`] makes
    /// it so at once.
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
        if let Some(header) = self.waiting.clone() {
            self.restart(&header)?;
            self.waiting = None;
        }
        let record = tile.encode();
        let written = self.write_record(&record);
        self.io(written)?;
        if self.synced.elapsed() >= AT_STAKE {
            self.sync()?;
        }
        Ok(())
    }

    /// Makes durable what was appended.
    ///
    /// # Errors
    /// What the file system says.
    pub fn sync(&mut self) -> Result<(), CheckpointError> {
        let synced = self.file.sync();
        self.io(synced)?;
        self.synced = Instant::now();
        Ok(())
    }

    /// Closes the checkpoint of a render that ends without a picture, and returns whether it has
    /// tiles to go on from. Then they are durable; without any, its file is removed, unless it is
    /// another render's that was not replaced yet.
    ///
    /// # Errors
    /// What the file system says; [`CheckpointError::Lost`] if the file with the tiles was removed or
    /// replaced.
    pub fn close(mut self) -> Result<bool, CheckpointError> {
        if self.waiting.is_some() {
            return Ok(false);
        }
        if self.end == self.start {
            let removed = self.remove_own();
            self.io(removed)?;
            return Ok(false);
        }
        self.sync()?;
        let there = self.file.has_its_name();
        if self.io(there)? {
            Ok(true)
        } else {
            Err(CheckpointError::Lost { path: self.path })
        }
    }

    /// Removes the checkpoint, whose tiles are safe elsewhere. A file that has got its name meanwhile
    /// stays.
    ///
    /// # Errors
    /// What the file system says.
    pub fn remove(self) -> Result<(), CheckpointError> {
        let removed = self.remove_own();
        self.io(removed)
    }

    fn remove_own(&self) -> io::Result<()> {
        // It is locked: nobody else who keeps to locks can put another in its place.
        if self.file.has_its_name()? {
            disk::remove(&self.path)?;
        }
        Ok(())
    }

    fn lock(path: &Path, header: &Header, create: bool) -> Result<Self, CheckpointError> {
        let io = |source: io::Error| CheckpointError::Io {
            path: path.to_path_buf(),
            source,
        };
        for _ in 0..ATTEMPTS {
            let file = match disk::open(path, true) {
                Err(error) if create && error.kind() == ErrorKind::NotFound => {
                    disk::create_new(path)
                }
                opened => opened,
            };
            let file = match file {
                Ok(file) => file,
                // It was made or removed meanwhile.
                Err(error) if create && error.kind() == ErrorKind::NotFound && in_folder(path) => {
                    continue;
                }
                Err(error) if error.kind() == ErrorKind::AlreadyExists => continue,
                Err(error) if error.kind() == ErrorKind::InvalidInput => {
                    return Err(CheckpointError::Irregular {
                        path: path.to_path_buf(),
                    });
                }
                Err(error) => return Err(io(error)),
            };
            if file.try_lock().map_err(io)? == Lock::Others {
                break;
            }
            // It may have been finished with, and removed, before it was locked.
            if file.has_its_name().map_err(io)? {
                return Ok(Self {
                    file,
                    path: path.to_path_buf(),
                    crop: header.crop,
                    waiting: None,
                    start: 0,
                    end: 0,
                    torn: false,
                    synced: Instant::now(),
                });
            }
        }
        Err(CheckpointError::InUse {
            path: path.to_path_buf(),
        })
    }

    /// Makes it a checkpoint of nothing but a header.
    fn restart(&mut self, header: &[u8]) -> Result<(), CheckpointError> {
        let done = (self.file.set_len(0))
            .and_then(|()| self.file.rewind())
            .and_then(|()| self.file.write_all(header))
            .and_then(|()| self.file.sync())
            .and_then(|()| disk::sync_folder(&self.path));
        self.start = header.len() as u64;
        self.end = self.start;
        self.synced = Instant::now();
        self.io(done)
    }

    /// One write, so that a kill between two of them tears nothing.
    fn write_record(&mut self, record: &[u8]) -> io::Result<()> {
        if self.torn {
            self.cut_back()?;
        }
        self.torn = true;
        if let Err(error) = self.file.write_all(record) {
            // When the disk is full, no torn record stands before those that may follow.
            let _ = self.cut_back();
            return Err(error);
        }
        self.torn = false;
        self.end += record.len() as u64;
        Ok(())
    }

    /// Cuts off what follows the last whole record.
    fn cut_back(&mut self) -> io::Result<()> {
        self.file.set_len(self.end)?;
        self.file.seek(SeekFrom::Start(self.end))?;
        self.torn = false;
        Ok(())
    }

    fn io<T>(&self, result: io::Result<T>) -> Result<T, CheckpointError> {
        result.map_err(|source| CheckpointError::Io {
            path: self.path.clone(),
            source,
        })
    }
}

/// Whether the folder of `path` is there.
fn in_folder(path: &Path) -> bool {
    disk::folder(path).is_dir()
}
