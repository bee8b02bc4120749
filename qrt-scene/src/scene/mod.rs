//! The scene as its author wrote it: plain data, one definition for YAML and macro.
//!
//! Each part is defined once, by `record!`, `variant!` or `keyword!`: its type, keys, defaults and
//! ranges, and with them the decoder, the printer and the JSON Schema. Nothing here is checked
//! against anything else: [`crate::valid::validate`] turns a [`Scene`] into the
//! [`crate::valid::ValidScene`] that everything downstream demands.

mod basis;
mod builder;
pub(crate) mod decode;
mod estimator;
pub(crate) mod finalize;
pub(crate) mod invalid;
mod material;
pub mod meshes;
mod parameters;
mod primitives;
mod record;
mod reflectance;
#[cfg(feature = "serde")]
mod serde;
pub(crate) mod shape;
pub mod text;
mod uncompute;

use crate::polygons::normalized;
pub use basis::Basis;
pub use builder::SceneBuilder;
pub use estimator::Estimator;
use glam::DVec3;
pub use material::{
    Bsdf, Dielectric, Emitter, Ggx, Jacobian, Lambertian, Material, Metal, Mirror, Phong,
};
pub use parameters::{
    Accuracy, Budget, Circuit, Comparator, ComparatorAt, Counting, DEFAULT_FRACTION, Nearest,
    Precision,
};
pub use primitives::{Cuboid, Disc, Quad, Sphere, Triangle};
pub use qrt_circuit::quantum::Window;
use qrt_syntax::tree::{Node, Span, Value};
use qrt_syntax::{Datum, Place, Problems};
use record::{keyword, record, variant};
pub use reflectance::{Checker, Pattern, Reflectance};
use shape::{
    Array, AutoOr, Colour, LARGEST, List, Maybe, Named, Number, Part, Text, number, part, point,
    whole, word,
};
use std::sync::Arc;
use text::{Data, Fingerprint};
pub use uncompute::{Recomputed, UNCOMPUTE_PARTS};
pub use uncompute::{Uncompute, UncomputedParts};

/// Maximum number of bits of a path index. Path counts up to `2^52` and their sums stay exact in
/// f64.
pub const MAX_PATH_BITS: u32 = 52;

/// Linear RGB.
pub type Rgb = [f64; 3];

const RADIANCE: Colour =
    Colour(number(0.0, LARGEST).or(|value, range| Datum::NotRadiance { value, range }));
const LENGTH: Number = number(0.0, LARGEST).above();

record! {
    /// A scene of qrt: what is seen, and how its circuit traces and counts it.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Scene = "the scene", finalize = finalize::scene;
    /// The scene's name. A picture's metadata repeat it.
    pub name: String = Text;
    /// The camera. Right-handed: right is forward x up, film rows go from the top.
    pub camera: Camera = part::<Camera>();
    /// The size of the picture.
    pub film: Film = part::<Film>();
    /// The light of directions in which nothing stands; black if it is left out.
    pub sky: Option<Sky> = Maybe(part::<Sky>()), or None;
    /// A lamp that is infinitely far away; none if it is left out.
    pub sun: Option<Sun> = Maybe(part::<Sun>()), or None;
    /// The materials, by names of your own: what surfaces do to light. They may be left out where
    /// meshes bring theirs.
    pub materials: Vec<(String, Material)> = Named(part::<Material>()), or Vec::new();
    /// Primitives and meshes. Coordinates have the unit that you choose, the scene unit.
    pub geometry: Vec<Geometry> = List {
        item: part::<Geometry>(), least: 0
    };
    /// The paths of a pixel: how many, and how long.
    pub sampling: Sampling = part::<Sampling>(), or Sampling::default();
    /// Width of the circuit's fixed-point numbers.
    pub precision: Precision = part::<Precision>(), or Precision::default();
    /// The comparator register.
    pub comparator: Comparator = part::<Comparator>(), or Comparator::default();
    /// The counting of the good indices.
    pub counting: Counting = part::<Counting>(), or Counting::default();
    /// The layout of the circuit.
    pub circuit: Circuit = part::<Circuit>(), or Circuit::default();
    /// Asked accuracy, instead of path_bits, precision, comparator and counting.
    pub accuracy: Option<Accuracy> = Maybe(part::<Accuracy>()), or None;
    /// Limits on the circuit's cost.
    pub budget: Option<Budget> = Maybe(part::<Budget>()), or None;
}

variant! {
    /// The camera. Right-handed: right is forward x up, film rows go from the top.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub enum Camera = "a camera";
    /// A pinhole.
    Perspective(Perspective) = "perspective";
    /// Parallel rays.
    Orthographic(Orthographic) = "orthographic";
}

