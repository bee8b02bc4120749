//! What an interrupted render has finished, so that it can go on.
//!
//! A checkpoint is a file that only grows: a header that says which render it belongs to, then one
//! record for each finished tile, in the order they were finished. Every part ends in a CRC-32. A
//! write that was torn (the process killed, the disk full) leaves a last record that is short or
//! fails its sum: it is dropped, and the file is cut back to the tiles that are whole.
//!
//! Layout, all numbers little-endian, floats as their bits:
//!
//! ```text
//! header  "QRTTILES", u32 version, u32 length of the body, body, u32 CRC-32 of all before
//! body    width, height, crop x, y, width, height (u32 each), u64 seed, scene hash, u32 count of
//!         options, and for each its name and value; texts as u32 length and UTF-8
//! record  x, y, width, height (u32 each), pixels (3 f64 each, rows from the top),
//!         queries (u64 each), u32 CRC-32 of all before
//! ```

use std::fmt;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

const MAGIC: &[u8; 8] = b"QRTTILES";
const VERSION: u32 = 1;
/// Bytes of a tile's record beside its pixels, and for each pixel.
const RECORD: u64 = 20;
const PIXEL: u64 = 32;

/// Which render a checkpoint belongs to: whatever decides a pixel's value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Header {
    /// A hash of the scene and of every file it refers to.
    pub scene_hash: String,
    /// The seed.
    pub seed: u64,
    /// Names and values of everything else that decides a pixel: model, estimator, version.
    pub options: Vec<(String, String)>,
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
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Linear RGB, row by row.
    pub pixels: Vec<[f64; 3]>,
    /// Oracle queries spent on each pixel.
    pub queries: Vec<u64>,
}

/// An open checkpoint, locked against other processes.
///
/// ```
/// use qrt_runtime::checkpoint::{Checkpoint, Header, Tile};
/// let path = std::env::temp_dir().join(format!("qrt-doc-{}.tiles", std::process::id()));
/// let header = Header {
///     scene_hash: "9f86d081".into(),
///     seed: 1,
///     options: vec![("model".into(), "real".into())],
///     width: 2,
///     height: 1,
///     crop: [0, 0, 2, 1],
/// };
/// let (pixels, queries) = (vec![[0.5; 3]], vec![4096]);
/// let tile = Tile { x: 1, y: 0, width: 1, height: 1, pixels, queries };
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
        checkpoint.io(end)?;
        Ok((checkpoint, tiles))
    }

    /// Adds a finished tile.
    ///
    /// # Errors
    /// If the tile does not lie in the crop or its vectors don't fill it, or if it can't be written.
    pub fn append(&mut self, tile: &Tile) -> Result<(), CheckpointError> {
        let area = tile.area_within(self.crop);
        if area != Some(tile.pixels.len() as u64) || area != Some(tile.queries.len() as u64) {
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
        // One write, so that a kill between two of them tears nothing.
        let write = self.file.write_all(&tile.encode());
        self.io(write)
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
        })
    }

    fn restart(&mut self, header: &Header) -> Result<(), CheckpointError> {
        let done = self
            .file
            .set_len(0)
            .and_then(|()| self.file.rewind())
            .and_then(|()| self.file.write_all(&header.encode()));
        self.io(done)
    }

    fn io<T>(&self, result: io::Result<T>) -> Result<T, CheckpointError> {
        result.map_err(|source| CheckpointError::Io {
            path: self.path.clone(),
            source,
        })
    }
}

impl Header {
    fn encode(&self) -> Vec<u8> {
        let mut body = Vec::new();
        for number in [self.width, self.height].iter().chain(&self.crop) {
            body.extend(number.to_le_bytes());
        }
        body.extend(self.seed.to_le_bytes());
        put_text(&mut body, &self.scene_hash);
        body.extend((self.options.len() as u32).to_le_bytes());
        for (name, value) in &self.options {
            put_text(&mut body, name);
            put_text(&mut body, value);
        }
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend((body.len() as u32).to_le_bytes());
        bytes.extend(body);
        seal(bytes)
    }

