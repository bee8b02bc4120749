//! Pictures rendered in parts, by several processes or machines, and merged.
//!
//! A part has a portion's pixels and everything that a picture's files record: colours and counts by
//! pixel, bounds, parameters and plan. Its file has the format of a
//! checkpoint (see [`crate::checkpoint`]) with one further record at the end, the picture's
//! [`Properties`], so that a truncated file is noticed. The CRC-32 of the header and of each record shows changed bytes. [`Merge`]
//! takes the parts in any order and returns the picture that [`super::render`] would have made, to
//! the last bit.

use super::film::Film;
use super::job::header;
use super::properties::Properties;
use super::request::Request;
use super::tiles::{Tiles, rows};
use super::{Portion, RenderError, RenderOptions, Rendered};
use crate::checkpoint::{
    Checkpoint, CheckpointDifference, CheckpointError, Ending, Header, Record, Tile,
};
use crate::prepared::Prepared;
use qrt_scene::valid::ValidScene;
use std::collections::BTreeMap;
use std::path::Path;

/// The option of a checkpoint that names the portion of the picture.
const PORTION: &str = "portion";
/// The largest number of missing parts that an error lists.
const NAMED: usize = 16;

/// An error of merging parts. `name` is the name of the part that was passed to [`Merge::add`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs)]
pub enum MergeError {
    /// No part was added.
    #[error("there are no parts to merge")]
    Nothing,
    /// The file is not a part of a picture.
    #[error("`{name}` is no part of a picture")]
    Foreign { name: String },
    /// The file has another version of the format.
    #[error("`{name}` is a part of format {version}, which this qrt does not read")]
    Version { name: String, version: u32 },
    /// The file does not match a CRC-32, or its contents contradict each other.
    #[error("`{name}` is damaged: render this part again")]
    Damaged { name: String },
    /// The file is left by an interrupted render, or is the beginning of a part.
    #[error(
        "`{name}`, part {portion}, is not whole: it was cut short, or its render was interrupted; \
         go on with that by `--resume`, or render the part again"
    )]
    Unfinished { name: String, portion: Portion },
    /// The file is the checkpoint of a picture that one process renders.
    #[error("`{name}` is the checkpoint of a whole picture, and no part of one")]
    Whole { name: String },
    /// The parts are of different pictures.
    #[error("`{name}` and `{first}` are parts of different pictures{}", listed(.differences))]
    Differs {
        name: String,
        first: String,
        /// The differences: `found` is the value in `name`, `asked` that in `first`.
        differences: Vec<CheckpointDifference>,
    },
    /// Two parts have the same pixels.
    #[error("`{name}` and `{first}` are both part {portion}: leave one of them out")]
    Doubled {
        name: String,
        first: String,
        portion: Portion,
    },
    /// Some parts are missing.
    #[error("{number} of {count} parts {} missing: {}", are(*.number), named(.first, *.number, *.count))]
    Missing {
        /// The numbers of the first missing parts, counted from 0.
        first: Vec<u32>,
        /// Number of missing parts.
        number: u32,
        count: u32,
    },
    /// The picture does not fit into memory.
    #[error("there is not enough memory for {pixels} pixels")]
    Memory { pixels: u64 },
}

fn listed(differences: &[CheckpointDifference]) -> String {
    let of = |value: &Option<String>| value.clone().unwrap_or_else(|| "not set".into());
    let line = |CheckpointDifference { what, found, asked }: &CheckpointDifference| {
        format!("\n  {what}: {} and {}", of(found), of(asked))
    };
    differences.iter().map(line).collect()
}

fn are(number: u32) -> &'static str {
    if number == 1 { "is" } else { "are" }
}

fn named(first: &[u32], number: u32, count: u32) -> String {
    let mut names: Vec<String> = first
        .iter()
        .map(|index| format!("{index}/{count}"))
        .collect();
    if first.len() < number as usize {
        names.push("...".into());
    }
    names.join(", ")
}

/// The pixels of a portion of a picture. There is no image of a part: pixels of other portions
/// would be black in it.
#[derive(Clone, Debug, PartialEq)]
pub struct PicturePart {
    portion: Portion,
    header: Header,
    /// The traced scene without its geometry and materials, as YAML.
    written: String,
    /// The portion's pixels; all pixels of other portions are black.
    rendered: Rendered,
}