record! {
    /// A pinhole.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Perspective = "a perspective camera";
    /// The pinhole, in scene units.
    pub eye: DVec3 = point();
    /// The point at the centre of the film, in scene units.
    pub target: DVec3 = point();
    /// A direction that points up in the picture, of any length; default [0, 1, 0].
    pub up: DVec3 = point(), or DVec3::Y;
    /// The vertical field of view in degrees.
    pub vfov: f64 = number(0.0, 180.0).above().below();
    /// A thin lens in place of the pinhole; default none.
    pub lens: Option<Lens> = Maybe(part::<Lens>()), or None;
}

record! {
    /// A thin lens: points at the distance `focus` are sharp.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Lens = "a lens";
    /// The diameter of the lens, in scene units.
    pub aperture: f64 = LENGTH;
    /// The distance of the sharp plane from the eye, along the view, in scene units.
    pub focus: f64 = LENGTH;
}

record! {
    /// Parallel rays.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Orthographic = "an orthographic camera";
    /// The centre of the film, where its rays start, in scene units.
    pub eye: DVec3 = point();
    /// A point straight ahead, in scene units.
    pub target: DVec3 = point();
    /// A direction that points up in the picture, of any length; default [0, 1, 0].
    pub up: DVec3 = point(), or DVec3::Y;
    /// The height of the film in scene units.
    pub height: f64 = LENGTH;
}

record! {
    /// The size of the picture.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Film = "the film";
    /// Pixels from left to right.
    pub width: u32 = whole::<u32>(1, 65_536);
    /// Pixels from top to bottom.
    pub height: u32 = whole::<u32>(1, 65_536);
}

record! {
    /// The light of directions in which nothing stands: either `radiance`, or both `horizon` and
    /// `zenith`.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Sky = "the sky", finalize = finalize::sky;
    /// The radiance of all directions, in linear RGB.
    pub radiance: Option<Rgb> = Maybe(RADIANCE), or None;
    /// The radiance of directions across `up` and below, in linear RGB.
    pub horizon: Option<Rgb> = Maybe(RADIANCE), or None;
    /// The radiance of the direction `up`, in linear RGB. Between, radiance is linear in the sine of
    /// the height above the horizon.
    pub zenith: Option<Rgb> = Maybe(RADIANCE), or None;
    /// The direction of the zenith, of any length; default [0, 1, 0].
    pub up: DVec3 = point(), or DVec3::Y;
}

impl Sky {
    /// The radiance at the horizon and below, and at the zenith.
    pub fn gradient(&self) -> [Rgb; 2] {
        let of = |end: Option<Rgb>| self.radiance.or(end).unwrap_or([0.0; 3]);
        [of(self.horizon), of(self.zenith)]
    }

    /// The unit vector towards the zenith.
    pub fn upwards(&self) -> DVec3 {
        normalized(self.up)
    }

    /// True if the sky gives light in any direction and channel.
    pub fn shines(&self) -> bool {
        self.gradient()
            .as_flattened()
            .iter()
            .any(|&channel| channel > 0.0)
    }
}

record! {
    /// A lamp that is infinitely far away: a cone of directions with one radiance. It adds to the light of
    /// the sky behind it.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Sun = "the sun";
    /// The direction from the scene towards the centre of the sun, of any length.
    pub direction: DVec3 = point();
    /// The angle of the cone, from edge to edge: the angular diameter of the sun, in degrees. Default 0.53, that
    /// of the Sun as seen from the Earth.
    pub angle: f64 = number(0.001, 180.0).below(), or 0.53;
    /// The radiance of all directions in the cone, in linear RGB.
    pub radiance: Rgb = RADIANCE;
}

impl Sun {
    /// True if the sun gives light in any channel.
    pub(crate) fn shines(&self) -> bool {
        self.radiance.iter().any(|&channel| channel > 0.0)
    }
}

variant! {
    /// A primitive or a mesh of them.
    #[derive(Clone, Debug, PartialEq)]
    pub enum Geometry = "a primitive";
    /// A convex quadrilateral.
    Quad(Quad) = "quad";
    /// A triangle.
    Triangle(Triangle) = "triangle";
    /// A sphere.
    Sphere(Sphere) = "sphere";
    /// A disc: the flat region within a circle.
    Disc(Disc) = "disc";
    /// A box, by two opposite corners.
    Cuboid(Cuboid) = "box";
    /// Triangles and polygons from a file, which exactly one of the keys `obj`, `ply` and `gltf`
    /// names.
    Mesh(Mesh) = "mesh";
}

