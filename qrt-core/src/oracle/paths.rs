//! The numbers of a path, in registers. The scene fixes the format of each
//! register, in the scene's own units, which do not depend on those of the circuit.
//!
//! | number | format | meaning |
//! |---|---|---|
//! | `origin` | `Fixed` | the point of the scene where the ray starts |
//! | `direction` | `Fixed<2, F>` | the ray's direction, of length 1 |
//! | `found` | `Bool` | true if the ray meets a face |
//! | `distance` | `UFixed` | the distance of that face, in units of the scene |
//! | `face` | `UInt` | the number of the face: 1 is the scene's first |
//! | `material` | `UInt` | the number of its material: 1 is the scene's first |
//! | `front` | `Bool` | true if the ray meets the face's front, which lamps emit from |
//! | `normal` | `Fixed<2, F>` | the unit normal of its front |
//! | `colour` | `UFixed` | the path's colour, in radiance |
//!
//! `F` is the scene's number of fraction bits. Points and distances have the number of bits before
//! the point that the scene's extent needs, colours that of the brightest path. All keep the
//! precision of the circuit.
//!
//! All numbers of a ray are 0 if the path has ended before it. The numbers of its hit are 0 if the
//! ray meets nothing: no face and no material has the number 0.

use super::DEFAULT_FRACTION;
use glam::DVec3;
use qrt_circuit::format::{Bool, Format, Reg};
use qrt_circuit::{Recorded, Recorder, RegisterId, Type};
use qrt_scene::valid::ValidScene;
use qrt_tracer::Stage;
use std::fmt;

/// Most bits of a register of a path.
const MOST_BITS: i32 = 62;

/// A number of a ray. Vectors are given by component: 0, 1, 2 for x, y, z.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum RayNumber {
    /// A coordinate of the point where the ray starts.
    Origin(usize),
    /// A component of the ray's unit direction.
    Direction(usize),
    /// True if the ray meets a face.
    Found,
    /// The distance of the face.
    Distance,
    /// The face's number.
    Face,
    /// The number of the face's material.
    Material,
    /// True if the ray meets the front of the face.
    Front,
    /// A component of the unit normal of the face's front.
    Normal(usize),
}

impl RayNumber {
    /// All quantities of a path, in the order in which its registers are declared.
    pub const ALL: [Self; 14] = [
        Self::Origin(0),
        Self::Origin(1),
        Self::Origin(2),
        Self::Direction(0),
        Self::Direction(1),
        Self::Direction(2),
        Self::Found,
        Self::Distance,
        Self::Face,
        Self::Material,
        Self::Front,
        Self::Normal(0),
        Self::Normal(1),
        Self::Normal(2),
    ];

    /// True if it is a number of the ray's hit.
    pub(crate) fn is_of_hit(self) -> bool {
        !matches!(self, Self::Origin(_) | Self::Direction(_))
    }
}

/// A number of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum PathNumber {
    /// A number of the ray after a number of bounces.
    Ray(usize, RayNumber),
    /// The path's radiance in a channel: 0 red, 1 green, 2 blue.
    Colour(usize),
}

/// Writes a name like `ray1.origin.x`.
impl fmt::Display for PathNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (depth, number) = match self {
            Self::Colour(channel) => return write!(f, "colour.{}", ["r", "g", "b"][channel % 3]),
            Self::Ray(depth, number) => (depth, number),
        };
        let (name, component) = match number {
            RayNumber::Origin(component) => ("origin", Some(component)),
            RayNumber::Direction(component) => ("direction", Some(component)),
            RayNumber::Normal(component) => ("normal", Some(component)),
            RayNumber::Found => ("found", None),
            RayNumber::Distance => ("distance", None),
            RayNumber::Face => ("face", None),
            RayNumber::Material => ("material", None),
            RayNumber::Front => ("front", None),
        };
        write!(f, "ray{depth}.{name}")?;
        match component {
            Some(component) => write!(f, ".{}", ["x", "y", "z"][component % 3]),
            None => Ok(()),
        }
    }
}

/// The format of a register, and the conversion of a number of the circuit to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathFormat {
    /// The meaning of the register's bits.
    pub ty: Type,
    /// Number of bits of the register: 1 to 62.
    pub width: u32,
    /// The register is `floor(n 2^shift)`, for the circuit's number n in units in its last place.
    pub(crate) shift: i32,
}

impl PathFormat {
    fn exact(ty: Type, width: u32) -> Self {
        Self {
            ty,
            width,
            shift: 0,
        }
    }