/// Renders a portion of a picture. As [`Prepared::render`], it returns the checkpoint.
///
/// For a scene with an accuracy, each part makes the same plan again: a plan depends on no seed and
/// no portion. [`Prepared::render_part`] uses the plan of a prepared scene.
///
/// # Errors
/// As [`super::render`]; and if there are more portions than pixels of the picture.
///
/// ```
/// use qrt_scene::front::parse;
/// use qrt_runtime::render::{Merge, RenderOptions, Portion, render, render_part};
/// let text = "
/// name: sky
/// camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 1 } }
/// film: { width: 4, height: 2 }
/// materials: { sky: { emitter: { radiance: [0.25, 0.5, 1] } } }
/// geometry:
///   - quad: { vertices: [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], material: sky }
/// ";
/// let scene = parse(text, "sky.yaml", &[], "".as_ref())?.valid;
/// let mut merge = Merge::default();
/// for portion in ["1/2", "0/2"] {
///     let (part, _) = render_part(&scene, portion.parse()?, &RenderOptions::default())?;
///     merge.add(portion, &part.encode())?;
/// }
/// assert_eq!(merge.finish()?.image, render(&scene, &RenderOptions::default())?.image);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn render_part(
    scene: &ValidScene,
    portion: Portion,
    options: &RenderOptions<'_>,
) -> Result<(PicturePart, Option<Checkpoint>), RenderError> {
    options.prepare(scene)?.render_part(portion, options)
}

impl Request<'_> {
    /// The request for one portion of the picture. Its tiles do not depend on [`RenderOptions::tile`],
    /// so that all processes cut alike.
    fn with_portion(self, portion: Portion) -> Result<Self, RenderError> {
        let (count, pixels) = (portion.count(), self.area);
        if u64::from(count) > pixels {
            return Err(RenderError::Portions { count, pixels });
        }
        Ok(Self {
            tiles: Tiles::new(self.crop, None, self.paths, portion),
            part: Some((PORTION.to_owned(), portion.to_string())),
            ..self
        })
    }
}

impl Prepared<'_> {
    /// Renders a portion of the picture: see [`render_part`].
    ///
    /// # Errors
    /// As [`render_part`].
    pub fn render_part(
        &self,
        portion: Portion,
        options: &RenderOptions<'_>,
    ) -> Result<(PicturePart, Option<Checkpoint>), RenderError> {
        let request = Request::new(self.scene(), options)?.with_portion(portion)?;
        let header = header(&request);
        let (rendered, checkpoint) = self.render_request(request)?;
        let part = PicturePart {
            portion,
            header,
            written: written(self.scene()),
            rendered,
        };
        Ok((part, checkpoint))
    }
}

fn written(scene: &ValidScene) -> String {
    let mut written = scene.scene().clone();
    written.geometry.clear();
    written.materials.clear();
    written.to_yaml()
}

impl PicturePart {
    /// Returns the portion of the picture that this part has.
    pub fn portion(&self) -> Portion {
        self.portion
    }

    /// Returns the number of paths of its pixels.
    pub fn paths(&self) -> u64 {
        self.rendered.paths
    }

    /// Returns the number of its pixels.
    pub fn pixels(&self) -> u64 {
        self.tiles().area()
    }

    /// Returns the wall time of tracing and counting, in seconds.
    pub fn seconds(&self) -> f64 {
        self.rendered.seconds
    }

    fn tiles(&self) -> Tiles {
        tiles(&self.rendered, self.portion)
    }

    /// Encodes the part as the bytes of a file.
    pub fn encode(&self) -> Vec<u8> {
        let Rendered {
            image,
            counted,
            crop,
            ..
        } = &self.rendered;
        let tiles = self.tiles();
        let mut bytes = self.header.encode();
        for number in 0..tiles.count() {
            let mut tile = Tile::new(tiles.rectangle(number));
            for row in rows(&tile.clone(), *crop) {
                tile.pixels.extend(&image.pixels[row.clone()]);
                tile.counted.extend(counted, row);
            }
            bytes.extend(tile.encode());
        }
        let properties = Properties::new(&self.rendered, &self.written);
        bytes.extend(Ending(properties.encode()).encode());
        bytes
    }
}

/// Cuts a portion of a picture into tiles, the same in every process.
fn tiles(rendered: &Rendered, portion: Portion) -> Tiles {
    let paths = 1 << rendered.parameters.sampling.path_bits;
    Tiles::new(rendered.crop, None, paths, portion)
}

/// A decoded part.
struct Read {
    name: String,
    tiles: Vec<Tile>,
    /// The picture's properties, without pixels.
    rendered: Rendered,
}

/// Merges the parts of a picture.
#[derive(Default)]
pub struct Merge {
    /// The first part's name, and its header without the portion.
    first: Option<(String, Header)>,
    count: u32,
    parts: BTreeMap<u32, Read>,
}

