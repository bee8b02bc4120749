//! Colour space of a PNG file, by the precedence of the PNG specification (third edition,
//! section 4.3): `cICP`, then `iCCP`, then `sRGB`, then `gAMA` and `cHRM`.
//!
//! This module reads the chunks itself, because the decoder leaves out those that it cannot parse.

use super::{in_words, is_rec_709};
use qrt_runtime::image::linear_of_srgb;
use std::io::{self, Read, Seek};

const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";
/// Chunks that decide the colour space of the samples.
const KINDS: [[u8; 4]; 6] = [*b"cICP", *b"iCCP", *b"sRGB", *b"gAMA", *b"cHRM", *b"acTL"];
/// Number of bytes read of a chunk: enough for every kind, and for the name of a profile.
const LOOKED_AT: u64 = 80;
/// Units per 1 in `gAMA` and `cHRM`.
const UNIT: f64 = 100_000.0;

/// The function from a sample to linear light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Transfer {
    /// The transfer function of sRGB (IEC 61966-2-1).
    Srgb,
    /// `sample^exponent`.
    Power(f64),
}

impl Transfer {
    /// Returns the linear light of a sample; both are from 0 to 1.
    pub(super) fn light(self, sample: f64) -> f64 {
        match self {
            Self::Srgb => linear_of_srgb(sample),
            Self::Power(exponent) => libm::pow(sample, exponent),
        }
    }
}

/// The first bytes of each chunk that describes colours.
#[derive(Debug, Default)]
pub(super) struct ColourChunks(Vec<([u8; 4], Vec<u8>)>);

impl ColourChunks {
    /// Reads the chunks of a file from its beginning. A file that is not PNG has none.
    ///
    /// # Errors
    /// An error of the file system, or in words, why the chunks make no sense.
    pub(super) fn read(mut file: impl Read + Seek) -> io::Result<Result<Self, String>> {
        let mut chunks = Self::default();
        let mut signature = [0; 8];
        if !filled(&mut file, &mut signature)? || signature != SIGNATURE {
            return Ok(Ok(chunks));
        }
        let mut in_image = false;
        let mut head = [0; 8];
        // The decoder reports a file that ends too early.
        while filled(&mut file, &mut head)? {
            let [a, b, c, d, kind @ ..] = head;
            let length = u64::from(u32::from_be_bytes([a, b, c, d]));
            in_image |= kind == *b"IDAT";
            let mut rest = length;
            if let Some(known) = KINDS.into_iter().find(|known| *known == kind) {
                let name = String::from_utf8_lossy(&known);
                if in_image {
                    return Ok(Err(format!("its chunk `{name}` stands behind the pixels")));
                }
                if chunks.get(known).is_some() {
                    return Ok(Err(format!("its chunk `{name}` is there twice")));
                }
                let mut bytes = Vec::new();
                let read = (&mut file)
                    .take(length.min(LOOKED_AT))
                    .read_to_end(&mut bytes)?;
                rest -= read as u64;
                chunks.0.push((known, bytes));
            }
            // Skip the checksum, too.
            file.seek_relative(rest as i64 + 4)?;
        }
        Ok(Ok(chunks))
    }

    fn get(&self, kind: [u8; 4]) -> Option<&[u8]> {
        let mut all = self.0.iter();
        all.find(|(own, _)| *own == kind).map(|(_, bytes)| &**bytes)
    }

    /// Returns the function from samples to linear light with the primaries of Rec. 709.
    ///
    /// # Errors
    /// In words, the colour space that has no such function, and the remedy.
    pub(super) fn transfer(&self) -> Result<Transfer, String> {
        if self.get(*b"acTL").is_some() {
            return Err("it is animated: save one picture of it".to_owned());
        }
        if let Some(code_points) = self.get(*b"cICP") {
            return of_code_points(code_points);
        }
        if let Some(profile) = self.get(*b"iCCP") {
            let name = profile.split(|byte| *byte == 0).next().unwrap_or_default();
            let name: String = name.iter().map(|byte| char::from(*byte)).collect();
            return Err(format!(
                "it has an ICC profile, `{}`, which qrt cannot apply: convert the picture to sRGB, and \
                 save it without a profile",
                name.escape_debug()
            ));
        }
        if let Some(intent) = self.get(*b"sRGB") {
            return match intent {
                [0..=3] => Ok(Transfer::Srgb),
                _ => Err(damaged("sRGB")),
            };
        }
        if let Some(bytes) = self.get(*b"cHRM") {
            let bytes = <&[u8; 32]>::try_from(bytes).map_err(|_| damaged("cHRM"))?;
            let mut numbers = bytes.as_chunks::<4>().0.iter();
            let mut number = || {
                let bytes = numbers.next().copied().unwrap_or_default();
                f64::from(u32::from_be_bytes(bytes)) / UNIT
            };
            // `cHRM` has white first.
            let [white, red, green, blue] = std::array::from_fn(|_| [number(), number()]);
            let found = [red, green, blue, white];
            if !is_rec_709(found) {
                return Err(format!(
                    "its chunk `cHRM` gives it other primaries than those of sRGB, {}: convert the \
                     picture to sRGB",
                    in_words(found)
                ));
            }
        }
        match self.get(*b"gAMA").map(<[u8; 4]>::try_from) {
            None => Ok(Transfer::Srgb),
            Some(Ok(bytes)) => match u32::from_be_bytes(bytes) {
                0 => Err(damaged("gAMA")),
                gamma => Ok(Transfer::Power(UNIT / f64::from(gamma))),
            },
            Some(Err(_)) => Err(damaged("gAMA")),
        }
    }
}

/// The transfer function of ITU-T H.273's code points: primaries, transfer, matrix, and full range.
fn of_code_points(code_points: &[u8]) -> Result<Transfer, String> {
    match *code_points {
        [1, 4, 0, 1] => Ok(Transfer::Power(2.2)),
        [1, 5, 0, 1] => Ok(Transfer::Power(2.8)),
        [1, 8, 0, 1] => Ok(Transfer::Power(1.0)),
        [1, 13, 0, 1] => Ok(Transfer::Srgb),
        [primaries, transfer, matrix, range] => Err(format!(
            "its chunk `cICP` gives it colours that qrt does not read: primaries {primaries}, transfer \
             {transfer}, matrix {matrix}, full range {range}; convert the picture to sRGB, which is 1, \
             13, 0, 1"
        )),
        _ => Err(damaged("cICP")),
    }
}

fn damaged(kind: &str) -> String {
    format!("its chunk `{kind}` is damaged: save the picture again, as sRGB")
}

/// Fills `bytes`; returns false if the file ends before.
fn filled(file: &mut impl Read, bytes: &mut [u8]) -> io::Result<bool> {
    match file.read_exact(bytes) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(false),
        Err(error) => Err(error),
    }
}