    /// Takes a header off `bytes`.
    fn decode(bytes: &mut &[u8], path: &Path) -> Result<Self, CheckpointError> {
        let foreign = || CheckpointError::Foreign {
            path: path.to_path_buf(),
        };
        let damaged = || CheckpointError::Damaged {
            path: path.to_path_buf(),
        };
        let all = *bytes;
        if take(bytes, MAGIC.len() as u64) != Some(MAGIC) {
            return Err(foreign());
        }
        let version = take_u32(bytes).ok_or_else(damaged)?;
        if version != VERSION {
            return Err(CheckpointError::Version {
                path: path.to_path_buf(),
                version,
            });
        }
        let length = take_u32(bytes).ok_or_else(damaged)?;
        let mut body = take(bytes, length.into()).ok_or_else(damaged)?;
        take_seal(bytes, all).ok_or_else(damaged)?;
        let body = &mut body;
        let mut read = || {
            let [width, height] = [take_u32(body)?, take_u32(body)?];
            let crop = [
                take_u32(body)?,
                take_u32(body)?,
                take_u32(body)?,
                take_u32(body)?,
            ];
            let seed = take_u64(body)?;
            let scene_hash = take_text(body)?;
            let mut options = Vec::new();
            for _ in 0..take_u32(body)? {
                options.push((take_text(body)?, take_text(body)?));
            }
            Some(Self {
                scene_hash,
                seed,
                options,
                width,
                height,
                crop,
            })
        };
        read().ok_or_else(damaged)
    }

    fn differences(&self, asked: &Self) -> Vec<Difference> {
        let fields = |h: &Self| {
            let mut fields = vec![
                ("scene".to_owned(), h.scene_hash.clone()),
                ("seed".to_owned(), h.seed.to_string()),
                ("film".to_owned(), format!("{} x {}", h.width, h.height)),
                ("crop".to_owned(), h.crop.map(|v| v.to_string()).join(",")),
            ];
            fields.extend(h.options.iter().cloned());
            fields
        };
        let (found, asked) = (fields(self), fields(asked));
        let value = |of: &[(String, String)], name: &str| {
            of.iter()
                .find(|(n, _)| n == name)
                .map(|(_, value)| value.clone())
        };
        let mut names: Vec<&String> = found.iter().chain(&asked).map(|(name, _)| name).collect();
        let mut seen = std::collections::HashSet::new();
        names.retain(|name| seen.insert(*name));
        names
            .into_iter()
            .map(|name| Difference {
                what: name.clone(),
                found: value(&found, name),
                asked: value(&asked, name),
            })
            .filter(|difference| difference.found != difference.asked)
            .collect()
    }
}

impl Tile {
    /// How many pixels the tile has, if it lies in the crop.
    fn area_within(&self, [x, y, width, height]: [u32; 4]) -> Option<u64> {
        let inside = |at: u32, size: u32, low: u32, room: u32| {
            size > 0
                && at >= low
                && u64::from(at) + u64::from(size) <= u64::from(low) + u64::from(room)
        };
        let inside = inside(self.x, self.width, x, width) && inside(self.y, self.height, y, height);
        inside.then(|| u64::from(self.width) * u64::from(self.height))
    }

    fn encode(&self) -> Vec<u8> {
        let size = RECORD as usize + PIXEL as usize * self.pixels.len();
        let mut bytes = Vec::with_capacity(size);
        for number in [self.x, self.y, self.width, self.height] {
            bytes.extend(number.to_le_bytes());
        }
        for value in self.pixels.iter().flatten() {
            bytes.extend(value.to_bits().to_le_bytes());
        }
        for queries in &self.queries {
            bytes.extend(queries.to_le_bytes());
        }
        seal(bytes)
    }

    /// Takes a tile off `bytes`; `None` at the end, and if it is torn.
    fn decode(bytes: &mut &[u8], crop: [u32; 4]) -> Option<Self> {
        let all = *bytes;
        let [x, y, width, height] = [
            take_u32(bytes)?,
            take_u32(bytes)?,
            take_u32(bytes)?,
            take_u32(bytes)?,
        ];
        let mut tile = Self {
            x,
            y,
            width,
            height,
            pixels: Vec::new(),
            queries: Vec::new(),
        };
        let area = tile.area_within(crop)?;
        let mut payload = take(bytes, area.checked_mul(PIXEL)?)?;
        take_seal(bytes, all)?;
        let payload = &mut payload;
        for _ in 0..area {
            let mut value = || take_u64(payload).map(f64::from_bits);
            tile.pixels.push([value()?, value()?, value()?]);
        }
        for _ in 0..area {
            tile.queries.push(take_u64(payload)?);
        }
        Some(tile)
    }
}

