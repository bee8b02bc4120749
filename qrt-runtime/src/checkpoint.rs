//! A file of the finished tiles of an interrupted render, from which the render can continue.
//!
//! A checkpoint is an append-only file: a header that identifies the render, then one record for
//! each finished tile, in the order in which they were finished. The header and each record end in
//! a CRC-32. A torn write (the process was killed, or the disk is full) leaves a last record that
//! is short or fails its checksum. That record is dropped, and the file is truncated after the last
//! complete record.
//!
//! A pixel with very many paths takes long by itself. Therefore there are also records of its
//! parts: the sums over the first paths of a part. Of the records of one part, the last one is
//! valid; a finished pixel has no valid part records. When most of the file is records that are no
//! longer valid, qrt writes a new file without them beside it and renames it.
//!
//! The file is locked from its first byte until the picture is safe and the file is removed.
//! Therefore two renders never write one checkpoint, and no render removes the checkpoint of
//! another. An appended record reaches the disk within a second or two, so a power cut loses at
//! most that much work.

mod error;
mod format;
#[cfg(test)]
mod tests;

pub use crate::counted_pixels::CountedPixels;
pub use error::{CheckpointDifference, CheckpointError};

use crate::disk::{self, DiskFile};
use crate::replace_file::{remove_abandoned, replaced};
#[cfg(feature = "parts")]
pub(crate) use format::Ending;
use format::MAGIC;
pub(crate) use format::Record;
use std::collections::BTreeMap;
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Number of the file format. It changes with every change of the format.
const VERSION: u32 = 6;
/// Tiles that were finished within this time may wait, to be made durable together.
pub(crate) const AT_STAKE: Duration = Duration::from_secs(1);
/// Least number of bytes of records that are no longer valid for which the file is rewritten.
const MOST_DEAD: u64 = if cfg!(test) { 1 << 12 } else { 1 << 24 };

/// The render that a checkpoint belongs to: everything that decides a pixel's value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Header {
    /// A hash of the scene and of every file it refers to.
    pub scene_hash: String,
    /// Key of the render's shifts and draws.
    pub seed: u64,
    /// Names and values of everything else that decides a pixel: model, estimator, version.
    pub options: BTreeMap<String, String>,
    /// Width of the film, in pixels.
    pub width: u32,
    /// Height of the film, in pixels.
    pub height: u32,
    /// x, y, width and height of the rendered part of the film.
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
    /// The pixels' further figures.
    pub counted: CountedPixels,
}

/// The sums over the first paths of a part of an unfinished pixel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PixelPart {
    /// Column and row on the film.
    pub pixel: [u32; 2],
    /// Number of the part among the parts of the pixel's paths.
    pub number: u64,
    /// Number of the part's paths in the sums.
    pub paths: u64,
    /// The sums; the render defines the meaning of each word.
    pub totals: Vec<u64>,
}

/// A part's pixel and number.
type Place = ([u32; 2], u64);

impl Tile {
    /// Returns whether the tile contains a pixel.
    fn has(&self, [x, y]: [u32; 2]) -> bool {
        let within = |at: u32, first: u32, length: u32| at >= first && at - first < length;
        within(x, self.x, self.width) && within(y, self.y, self.height)
    }

    /// A tile without pixels yet, from its x, y, width and height on the film.
    pub(crate) fn new([x, y, width, height]: [u32; 4]) -> Self {
        Self {
            x,
            y,
            width,
            height,
            pixels: Vec::new(),
            counted: CountedPixels::default(),
        }
    }
}