    /// The format of numbers whose magnitude is below `2^above`. The last place of the circuit is
    /// `2^-fraction`. The format keeps all of that precision, or as much of it as fits. None if the
    /// bits before the point do not fit.
    fn number(signed: bool, above: i32, fraction: i32) -> Option<Self> {
        let whole = above + i32::from(signed);
        let kept = fraction.max(0).min(MOST_BITS - whole);
        let width = u32::try_from(whole + kept).ok()?.max(1);
        let own = u32::try_from(kept).ok()?;
        let ty = if signed {
            Type::Fixed { fraction: own }
        } else {
            Type::UFixed { fraction: own }
        };
        Some(Self {
            ty,
            width,
            shift: kept - fraction,
        })
    }

    /// Number of bits after the point.
    pub fn fraction(&self) -> u32 {
        match self.ty {
            Type::Fixed { fraction } | Type::UFixed { fraction } => fraction,
            Type::Bool | Type::UInt | Type::Int | Type::Scratch => 0,
        }
    }

    /// The number that a register's bits stand for.
    pub fn value(&self, bits: u64) -> f64 {
        let unused = 64 - self.width;
        let signed = matches!(self.ty, Type::Fixed { .. } | Type::Int);
        let units = if signed {
            ((bits << unused).cast_signed() >> unused) as f64
        } else {
            (bits << unused >> unused) as f64
        };
        units * f64::from(self.fraction()).exp2().recip()
    }

    /// The bits of the number of this format that is nearest to `value`; none if that is out of
    /// range.
    pub fn bits(&self, value: f64) -> Option<u64> {
        let units = (value * f64::from(self.fraction()).exp2()).round_ties_even();
        let signed = matches!(self.ty, Type::Fixed { .. } | Type::Int);
        let most = f64::from(self.width - u32::from(signed)).exp2();
        let least = if signed { -most } else { 0.0 };
        (least <= units && units < most)
            .then(|| (units as i64).cast_unsigned() & (u64::MAX >> (64 - self.width)))
    }
}

/// The registers of a path of one scene: the number of its rays, and the format of each number.
#[derive(Clone, Debug, PartialEq)]
pub struct PathFormats {
    /// Number of rays that are traced: the scene's, without a last ray in place of which only a
    /// lamp is sampled.
    pub rays: usize,
    point: PathFormat,
    distance: PathFormat,
    unit: PathFormat,
    face: PathFormat,
    material: PathFormat,
    colour: PathFormat,
    /// The unit of colours, a power of two.
    pub(crate) colour_unit: f64,
    /// The point of the scene that is the origin of the circuit's numbers.
    pub(crate) centre: [f64; 3],
    /// The circuit's units per unit of the scene: a power of two.
    pub(crate) scale: f64,
}

/// The least `k` with `2^k > most`, for `most > 0`.
fn above(most: f64) -> i32 {
    let mut k = most.log2().floor() as i32;
    while f64::from(k).exp2() <= most {
        k += 1;
    }
    k
}

impl PathFormats {
    /// The formats of a scene's paths; none if the scene is too large for 62 bits before the point.
    pub fn new(scene: &ValidScene) -> Option<Self> {
        Self::from_stage(scene, &Stage::of_any_pixel(scene, [0, 1, 2]))
    }

    fn from_stage(scene: &ValidScene, stage: &Stage<3>) -> Option<Self> {
        let fraction = scene.scene().precision.fraction.unwrap_or(DEFAULT_FRACTION);
        let geometry = stage.geometry();
        let scale = geometry.scale;
        let fraction = fraction.cast_signed();
        // The unit of the scene's numbers is `2^steps` of the circuit's unit.
        let steps = scale.log2().round() as i32;
        // Vertices lie within one unit of the circuit around the centre. Rounding moves them by far
        // less than another unit.
        let vertices = geometry.centre.abs().max_element() + 2.0 / scale;
        let starts = stage.starts().iter();
        let starts = starts.map(|p| (*p / scale + geometry.centre).abs().max_element());
        let farthest = starts.fold(vertices, f64::max);
        let t_max = stage.t_max().max(stage.camera().t_max).max(1.0) / scale;
        let bound = stage.bound().into_iter().fold(0.0, f64::max);
        let colour = if bound > 0.0 { above(bound) } else { 0 };
        let faces = scene.surface_of_faces().len() as u32;
        let materials = scene.surfaces().len() as u32;
        let count = |most: u32| PathFormat::exact(Type::UInt, (32 - most.leading_zeros()).max(1));
        Some(Self {
            rays: stage.traced_rays(),
            point: PathFormat::number(true, above(farthest), fraction + steps)?,
            // Twice the greatest distance of a hit.
            distance: PathFormat::number(false, above(2.0 * t_max), fraction + steps)?,
            unit: PathFormat::number(true, 1, fraction)?,
            face: count(faces),
            material: count(materials),
            // Twice the colour of the brightest path.
            colour: PathFormat::number(false, colour + 1, fraction - colour)?,
            colour_unit: f64::from(colour).exp2(),
            centre: geometry.centre.to_array(),
            scale,
        })
    }

