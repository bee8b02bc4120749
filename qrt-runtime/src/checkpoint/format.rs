//! The binary format of a checkpoint.
//!
//! Layout; all numbers are little-endian, floats are stored as their bits:
//!
//! ```text
//! header  "QRTTILES", u32 version, u32 length of the body, body, u32 CRC-32 of all before
//! body    width, height, crop x, y, width, height (u32 each), u64 seed, scene hash, u32 count of
//!         options, and for each its name and value; texts as u32 length and UTF-8
//! record  a tile, a part or an ending, u32 CRC-32 of all before
//! tile    u32 0, x, y, width, height (u32 each), pixels (3 f64 each, rows from the top), the pixels'
//!         further figures (59 bytes each, see [`CountedPixels::encode`])
//! part    u32 1, x, y (u32 each), u64 number, u64 paths, u32 count of words, words (u64 each)
//! ending  u32 2, u32 length, bytes: the properties of a picture, by postcard; always the last record,
//!         and only in the file of a part of a picture, which has no `part` records
//! ```
//!
//! The pixels' layout is fixed, so that the length of a tile's record follows from its rectangle. The
//! library without features has checkpoints, and does without serde.

use super::{
    CheckpointDifference, CheckpointError, CountedPixels, Header, PixelPart, Tile, VERSION,
};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

pub(super) const MAGIC: &[u8; 8] = b"QRTTILES";
/// Kinds of record: the first word of a record.
const TILE: u32 = 0;
const PART: u32 = 1;
#[cfg(feature = "parts")]
const ENDING: u32 = 2;
/// Bytes of a tile's record without its pixels, and bytes of each pixel.
const RECORD: u64 = 24;
const PIXEL: u64 = COLOUR + CountedPixels::BYTES;
const COLOUR: u64 = 24;