record! {
    /// A mesh from a file, scaled, then rotated, then translated. It has exactly one of the keys
    /// `obj`, `ply` and `gltf`.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Mesh = "a mesh", finalize = finalize::mesh, one_of = &MeshFormat::NAMES;
    /// A Wavefront OBJ file, relative to the scene's folder.
    pub obj: Option<String> = Maybe(Text), or None;
    /// A PLY file, ASCII or binary, relative to the scene's folder.
    pub ply: Option<String> = Maybe(Text), or None;
    /// A glTF 2 file, `.gltf` or `.glb`, relative to the scene's folder.
    pub gltf: Option<String> = Maybe(Text), or None;
    /// The name of a material for all of it; without one, the file's materials. A PLY file has
    /// none.
    pub material: Option<String> = Maybe(Text), or None;
    /// Smooth shading. `auto`, the default: by the normals of the file, and for faces of an OBJ file without
    /// them by their smoothing group (`s`). Degrees: by the mean normal of the faces around a corner that make at
    /// most this angle with the face; 0 is flat.
    pub smooth: Option<f64> = AutoOr(number(0.0, 180.0)), or None;
    /// The use of the colours at the vertices of the file; without the key they are not used, and a warning says so.
    pub colors: Option<MeshColors> = Maybe(word::<MeshColors>()), or None;
    /// The factor of its size; default 1.
    pub scale: f64 = LENGTH, or 1.0;
    /// Degrees about x, then y, then z; default none.
    pub rotate: DVec3 = point(), or DVec3::ZERO;
    /// Added to every point, in scene units; default none.
    pub translate: DVec3 = point(), or DVec3::ZERO;
}

keyword! {
    /// The use of the colours at the vertices of a mesh file.
    pub enum MeshColors = "a use of colours";
    /// The colours are not used.
    None = "none";
    /// A factor of the albedo or the reflectance: linear RGB from 0 to 1, interpolated over each face. Every vertex
    /// of the file has one.
    Vertices = "vertices";
}

/// The format of a mesh file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum MeshFormat {
    /// Wavefront OBJ, with MTL libraries.
    Obj,
    /// The Stanford PLY format, ASCII or binary.
    Ply,
    /// glTF 2, as text or as one binary file.
    Gltf,
}

impl MeshFormat {
    /// All formats.
    pub const ALL: [Self; 3] = [Self::Obj, Self::Ply, Self::Gltf];
    /// Their keys in a mesh, in the order of [`Self::ALL`].
    pub const NAMES: [&'static str; 3] = ["obj", "ply", "gltf"];

    /// The format's key in a mesh.
    pub const fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }
}

impl Mesh {
    /// True if the colours at its vertices are used.
    pub(crate) fn is_coloured(&self) -> bool {
        self.colors == Some(MeshColors::Vertices)
    }

    /// Returns the format and the name of the mesh's file; `None` if the mesh has no file or
    /// several.
    pub fn file(&self) -> Option<(MeshFormat, &str)> {
        let mut files = self.files();
        files.next().filter(|_| files.next().is_none())
    }

    /// Iterates over the formats and names of the mesh's files, of which a valid mesh has one.
    pub(crate) fn files(&self) -> impl Iterator<Item = (MeshFormat, &str)> {
        let names = [&self.obj, &self.ply, &self.gltf].map(Option::as_deref);
        let files = MeshFormat::ALL.into_iter().zip(names);
        files.filter_map(|(format, name)| Some((format, name?)))
    }
}

record! {
    /// The paths of a pixel.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Sampling = "sampling", finalize = finalize::sampling;
    /// The sequence that turns path indices into points.
    pub sequence: Sequence = word::<Sequence>(), or Sequence::DigitalNet;
    /// R = 2^path_bits paths; default 12. Under product-lattice it is the sum of all bits, and
    /// only that.
    pub path_bits: u32 = whole::<u32>(0, MAX_PATH_BITS), or 12;
    /// One entry per ray of a path, the primary ray first; or the number of rays, each with 8 bits per
    /// coordinate. Default three.
    pub depths: Vec<DepthSampling> = finalize::Depths, or vec![DepthSampling::of_bits([8, 8]); 3];
    /// The sampling of lamps at the depths that have a point on a lamp.
    pub lights: Lights = word::<Lights>(), or Lights::Auto;
}

keyword! {
    /// The sampling of light at a vertex whose surface reflects to more than single directions and
    /// has a known density. The mean is the same for all.
    pub enum Lights = "a way to sample lights";
    /// `next-event` on surfaces where no lamp can weigh more than 1, by interval arithmetic over
    /// surface and lamp; `mis` elsewhere.
    Auto = "auto";
    /// Multiple importance sampling: the point on a lamp, and the ray where it meets one, by the
    /// balance heuristic.
    Mis = "mis";
    /// Next-event estimation: on matte surfaces the point on a lamp alone; what the ray meets does
    /// not count. Others weigh as under `mis`.
    NextEvent = "next-event";
    /// Rays alone, as in the paper.
    None = "none";
}

keyword! {
    /// The sequence that turns path indices into points.
    pub enum Sequence = "a sequence";
    /// One digital net over all coordinates, shifted per pixel.
    DigitalNet = "digital-net";
    /// The paper's product of a lattice per depth.
    ProductLattice = "product-lattice";
}