/// An open checkpoint, locked against other processes.
///
/// ```
/// use qrt_runtime::checkpoint::{Checkpoint, CountedPixels, Header, Tile};
/// let path = std::env::temp_dir().join(format!("qrt-doc-{}.tiles", std::process::id()));
/// let header = Header {
///     scene_hash: "9f86d081".into(),
///     seed: 1,
///     options: [("model".into(), "real".into())].into(),
///     width: 2,
///     height: 1,
///     crop: [0, 0, 2, 1],
/// };
/// let counted = CountedPixels {
///     queries: vec![4096],
///     good: vec![[512; 3]],
///     widths: vec![[0.01; 3]],
///     strata: vec![[1; 3]],
/// };
/// let tile = Tile { x: 1, y: 0, width: 1, height: 1, pixels: vec![[0.5; 3]], counted };
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
    /// The header, while the file still holds the tiles of another render.
    waiting: Option<Vec<u8>>,
    /// End of the header, and end of the last complete record.
    start: u64,
    end: u64,
    /// Byte ranges of the valid records.
    tiles: Vec<Range<u64>>,
    parts: BTreeMap<Place, Range<u64>>,
    /// The parts that the file held when it was opened.
    found: Vec<PixelPart>,
    /// True if an incomplete record may follow the last complete one.
    torn: bool,
    /// Time of the last sync of the whole file.
    synced: Instant,
}