impl Header {
    pub(crate) fn encode(&self) -> Vec<u8> {
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

    /// Decodes a header and removes its bytes from the front of `bytes`.
    pub(crate) fn decode(bytes: &mut &[u8], path: &Path) -> Result<Self, CheckpointError> {
        let foreign = || CheckpointError::Foreign {
            path: path.to_path_buf(),
        };
        let damaged = || CheckpointError::Damaged {
            path: path.to_path_buf(),
        };
        let all = *bytes;
        if take_bytes(bytes, MAGIC.len() as u64) != Some(MAGIC) {
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
        let mut body = take_bytes(bytes, length.into()).ok_or_else(damaged)?;
        take_seal(bytes, all).ok_or_else(damaged)?;
        let body = &mut body;
        let mut read = || {
            let [width, height] = [take_u32(body)?, take_u32(body)?];
            let crop = take_rectangle(body)?;
            let seed = take_u64(body)?;
            let scene_hash = take_text(body)?;
            let mut options = BTreeMap::new();
            for _ in 0..take_u32(body)? {
                options.insert(take_text(body)?, take_text(body)?);
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
        // The body is valid only if encoding it again gives the same bytes: it has no further
        // bytes, and no option occurs twice.
        let is_whole = |header: &Self| all.starts_with(&header.encode());
        read().filter(is_whole).ok_or_else(damaged)
    }

    pub(crate) fn differences(&self, asked: &Self) -> Vec<CheckpointDifference> {
        let fields = |h: &Self| {
            [
                ("scene", h.scene_hash.clone()),
                ("seed", h.seed.to_string()),
                ("film", format!("{} x {}", h.width, h.height)),
                ("crop", h.crop.map(|v| v.to_string()).join(",")),
            ]
        };
        let fields = fields(self).into_iter().zip(fields(asked));
        let fields = fields.map(|((what, found), (_, asked))| (what, Some(found), Some(asked)));
        let names: BTreeSet<&String> = self.options.keys().chain(asked.options.keys()).collect();
        let option = |h: &Self, name| h.options.get(name).cloned();
        let options = names
            .into_iter()
            .map(|name| (name.as_str(), option(self, name), option(asked, name)));
        fields
            .chain(options)
            .filter(|(_, found, asked)| found != asked)
            .map(|(what, found, asked)| CheckpointDifference {
                what: what.to_owned(),
                found,
                asked,
            })
            .collect()
    }
}

impl Tile {
    /// Number of pixels of the tile; `None` if the tile is not within the crop.
    pub(super) fn area_within(&self, [x, y, width, height]: [u32; 4]) -> Option<u64> {
        let inside = |at: u32, size: u32, low: u32, room: u32| {
            size > 0
                && at >= low
                && u64::from(at) + u64::from(size) <= u64::from(low) + u64::from(room)
        };
        let inside = inside(self.x, self.width, x, width) && inside(self.y, self.height, y, height);
        inside.then(|| u64::from(self.width) * u64::from(self.height))
    }

    pub(crate) fn encode(&self) -> Vec<u8> {
        let size = RECORD as usize + PIXEL as usize * self.pixels.len();
        let mut bytes = Vec::with_capacity(size);
        bytes.extend(TILE.to_le_bytes());
        for number in [self.x, self.y, self.width, self.height] {
            bytes.extend(number.to_le_bytes());
        }
        for value in self.pixels.iter().flatten() {
            bytes.extend(value.to_bits().to_le_bytes());
        }
        self.counted.encode(&mut bytes);
        seal(bytes)
    }

    /// Decodes a tile from `bytes`, which begin behind the kind; `all` begins with the kind.
    fn decode(bytes: &mut &[u8], all: &[u8], crop: [u32; 4]) -> Option<Self> {
        let mut tile = Self::new(take_rectangle(bytes)?);
        let area = tile.area_within(crop)?;
        let mut payload = take_bytes(bytes, area.checked_mul(PIXEL)?)?;
        take_seal(bytes, all)?;
        let payload = &mut payload;
        for _ in 0..area {
            let mut value = || take_u64(payload).map(f64::from_bits);
            tile.pixels.push([value()?, value()?, value()?]);
        }
        tile.counted = CountedPixels::decode(payload, tile.pixels.len())?;
        Some(tile)
    }
}

/// A record behind the header.
pub(crate) enum Record {
    Tile(Tile),
    Part(PixelPart),
    #[cfg(feature = "parts")]
    Ending(Ending),
}

/// The bytes that follow all pixels in the file of a part of a picture.
#[cfg(feature = "parts")]
pub(crate) struct Ending(pub(crate) Vec<u8>);

impl Record {
    /// Decodes a record and removes it from `bytes`; `None` at the end, or if the record is
    /// incomplete or damaged.
    pub(crate) fn decode(bytes: &mut &[u8], crop: [u32; 4]) -> Option<Self> {
        let all = *bytes;
        match take_u32(bytes)? {
            TILE => Tile::decode(bytes, all, crop).map(Self::Tile),
            PART => PixelPart::decode(bytes, all, crop).map(Self::Part),
            #[cfg(feature = "parts")]
            ENDING => Ending::decode(bytes, all).map(Self::Ending),
            _ => None,
        }
    }
}

impl PixelPart {
    pub(crate) fn encode(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(36 + 8 * self.totals.len());
        for number in [&[PART], &self.pixel[..]].into_iter().flatten() {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend(self.number.to_le_bytes());
        bytes.extend(self.paths.to_le_bytes());
        bytes.extend((self.totals.len() as u32).to_le_bytes());
        for word in &self.totals {
            bytes.extend(word.to_le_bytes());
        }
        seal(bytes)
    }

    /// Decodes a part from `bytes`, which begin behind the kind; `all` begins with the kind.
    fn decode(bytes: &mut &[u8], all: &[u8], crop: [u32; 4]) -> Option<Self> {
        let pixel = [take_u32(bytes)?, take_u32(bytes)?];
        Tile::new([pixel[0], pixel[1], 1, 1]).area_within(crop)?;
        let [number, paths] = [take_u64(bytes)?, take_u64(bytes)?];
        let count = u64::from(take_u32(bytes)?);
        let words = take_bytes(bytes, 8 * count)?.as_chunks::<8>().0.iter();
        let totals = words.map(|word| u64::from_le_bytes(*word)).collect();
        take_seal(bytes, all)?;
        Some(Self {
            pixel,
            number,
            paths,
            totals,
        })
    }
}

#[cfg(feature = "parts")]
impl Ending {
    pub(crate) fn encode(&self) -> Vec<u8> {
        let mut bytes = ENDING.to_le_bytes().to_vec();
        bytes.extend((self.0.len() as u32).to_le_bytes());
        bytes.extend(&self.0);
        seal(bytes)
    }

    /// Decodes an ending from `bytes`, which begin behind the kind; `all` begins with the kind.
    fn decode(bytes: &mut &[u8], all: &[u8]) -> Option<Self> {
        let length = take_u32(bytes)?;
        let held = take_bytes(bytes, length.into())?.to_vec();
        take_seal(bytes, all)?;
        Some(Self(held))
    }
}

fn seal(mut bytes: Vec<u8>) -> Vec<u8> {
    let sum = crc32fast::hash(&bytes);
    bytes.extend(sum.to_le_bytes());
    bytes
}

/// Reads a CRC-32 and checks that it is that of the bytes of `all` in front of it.
fn take_seal(bytes: &mut &[u8], all: &[u8]) -> Option<()> {
    let sum = crc32fast::hash(&all[..all.len() - bytes.len()]);
    (take_u32(bytes)? == sum).then_some(())
}

fn put_text(bytes: &mut Vec<u8>, text: &str) {
    bytes.extend((text.len() as u32).to_le_bytes());
    bytes.extend(text.as_bytes());
}

fn take_bytes<'a>(bytes: &mut &'a [u8], count: u64) -> Option<&'a [u8]> {
    let (taken, rest) = bytes.split_at_checked(usize::try_from(count).ok()?)?;
    *bytes = rest;
    Some(taken)
}

fn take_u32(bytes: &mut &[u8]) -> Option<u32> {
    Some(u32::from_le_bytes(take_bytes(bytes, 4)?.try_into().ok()?))
}

/// Reads x, y, width and height.
fn take_rectangle(bytes: &mut &[u8]) -> Option<[u32; 4]> {
    let mut next = || take_u32(bytes);
    Some([next()?, next()?, next()?, next()?])
}

fn take_u64(bytes: &mut &[u8]) -> Option<u64> {
    Some(u64::from_le_bytes(take_bytes(bytes, 8)?.try_into().ok()?))
}

fn take_text(bytes: &mut &[u8]) -> Option<String> {
    let length = take_u32(bytes)?;
    String::from_utf8(take_bytes(bytes, length.into())?.to_vec()).ok()
}