fn seal(mut bytes: Vec<u8>) -> Vec<u8> {
    let sum = crc32fast::hash(&bytes);
    bytes.extend(sum.to_le_bytes());
    bytes
}

/// Takes the sum of everything that was taken off `all`.
fn take_seal(bytes: &mut &[u8], all: &[u8]) -> Option<()> {
    let sum = crc32fast::hash(&all[..all.len() - bytes.len()]);
    (take_u32(bytes)? == sum).then_some(())
}

fn put_text(bytes: &mut Vec<u8>, text: &str) {
    bytes.extend((text.len() as u32).to_le_bytes());
    bytes.extend(text.as_bytes());
}

fn take<'a>(bytes: &mut &'a [u8], count: u64) -> Option<&'a [u8]> {
    let (taken, rest) = bytes.split_at_checked(usize::try_from(count).ok()?)?;
    *bytes = rest;
    Some(taken)
}

fn take_u32(bytes: &mut &[u8]) -> Option<u32> {
    Some(u32::from_le_bytes(take(bytes, 4)?.try_into().ok()?))
}

fn take_u64(bytes: &mut &[u8]) -> Option<u64> {
    Some(u64::from_le_bytes(take(bytes, 8)?.try_into().ok()?))
}

fn take_text(bytes: &mut &[u8]) -> Option<String> {
    let length = take_u32(bytes)?;
    String::from_utf8(take(bytes, length.into())?.to_vec()).ok()
}

/// In what a checkpoint differs from the render that asks for it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// `scene`, `seed`, `film`, `crop`, or the name of an option.
    pub what: String,
    /// In the checkpoint.
    pub found: Option<String>,
    /// Now.
    pub asked: Option<String>,
}

/// Why a checkpoint can't be used.
#[derive(Debug)]
#[allow(missing_docs)]
pub enum CheckpointError {
    /// The file system refused.
    Io { path: PathBuf, source: io::Error },
    /// Another process is writing to it.
    InUse { path: PathBuf },
    /// Some other file.
    Foreign { path: PathBuf },
    /// Written by another version of this format.
    Version { path: PathBuf, version: u32 },
    /// The header fails its sum.
    Damaged { path: PathBuf },
    /// It belongs to another render.
    Differs {
        path: PathBuf,
        differences: Vec<Difference>,
    },
    /// A tile outside the crop, or whose pixels or queries don't fill it.
    Tile {
        x: u32,
        y: u32,
        width: u32,
        height: u32,
    },
}

impl fmt::Display for CheckpointError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io { path, source } => write!(f, "`{}`: {source}", path.display()),
            Self::InUse { path } => {
                write!(f, "`{}` is being written by another render", path.display())
            }
            Self::Foreign { path } => write!(f, "`{}` is not a checkpoint of qrt", path.display()),
            Self::Version { path, version } => write!(
                f,
                "`{}` is a checkpoint of format {version}; this qrt reads {VERSION}",
                path.display()
            ),
            Self::Damaged { path } => {
                write!(
                    f,
                    "`{}` is damaged: delete it and render anew",
                    path.display()
                )
            }
            Self::Differs { path, differences } => {
                write!(f, "`{}` belongs to another render", path.display())?;
                for Difference { what, found, asked } in differences {
                    let of = |v: &Option<String>| v.clone().unwrap_or_else(|| "not set".into());
                    write!(f, "\n  {what}: there {}, here {}", of(found), of(asked))?;
                }
                Ok(())
            }
            Self::Tile {
                x,
                y,
                width,
                height,
            } => write!(
                f,
                "a tile of {width} x {height} at ({x}, {y}) is not filled or not in the crop"
            ),
        }
    }
}

impl std::error::Error for CheckpointError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Io { source, .. } => Some(source),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests;