record! {
    /// Sampling of one ray.
    #[derive(Clone, Debug, PartialEq, Eq)]
    pub struct DepthSampling = "a depth";
    /// Resolution of the coordinates u and v, in bits.
    pub bits: [u32; 2] = Array::<_, 2>(whole::<u32>(0, 24));
    /// The map from the unit square to directions; not for the primary ray.
    pub map: Map = word::<Map>(), or Map::Auto;
    /// Resolution, in bits, of the point on a lamp that is connected to the surface which this ray
    /// leaves; not for the primary ray. `none`: no lamp is sampled there. `auto`, the default: `[8, 8]` where
    /// a material emits and a surface samples lamps, more bits for more than 256 lamps. `auto` is `none`
    /// under `product-lattice`, above 65,536 lamps, and for rays for which the net has no dimensions left.
    pub light: LightPoint = finalize::LightPointShape, or LightPoint::Auto;
    /// Resolution, in bits, of the point on the camera's lens; for the primary ray alone. Default the
    /// primary ray's `bits`, if the camera has a lens.
    pub lens: Option<[u32; 2]> = Maybe(Array::<_, 2>(whole::<u32>(0, 24))), or None;
}

/// The sampling of a point on a lamp at the start of a ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LightPoint {
    /// Under the digital net, `[8, 8]` bits where a material emits and a surface samples lamps; more if
    /// there are more than 2^8 lamps, and none above 2^16 lamps or beyond the net's dimensions. Under the
    /// product lattice, whose path bits are the sum of all bits, none.
    #[default]
    Auto,
    /// None: this ray starts without a connection to a lamp.
    None,
    /// The resolution, in bits, of its two coordinates.
    Bits([u32; 2]),
}

impl From<[u32; 2]> for LightPoint {
    fn from(bits: [u32; 2]) -> Self {
        Self::Bits(bits)
    }
}

impl Scene {
    /// The lens of the camera, if it has one.
    pub fn lens(&self) -> Option<Lens> {
        match &self.camera {
            Camera::Perspective(camera) => camera.lens,
            Camera::Orthographic(_) => None,
        }
    }
}

impl DepthSampling {
    /// Creates the sampling of a ray with `bits` per coordinate and each material's own map.
    pub const fn of_bits(bits: [u32; 2]) -> Self {
        Self {
            bits,
            map: Map::Auto,
            light: LightPoint::Auto,
            lens: None,
        }
    }
}

/// The use of a unit square of sample coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Square {
    /// A ray's direction, or the primary ray's place on the pixel.
    Ray,
    /// The point on a lamp; of the primary ray, on the camera's lens.
    Light,
}

keyword! {
    /// The map from the unit square to directions.
    pub enum Map = "a map";
    /// Each material's own.
    Auto = "auto";
    /// Density proportional to the cosine.
    CosineHemisphere = "cosine-hemisphere";
    /// Constant density.
    UniformHemisphere = "uniform-hemisphere";
}

/// Returns a block with all keys left out, so that each has its default.
fn of_defaults<T: Part>() -> T {
    let node = Node {
        span: Span::default(),
        value: Value::Map(Arc::default()),
    };
    T::decode(&node, &Place::ROOT, &mut Problems::default())
}

macro_rules! defaults {
    ($($name:ident),*) => {
        $(impl Default for $name {
            fn default() -> Self {
                of_defaults()
            }
        })*
    };
}
defaults!(Sampling, Precision, Comparator, Counting, Circuit);

impl Scene {
    /// Encodes the scene as data, from which it is printed.
    pub fn encode(&self) -> Data {
        let mut data = Part::encode(self);
        if self.accuracy.is_some() {
            // The parameters that an accuracy replaces must not be written beside it.
            if let Data::Map(entries) = &mut data {
                entries.retain(|(key, _)| {
                    !["precision", "comparator", "counting"].contains(&key.as_str())
                });
                for (key, value) in entries {
                    if let ("sampling", Data::Map(sampling)) = (key.as_str(), value) {
                        sampling.retain(|(key, _)| key != "path_bits");
                    }
                }
            }
        }
        data
    }

    /// Returns the scene as YAML, with every default written out but the transforms of single shapes and
    /// `light: auto`. A valid scene survives the round trip.
    pub fn to_yaml(&self) -> String {
        self.encode().to_yaml()
    }

    /// Returns the 128-bit FNV-1a hash of the scene's canonical text, with every default written
    /// out. Equal scenes have equal fingerprints, however they were written. Meshes count by the
    /// names of their files; [`crate::valid::ValidScene::fingerprint`] adds their contents.
    pub fn fingerprint(&self) -> Fingerprint {
        Fingerprint::EMPTY.and(self.encode().canonical().as_bytes())
    }
}