impl Merge {
    /// Adds the bytes of a part. Errors call the part `name`.
    ///
    /// # Errors
    /// If the bytes are not a whole part, the part is of another picture than the earlier ones, or
    /// it was added before.
    pub fn add(&mut self, name: &str, bytes: &[u8]) -> Result<(), MergeError> {
        let name = name.to_owned();
        let mut rest = bytes;
        let (portion, header) = of_header(&name, &mut rest)?;
        match &self.first {
            None => {
                self.first = Some((name.clone(), header.clone()));
                self.count = portion.count();
            }
            Some((first, expected)) => {
                let mut differences = header.differences(expected);
                if portion.count() != self.count {
                    differences.push(CheckpointDifference {
                        what: "parts".into(),
                        found: Some(portion.count().to_string()),
                        asked: Some(self.count.to_string()),
                    });
                }
                if !differences.is_empty() {
                    let first = first.clone();
                    return Err(MergeError::Differs {
                        name,
                        first,
                        differences,
                    });
                }
            }
        }
        if let Some(first) = self.parts.get(&portion.index()) {
            let first = first.name.clone();
            return Err(MergeError::Doubled {
                name,
                first,
                portion,
            });
        }
        let read = Read::decode(name, portion, &header, rest)?;
        self.parts.insert(portion.index(), read);
        Ok(())
    }

    /// Returns the picture. Its time is the sum over all parts, and its number of threads the
    /// largest.
    ///
    /// # Errors
    /// If parts are missing.
    pub fn finish(self) -> Result<Rendered, MergeError> {
        let count = self.count;
        let number = count - self.parts.len() as u32;
        if number > 0 {
            let missing = (0..count).filter(|index| !self.parts.contains_key(index));
            return Err(MergeError::Missing {
                first: missing.take(NAMED).collect(),
                number,
                count,
            });
        }
        let mut parts = self.parts.into_values();
        let first = parts.next().ok_or(MergeError::Nothing)?;
        let mut whole = first.rendered;
        // All pixels have been read, so a film of this size takes no more memory than the parts
        // did.
        let [_, _, width, height] = whole.crop;
        let pixels = u64::from(width) * u64::from(height);
        let memory = |_| MergeError::Memory { pixels };
        let mut film = Film::new(whole.crop, whole.film).map_err(memory)?;
        for tile in &first.tiles {
            film.paint(tile);
        }
        for Read {
            tiles, rendered, ..
        } in parts
        {
            for tile in &tiles {
                film.paint(tile);
            }
            whole.paths = whole.paths.saturating_add(rendered.paths);
            whole.resumed_paths = whole.resumed_paths.saturating_add(rendered.resumed_paths);
            whole.seconds += rendered.seconds;
            whole.threads = whole.threads.max(rendered.threads);
        }
        whole.image = film.image;
        whole.counted = film.counted;
        Ok(whole)
    }
}

/// Decodes the header of a part: its portion, and the properties that it shares with the other
/// parts.
fn of_header(name: &str, rest: &mut &[u8]) -> Result<(Portion, Header), MergeError> {
    let name = name.to_owned();
    let header = match Header::decode(rest, Path::new(&name)) {
        Err(CheckpointError::Foreign { .. }) => Err(MergeError::Foreign { name: name.clone() }),
        Err(CheckpointError::Version { version, .. }) => Err(MergeError::Version {
            name: name.clone(),
            version,
        }),
        decoded => decoded.map_err(|_| MergeError::Damaged { name: name.clone() }),
    };
    let mut header = header?;
    match header.options.remove(PORTION).map(|text| text.parse()) {
        None => Err(MergeError::Whole { name }),
        Some(Err(_)) => Err(MergeError::Damaged { name }),
        Some(Ok(portion)) => Ok((portion, header)),
    }
}

impl Read {
    /// Decodes the records behind the header.
    fn decode(
        name: String,
        portion: Portion,
        header: &Header,
        mut rest: &[u8],
    ) -> Result<Self, MergeError> {
        let damaged = || MergeError::Damaged { name: name.clone() };
        let mut found = Vec::new();
        let ending = loop {
            let ended = rest.is_empty();
            match Record::decode(&mut rest, header.crop) {
                Some(Record::Tile(tile)) => found.push(tile),
                // A part record has totals of an unfinished pixel, which the finished tile
                // replaces.
                Some(Record::Part(_)) => {}
                Some(Record::Ending(ending)) if rest.is_empty() => break ending,
                None if ended => return Err(MergeError::Unfinished { name, portion }),
                Some(Record::Ending(_)) | None => return Err(damaged()),
            }
        };
        let Ending(properties) = ending;
        let properties = Properties::decode(&properties);
        let rendered = properties.and_then(|properties| properties.rendered(header));
        let rendered = rendered.ok_or_else(damaged)?;
        let tiles = tiles(&rendered, portion);
        let [x, y, width, height] = header.crop;
        let whole = x.checked_add(width).is_some_and(|end| end <= header.width)
            && y.checked_add(height)
                .is_some_and(|end| end <= header.height)
            && u64::from(portion.count()) <= u64::from(width) * u64::from(height)
            && tiles.count() == found.len() as u64
            && (found.iter().zip(0..))
                .all(|(tile, n)| [tile.x, tile.y, tile.width, tile.height] == tiles.rectangle(n));
        if !whole {
            return Err(damaged());
        }
        Ok(Self {
            name,
            tiles: found,
            rendered,
        })
    }
}
