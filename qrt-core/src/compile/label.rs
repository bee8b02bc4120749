//! Roles of registers, labels of blocks, and the words of a pixel.

use qrt_circuit::{Block, Register, Tag, Type};
use qrt_scene::sampling::{Coordinate, PathPoints, Square};
use std::fmt;

/// The purpose of a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Role {
    /// The path index, in superposition.
    Id,
    /// The comparator, in superposition.
    Comparator,
    /// A value of the path: zero before the oracle and after it.
    Work,
    /// The garbage of an operation: zero before the oracle and after it.
    Scratch,
    /// The path's colour, which the comparator is compared with: zero before and after.
    Colour,
    /// The outcome of the comparison, whose phase is flipped: zero before and after.
    Flag,
}

impl Role {
    /// All roles, in the order in which tables show them.
    pub const ALL: [Self; 6] = [
        Self::Id,
        Self::Comparator,
        Self::Work,
        Self::Scratch,
        Self::Colour,
        Self::Flag,
    ];

    /// Returns a register's role. Garbage has a type of its own; a register without a known tag is
    /// work.
    pub fn from_register(register: &Register) -> Self {
        let tagged = |role: &Self| role.tag() == register.tag;
        match register.ty {
            Type::Scratch => Self::Scratch,
            _ => Self::ALL.into_iter().find(tagged).unwrap_or(Self::Work),
        }
    }

    /// The tag that marks the role in programs.
    pub const fn tag(self) -> Tag {
        Tag(match self {
            Self::Work => 0,
            Self::Id => 1,
            Self::Comparator => 2,
            Self::Scratch => 3,
            Self::Colour => 4,
            Self::Flag => 5,
        })
    }
}

impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Id => "id",
            Self::Comparator => "comparator",
            Self::Work => "work",
            Self::Scratch => "scratch",
            Self::Colour => "colour",
            Self::Flag => "flag",
        })
    }
}

/// A stage of the oracle, or a part of a stage, that a block of the oracle's program computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StageName {
    /// The whole oracle: the root block.
    Oracle,
    /// The paper's *Generate Ray*: the camera's ray, or the ray that a surface scatters.
    GenerateRay,
    /// The paper's *Find Intersection*: the nearest hit of a ray.
    FindIntersection,
    /// A point on a lamp, and the part of its light that goes to the viewer if unoccluded.
    SampleLight,
    /// The test for anything between a vertex and the point on a lamp.
    Shadow,
    /// One convex body (by number), within a search.
    Body(u32),
    /// One plane (by number) and the primitives on it, within a search.
    Plane(u32),
    /// One primitive (by number), within a search.
    Primitive(u32),
    /// One sphere (by its face's number), within a search.
    Sphere(u32),
    /// All meshes whose edges are tested, within a search.
    Mesh,
    /// Edges of meshes (by the number of their group), within a search.
    Edges(u32),
    /// The plane of one face that a ray's line meets (by its place among these), within a search.
    Slot(u32),
    /// The light of the sky and the sun at the end of a ray.
    Sky,
    /// The side on which a ray meets a surface.
    Side,
    /// The interpolated normal of a smooth face.
    Normal,
    /// The interpolated tint of a face with colours at its vertices, within a ray or the sampling of a lamp.
    Tint,
    /// A sampled direction in the local frame, within a ray.
    Sample,
    /// One component of a vector, within a ray: 0, 1, 2.
    Component(u32),
    /// The light that a vertex adds.
    Shade,
    /// The colour, rounded to the comparator's thresholds.
    Count,
    /// The comparison with the nearest hit so far.
    Nearer,
    /// The comparison and the phase flip, between compute and uncompute.
    CompareAndFlip,
    /// The frame's operations at a hit, between blocks; no block of its own.
    Surface,
    /// The frame's operations before the first block; no block of its own.
    Frame,
    /// The comparison of the colour with the comparator, or its undoing; no block of its own.
    Compare,
    /// The phase flip.
    Flip,
    /// The path's values that a predicate reads, and the predicate.
    Predicate,
    /// The phase of the level, in place of the comparison: see
    /// [`Oracle::level_phases`](crate::oracle::Oracle::level_phases).
    LevelPhase,
}