    /// Prepares the `stage` of a scene for paths whose `numbers` are read. If `numbers`
    /// contain hits of the last rays, these rays are searched for all faces. If they contain
    /// directions or distances of the primary rays, these rays have directions of length 1.
    pub fn stage(&self, mut stage: Stage<3>, numbers: &[PathNumber]) -> Stage<3> {
        let rays = |asked: &dyn Fn(usize, RayNumber) -> bool| {
            numbers.iter().any(|number| match number {
                PathNumber::Ray(depth, number) => asked(*depth, *number),
                PathNumber::Colour(_) => false,
            })
        };
        let last = stage.depths() - 1;
        if rays(&|depth, number| depth == last && number.is_of_hit()) {
            stage = stage.with_every_hit();
        }
        let unit = |number| matches!(number, RayNumber::Direction(_) | RayNumber::Distance);
        if rays(&|depth, number| depth == 0 && unit(number)) {
            stage = stage.with_unit_directions();
        }
        stage
    }

    /// The format of a number.
    pub fn format(&self, number: PathNumber) -> PathFormat {
        match number {
            PathNumber::Colour(_) => self.colour,
            PathNumber::Ray(_, number) => match number {
                RayNumber::Origin(_) => self.point,
                RayNumber::Direction(_) | RayNumber::Normal(_) => self.unit,
                RayNumber::Found | RayNumber::Front => PathFormat::exact(Type::Bool, 1),
                RayNumber::Distance => self.distance,
                RayNumber::Face => self.face,
                RayNumber::Material => self.material,
            },
        }
    }

    /// All numbers of a path.
    pub fn numbers(&self) -> Vec<PathNumber> {
        let rays = 0..self.rays;
        let rays = rays.flat_map(|ray| RayNumber::ALL.map(|number| PathNumber::Ray(ray, number)));
        rays.chain([0, 1, 2].map(PathNumber::Colour)).collect()
    }

    /// Converts a point of the circuit to the scene's units.
    pub fn point(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let point = DVec3::new(x, y, z) / self.scale + DVec3::from_array(self.centre);
        point.to_array()
    }

    /// Converts a distance of the circuit to the scene's units.
    pub fn distance(&self, distance: f64) -> f64 {
        distance / self.scale
    }
}

/// A scene of `qrt!` whose paths have registers with types.
#[diagnostic::on_unimplemented(
    message = "the paths of `{Self}` have no registers",
    label = "not a scene of `qrt!`",
    note = "predicates are of paths of a scene that `qrt!` has made, as in \
            `count_where::<Room>(..)`"
)]
pub trait PathScene: Sized + 'static {
    /// The registers of a path: its rays, `ray0`, `ray1` and so on, and its `colour`.
    type Path;

    /// The scene.
    fn scene() -> &'static ValidScene;

    /// Declares the registers as inputs of the recording.
    fn path(inputs: &mut PathInputs<'_>) -> Self::Path;
}

/// Creates the registers of a path, for generated code.
#[derive(Debug)]
pub struct PathInputs<'a> {
    pub(super) recorder: &'a mut Recorder,
    pub(super) formats: &'a PathFormats,
    pub(super) made: Vec<(PathNumber, RegisterId)>,
}

/// A point or a direction.
#[derive(Debug)]
pub struct VectorRegisters<T> {
    /// Its first component.
    pub x: Reg<Recorded, T>,
    /// Its second component.
    pub y: Reg<Recorded, T>,
    /// Its third component.
    pub z: Reg<Recorded, T>,
}

/// A linear colour.
#[derive(Debug)]
pub struct ColourRegisters<T> {
    /// Red.
    pub r: Reg<Recorded, T>,
    /// Green.
    pub g: Reg<Recorded, T>,
    /// Blue.
    pub b: Reg<Recorded, T>,
}