impl Checkpoint {
    /// Starts a checkpoint without tiles. An existing checkpoint is replaced when the first tile is
    /// appended, and not before: work that never begins destroys no finished work.
    ///
    /// # Errors
    /// If the file can't be written, another process has it open, or it is not a checkpoint. The
    /// call overwrites no other file and follows no link.
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
                // The file holds nothing.
                let _ = checkpoint.remove_own();
            }
            begun?;
        } else {
            checkpoint.waiting = Some(header.encode());
        }
        Ok(checkpoint)
    }

    /// Opens a checkpoint to continue from it, and reads its finished tiles in the order in which
    /// they were appended. Everything after the last complete record is cut off.
    ///
    /// # Errors
    /// If there is no checkpoint, it belongs to another render (the error lists the differences),
    /// another process has it open, or the file is not a checkpoint.
    pub fn open(path: &Path, header: &Header) -> Result<(Self, Vec<Tile>), CheckpointError> {
        let mut checkpoint = Self::lock(path, header, false)?;
        let mut bytes = Vec::new();
        let read = checkpoint.file.read_to_end(&mut bytes);
        checkpoint.io(read)?;
        let expected = header.encode();
        if bytes.len() < expected.len() && expected.starts_with(&bytes) {
            // The process was killed while it created the file.
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
        let (mut tiles, mut parts) = (Vec::new(), BTreeMap::new());
        checkpoint.start = (bytes.len() - rest.len()) as u64;
        checkpoint.end = checkpoint.start;
        while let Some(record) = Record::decode(&mut rest, header.crop) {
            let end = (bytes.len() - rest.len()) as u64;
            let range = checkpoint.end..end;
            match record {
                Record::Tile(tile) => {
                    checkpoint.count_tile(&tile, range);
                    tiles.push(tile);
                }
                Record::Part(part) => {
                    checkpoint.parts.insert((part.pixel, part.number), range);
                    parts.insert((part.pixel, part.number), part);
                }
                // An ending belongs to a finished part of a picture, and a checkpoint is not one.
                #[cfg(feature = "parts")]
                Record::Ending(_) => break,
            }
            checkpoint.end = end;
        }
        parts.retain(|place, _| checkpoint.parts.contains_key(place));
        checkpoint.found = parts.into_values().collect();
        let cut = checkpoint.cut_back();
        checkpoint.io(cut)?;
        Ok((checkpoint, tiles))
    }

    /// Adds a finished tile. It is durable within a second, if another tile follows; [`Self::sync`]
    /// makes it durable at once.
    ///
    /// # Errors
    /// If the tile does not lie in the crop or its vectors don't fill it, or if it can't be
    /// written.
    pub fn append(&mut self, tile: &Tile) -> Result<(), CheckpointError> {
        let area = tile.area_within(self.crop);
        let pixels = tile.pixels.len() as u64;
        if area != Some(pixels) || !tile.counted.fill(pixels) {
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
        let from = self.write(&tile.encode())?;
        self.count_tile(tile, from..self.end);
        self.written()
    }

    /// Adds the sums of parts of unfinished pixels, which replace earlier sums of the same parts.
    /// They become durable as tiles do.
    ///
    /// # Errors
    /// If a pixel does not lie in the crop, or if the records can't be written.
    pub(crate) fn append_parts(&mut self, parts: &[PixelPart]) -> Result<(), CheckpointError> {
        let mut records = Vec::new();
        let mut ends = Vec::new();
        for part in parts {
            let [x, y] = part.pixel;
            if Tile::new([x, y, 1, 1]).area_within(self.crop).is_none() {
                let [width, height] = [1, 1];
                return Err(CheckpointError::Tile {
                    x,
                    y,
                    width,
                    height,
                });
            }
            records.extend(part.encode());
            ends.push(records.len() as u64);
        }
        if parts.is_empty() {
            return Ok(());
        }
        let from = self.write(&records)?;
        let mut start = 0;
        for (part, end) in parts.iter().zip(ends) {
            let range = from + start..from + end;
            self.parts.insert((part.pixel, part.number), range);
            start = end;
        }
        self.written()
    }

    /// Takes the parts of unfinished pixels that the file held when it was opened; empty at the
    /// second call.
    pub fn take_parts(&mut self) -> Vec<PixelPart> {
        std::mem::take(&mut self.found)
    }

    /// Makes the appended records durable.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn sync(&mut self) -> Result<(), CheckpointError> {
        let synced = self.file.sync();
        self.io(synced)?;
        self.synced = Instant::now();
        Ok(())
    }

    /// Closes the checkpoint of a render that ends without a picture, and returns whether it has
    /// tiles to continue from. If it has, they are durable. If it has none, the file is removed,
    /// unless it still holds the tiles of another render.
    ///
    /// # Errors
    /// Errors of the file system; [`CheckpointError::Lost`] if the file with the tiles was
    /// replaced. A file that was removed, perhaps with its folder, is written again.
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
            return Ok(true);
        }
        let again = self.make_again();
        if self.io(again)? {
            Ok(true)
        } else {
            Err(CheckpointError::Lost { path: self.path })
        }
    }

    /// Writes the contents of the open file, whose name was removed, under that name again. Returns
    /// false, and writes nothing, if the name belongs to another file.
    fn make_again(&mut self) -> io::Result<bool> {
        if self.path.exists() {
            return Ok(false);
        }
        std::fs::create_dir_all(disk::folder(&self.path))?;
        self.file.rewind()?;
        let held = (&mut self.file).take(self.end);
        self.file = replaced(&self.path, |out| io::copy(&mut { held }, out).map(drop))?;
        Ok(true)
    }

    /// Removes the checkpoint, whose tiles are safe elsewhere. If another file has taken its name,
    /// that file stays.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn remove(self) -> Result<(), CheckpointError> {
        let removed = self.remove_own();
        self.io(removed)
    }

    fn remove_own(&self) -> io::Result<()> {
        // The file is locked, so no process that respects locks can replace it after this check.
        if self.file.has_its_name()? {
            disk::remove(&self.path)?;
        }
        Ok(())
    }

    fn lock(path: &Path, header: &Header, create: bool) -> Result<Self, CheckpointError> {
        let path = path.to_path_buf();
        match disk::open_locked(&path, create) {
            Ok(Some(file)) => {
                // The partial file of a process that was killed while it rewrote the checkpoint.
                remove_abandoned(&path);
                Ok(Self {
                    file,
                    path,
                    crop: header.crop,
                    waiting: None,
                    start: 0,
                    end: 0,
                    tiles: Vec::new(),
                    parts: BTreeMap::new(),
                    found: Vec::new(),
                    torn: false,
                    synced: Instant::now(),
                })
            }
            Ok(None) => Err(CheckpointError::InUse { path }),
            Err(error) if error.kind() == ErrorKind::InvalidInput => {
                Err(CheckpointError::Irregular { path })
            }
            Err(source) => Err(CheckpointError::Io { path, source }),
        }
    }

    /// Truncates the file to a header without records.
    fn restart(&mut self, header: &[u8]) -> Result<(), CheckpointError> {
        let done = (self.file.set_len(0))
            .and_then(|()| self.file.rewind())
            .and_then(|()| self.file.write_all(header))
            .and_then(|()| self.file.sync())
            .and_then(|()| disk::sync_folder(&self.path));
        self.start = header.len() as u64;
        self.end = self.start;
        self.tiles.clear();
        self.parts.clear();
        self.synced = Instant::now();
        self.io(done)
    }

    /// Counts the record of a tile. It invalidates the part records of the tile's pixels.
    fn count_tile(&mut self, tile: &Tile, range: Range<u64>) {
        self.tiles.push(range);
        self.parts.retain(|(pixel, _), _| !tile.has(*pixel));
    }

    /// Writes records after the last complete one, and returns the offset of the first.
    fn write(&mut self, records: &[u8]) -> Result<u64, CheckpointError> {
        if let Some(header) = self.waiting.clone() {
            self.restart(&header)?;
            self.waiting = None;
        }
        let from = self.end;
        let written = self.write_record(records);
        self.io(written)?;
        Ok(from)
    }

    /// Completes a write: rewrites the file if most of it is invalid, and syncs it when that is
    /// due.
    fn written(&mut self) -> Result<(), CheckpointError> {
        let rewritten = self.rewrite_if_dead();
        self.io(rewritten)?;
        if self.synced.elapsed() >= AT_STAKE {
            self.sync()?;
        }
        Ok(())
    }

    /// Rewrites the file without the records that are no longer valid, if they are most of it.
    fn rewrite_if_dead(&mut self) -> io::Result<()> {
        let mut counting: Vec<&mut Range<u64>> = self
            .tiles
            .iter_mut()
            .chain(self.parts.values_mut())
            .collect();
        let lengths = counting.iter().map(|range| range.end - range.start);
        let live: u64 = self.start + lengths.sum::<u64>();
        // A file that lost its name must not replace another file under that name.
        if self.end - live < live.max(MOST_DEAD) || !self.file.has_its_name()? {
            return Ok(());
        }
        counting.sort_unstable_by_key(|range| range.start);
        let (file, header) = (&mut self.file, 0..self.start);
        let rewritten = replaced(&self.path, |out| {
            let ranges = std::iter::once(&header).chain(counting.iter().map(|range| &**range));
            for range in ranges {
                file.seek(SeekFrom::Start(range.start))?;
                let length = range.end - range.start;
                if io::copy(&mut Read::by_ref(file).take(length), out)? != length {
                    return Err(io::Error::from(ErrorKind::UnexpectedEof));
                }
            }
            Ok(())
        });
        match rewritten {
            Ok(rewritten) => self.file = rewritten,
            Err(error) => {
                self.file.seek(SeekFrom::Start(self.end))?;
                return Err(error);
            }
        }
        self.end = self.start;
        for range in counting {
            let start = self.end;
            self.end += range.end - range.start;
            *range = start..self.end;
        }
        self.synced = Instant::now();
        Ok(())
    }

    /// Writes a record with a single call, so that a kill between two calls tears nothing.
    fn write_record(&mut self, record: &[u8]) -> io::Result<()> {
        if self.torn {
            self.cut_back()?;
        }
        self.torn = true;
        if let Err(error) = self.file.write_all(record) {
            // When the disk is full, no torn record may stand before later records.
            let _ = self.cut_back();
            return Err(error);
        }
        self.torn = false;
        self.end += record.len() as u64;
        Ok(())
    }

    /// Cuts off everything after the last complete record.
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