impl StageName {
    /// The stage's name, without its number.
    pub fn kind(self) -> &'static str {
        match self {
            Self::Body(_) => "body",
            Self::Plane(_) => "plane",
            Self::Primitive(_) => "primitive",
            Self::Sphere(_) => "sphere",
            Self::Mesh => "mesh",
            Self::Edges(_) => "edges",
            Self::Slot(_) => "slot",
            Self::Sky => "sky",
            Self::Component(axis) => ["x", "y", "z"].get(axis as usize).unwrap_or(&"component"),
            Self::Oracle => "oracle",
            Self::GenerateRay => "generate_ray",
            Self::FindIntersection => "find_intersection",
            Self::Side => "side",
            Self::Normal => "normal",
            Self::Tint => "tint",
            Self::Sample => "sample",
            Self::Shade => "shade",
            Self::SampleLight => "sample_light",
            Self::Shadow => "shadow",
            Self::Count => "count",
            Self::Nearer => "nearer",
            Self::CompareAndFlip => "compare and flip",
            Self::Surface => "surface",
            Self::Frame => "frame",
            Self::Compare => "compare",
            Self::Flip => "flip",
            Self::Predicate => "predicate",
            Self::LevelPhase => "level phase",
        }
    }
}

impl fmt::Display for StageName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.kind())?;
        match self {
            Self::Plane(number)
            | Self::Primitive(number)
            | Self::Sphere(number)
            | Self::Edges(number)
            | Self::Slot(number)
            | Self::Body(number) => write!(f, " {number}"),
            _ => Ok(()),
        }
    }
}

/// The identity of a block of the oracle's program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Label {
    /// The stage that the block computes.
    pub stage: StageName,
    /// The number of bounces before the ray that the block belongs to; none for a block of no ray.
    pub depth: Option<u32>,
}

impl Label {
    /// Stages without a number that blocks can be. A stage's index here is its code in a tag.
    const PLAIN: [StageName; 18] = [
        StageName::Oracle,
        StageName::GenerateRay,
        StageName::FindIntersection,
        StageName::Side,
        StageName::Sample,
        StageName::Shade,
        StageName::Count,
        StageName::Nearer,
        StageName::CompareAndFlip,
        StageName::Flip,
        StageName::SampleLight,
        StageName::Shadow,
        StageName::Predicate,
        StageName::Sky,
        StageName::LevelPhase,
        StageName::Mesh,
        StageName::Normal,
        StageName::Tint,
    ];

    /// Returns a block's label. A block without a tag is a whole program.
    pub fn from_block(block: &Block) -> Self {
        let Tag(bits) = block.tag;
        let [number, depth, kind] = [
            bits as u32,
            (bits >> 32) as u32 & 0xff_ffff,
            (bits >> 56) as u32,
        ];
        let plain = |kind: u32| Self::PLAIN.get(kind as usize).copied();
        Self {
            stage: match kind {
                0xff => StageName::Plane(number),
                0xfe => StageName::Primitive(number),
                0xfd => StageName::Component(number),
                0xfc => StageName::Body(number),
                0xfb => StageName::Sphere(number),
                0xfa => StageName::Edges(number),
                0xf9 => StageName::Slot(number),
                kind => plain(kind).unwrap_or(StageName::Oracle),
            },
            depth: depth.checked_sub(1),
        }
    }

    /// The tag that marks the label in programs. Bits 0 to 31 are the stage's number, bits 32 to 55
    /// are `depth + 1` or 0 for none, bits 56 to 63 are the kind of stage.
    pub fn tag(self) -> Tag {
        let (kind, number) = match self.stage {
            StageName::Plane(number) => (0xff, number),
            StageName::Primitive(number) => (0xfe, number),
            StageName::Component(number) => (0xfd, number),
            StageName::Body(number) => (0xfc, number),
            StageName::Sphere(number) => (0xfb, number),
            StageName::Edges(number) => (0xfa, number),
            StageName::Slot(number) => (0xf9, number),
            plain => {
                let place = Self::PLAIN.iter().position(|&known| known == plain);
                (place.unwrap_or(0) as u64, 0)
            }
        };
        let depth = self.depth.map_or(0, |depth| u64::from(depth) + 1);
        Tag(u64::from(number) | depth << 32 | kind << 56)
    }

    /// Creates the block with this label.
    pub fn block(self, parent: Option<qrt_circuit::BlockId>) -> Block {
        Block {
            parent,
            name: self.stage.to_string(),
            tag: self.tag(),
        }
    }
}