/// The registers of a ray and of its hit: see [the module](self). `P`, `U`, `L`, `F` and `M` are
/// the formats of points, unit vectors, distances, faces and materials.
#[derive(Debug)]
pub struct RayRegisters<P, U, L, F, M> {
    /// The point of the scene where the ray starts.
    pub origin: VectorRegisters<P>,
    /// The ray's direction, of length 1.
    pub direction: VectorRegisters<U>,
    /// True if the ray meets a face.
    pub found: Reg<Recorded, Bool>,
    /// The distance of the face, in units of the scene.
    pub distance: Reg<Recorded, L>,
    /// The number of the face, from 1 on.
    pub face: Reg<Recorded, F>,
    /// The number of the face's material, from 1 on.
    pub material: Reg<Recorded, M>,
    /// True if the ray meets the front of the face.
    pub front: Reg<Recorded, Bool>,
    /// The unit normal of the face's front.
    pub normal: VectorRegisters<U>,
}

impl PathInputs<'_> {
    /// The register of a number.
    ///
    /// # Panics
    /// If the number's format is not `T`: generated code has the right formats.
    fn register<T: Format>(&mut self, number: PathNumber) -> Reg<Recorded, T> {
        let format = self.formats.format(number);
        assert!(
            (T::TYPE, T::WIDTH) == (format.ty, format.width),
            "{number} is a {}",
            format.ty.name(format.width)
        );
        let register = Reg::input(self.recorder, "path");
        self.made
            .push((number, self.recorder.own(register.register())));
        register
    }

    fn vector<T: Format>(&mut self, number: impl Fn(usize) -> PathNumber) -> VectorRegisters<T> {
        VectorRegisters {
            x: self.register(number(0)),
            y: self.register(number(1)),
            z: self.register(number(2)),
        }
    }

    /// The registers of the ray after `depth` bounces.
    ///
    /// # Panics
    /// If a format is not the scene's: generated code has the right formats.
    pub fn ray<P: Format, U: Format, L: Format, F: Format, M: Format>(
        &mut self,
        depth: usize,
    ) -> RayRegisters<P, U, L, F, M> {
        let of = |number| PathNumber::Ray(depth, number);
        RayRegisters {
            origin: self.vector(|axis| of(RayNumber::Origin(axis))),
            direction: self.vector(|axis| of(RayNumber::Direction(axis))),
            found: self.register(of(RayNumber::Found)),
            distance: self.register(of(RayNumber::Distance)),
            face: self.register(of(RayNumber::Face)),
            material: self.register(of(RayNumber::Material)),
            front: self.register(of(RayNumber::Front)),
            normal: self.vector(|axis| of(RayNumber::Normal(axis))),
        }
    }

    /// The registers of the path's colour.
    ///
    /// # Panics
    /// As [`PathInputs::ray`].
    pub fn colour<T: Format>(&mut self) -> ColourRegisters<T> {
        ColourRegisters {
            r: self.register(PathNumber::Colour(0)),
            g: self.register(PathNumber::Colour(1)),
            b: self.register(PathNumber::Colour(2)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_hold_their_range_and_the_circuits_precision() {
        // The scene is 560 units across. Of 14 fraction bits of 512 units, 5 are left after the
        // point.
        let millimetres = PathFormat::number(true, above(559.0), 14 - 9).unwrap();
        assert_eq!(millimetres.ty, Type::Fixed { fraction: 5 });
        assert_eq!((millimetres.width, millimetres.shift), (16, 0));
        assert_eq!(
            millimetres.bits(-559.0).map(|bits| millimetres.value(bits)),
            Some(-559.0)
        );
        assert_eq!(millimetres.bits(1024.0), None);
        // The last place is larger than a unit: the register has low zeros and no bits after the
        // point.
        let far = PathFormat::number(true, 30, -4).unwrap();
        assert_eq!(
            (far.ty, far.width, far.shift),
            (Type::Fixed { fraction: 0 }, 31, 4)
        );
        // There are more bits than the register holds: the last are dropped.
        let fine = PathFormat::number(false, 31, 34).unwrap();
        assert_eq!((fine.fraction(), fine.width, fine.shift), (31, 62, -3));
        assert_eq!(PathFormat::number(true, 62, 10), None);
        // Small numbers need no bits before the point.
        let tiny = PathFormat::number(true, -18, 33).unwrap();
        assert_eq!(
            (tiny.ty.name(tiny.width), tiny.shift),
            ("Fixed<-17, 33>".to_owned(), 0)
        );
    }

    #[test]
    fn a_power_above_is_the_least() {
        for (most, k) in [
            (1.0, 1),
            (0.99, 0),
            (0.5, 0),
            (0.49, -1),
            (2.0, 2),
            (559.0, 10),
        ] {
            assert_eq!(above(most), k, "{most}");
        }
    }
}