/// A classical parameter of an oracle: a word that depends on the pixel alone. The circuit of a
/// pixel contains the word: X gates load it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PixelWord {
    /// The top `bits` bits of the XOR shift of a sample coordinate.
    Shift {
        /// The coordinate.
        coordinate: Coordinate,
        /// Number of bits of the coordinate.
        bits: u32,
    },
    /// `round((constant + along[0] column + along[1] row) 2^fraction) mod 2^width`
    Affine {
        /// The value at the film's upper left corner.
        constant: f64,
        /// The change of the value per column and per row.
        along: [f64; 2],
        /// Number of bits after the point.
        fraction: u32,
        /// Number of bits in all.
        width: u32,
    },
}

impl PixelWord {
    /// The parameter of the program whose value this word is.
    pub fn parameter(&self) -> qrt_circuit::Parameter {
        let (name, width) = match *self {
            Self::Shift { coordinate, bits } => {
                let axis = ["u", "v"][coordinate.axis as usize];
                let square = match coordinate.square {
                    Square::Ray => "ray",
                    Square::Light if coordinate.depth == 0 => "lens",
                    Square::Light => "light",
                };
                (format!("{square}{}.shift.{axis}", coordinate.depth), bits)
            }
            Self::Affine { width, .. } => ("pixel".to_owned(), width),
        };
        qrt_circuit::Parameter { name, width }
    }

    /// The words of `program`, whose parameters may have more bits than `words`.
    pub(crate) fn of_program(words: &[Self], program: &qrt_circuit::Program) -> Vec<Self> {
        let words = words.iter().zip(&program.parameters);
        let words = words.map(|(word, parameter)| word.widened(parameter.width));
        words.collect()
    }

    /// The same word with at least `width` bits. An [`Affine`](Self::Affine) that is widened is never negative; a
    /// shift is never widened.
    fn widened(self, width: u32) -> Self {
        match self {
            Self::Affine {
                constant,
                along,
                fraction,
                width: own,
            } => Self::Affine {
                constant,
                along,
                fraction,
                width: width.max(own),
            },
            shift @ Self::Shift { .. } => shift,
        }
    }

    /// Numbers that two words share if they are equal.
    pub(super) fn key(&self) -> [u64; 5] {
        match *self {
            Self::Shift { coordinate, bits } => {
                let [square, axis] = [coordinate.square as u64, coordinate.axis as u64];
                [u64::MAX, coordinate.depth as u64, square, axis, bits.into()]
            }
            Self::Affine {
                constant,
                along,
                fraction,
                width,
            } => {
                // 0 and -0 are one number.
                let [constant, column, row] =
                    [constant, along[0], along[1]].map(|number| (number + 0.0).to_bits());
                let shape = u64::from(fraction) << 32 | u64::from(width);
                [shape, constant, column, row, 0]
            }
        }
    }

    /// The parameter's bits in pixel (column, row).
    pub fn value(&self, points: &PathPoints, seed: u64, pixel: [u32; 2]) -> u64 {
        match *self {
            Self::Shift { coordinate, bits } => {
                let shift = points.shift(seed, pixel[0], pixel[1], coordinate);
                shift.checked_shr(64 - bits).unwrap_or(0)
            }
            Self::Affine {
                constant,
                along,
                fraction,
                width,
            } => {
                let value =
                    constant + along[0] * f64::from(pixel[0]) + along[1] * f64::from(pixel[1]);
                let scaled = (value * (1_u64 << fraction) as f64).round_ties_even() as i64;
                scaled.cast_unsigned() & (u64::MAX >> (64 - width))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_come_back_from_blocks() {
        let numbered = [
            StageName::Plane(0),
            StageName::Plane(u32::MAX),
            StageName::Primitive(65_536),
            StageName::Component(2),
            StageName::Body(7),
            StageName::Sphere(484),
            StageName::Edges(2_048),
            StageName::Slot(7),
            StageName::Sky,
        ];
        for stage in Label::PLAIN.into_iter().chain(numbered) {
            for depth in [None, Some(0), Some(1_000)] {
                let label = Label { stage, depth };
                assert_eq!(Label::from_block(&label.block(None)), label);
            }
        }
    }

    #[test]
    fn roles_come_back_from_registers() {
        for role in Role::ALL {
            let ty = if role == Role::Scratch {
                Type::Scratch
            } else {
                Type::UInt
            };
            let tag = role.tag();
            let register = Register {
                tag,
                ..Register::new("r", ty, 1)
            };
            assert_eq!(Role::from_register(&register), role);
        }
    }
}
