//! The scene as its author wrote it: plain data, one definition for YAML and macro.
//!
//! Nothing here is checked. [`crate::valid::validate`] turns a [`Scene`] into the
//! [`crate::valid::ValidScene`] that everything downstream demands.

use glam::DVec3;

/// Linear RGB.
pub type Rgb = [f64; 3];

/// A whole scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// What the scene is called.
    pub name: String,
    /// The camera.
    pub camera: Camera,
    /// The film.
    pub film: Film,
    /// Materials in the order written.
    pub materials: Vec<(String, Material)>,
    /// Primitives in the order written.
    pub geometry: Vec<Geometry>,
    /// The paths.
    pub sampling: Sampling,
    /// Width of the fixed-point numbers.
    pub precision: Precision,
    /// The comparator register.
    pub comparator: Comparator,
    /// How the good ids are counted.
    pub counting: Counting,
    /// How the circuit is laid out.
    pub circuit: Circuit,
    /// Asked accuracy, instead of the knobs.
    pub accuracy: Option<Accuracy>,
    /// Limits on the circuit's cost.
    pub budget: Option<Budget>,
}

/// The camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Camera {
    /// `perspective`
    Perspective(Perspective),
    /// `orthographic`
    Orthographic(Orthographic),
}

/// A pinhole. `up` defaults to `[0, 1, 0]`; `vfov` is in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Perspective {
    pub eye: DVec3,
    pub target: DVec3,
    pub up: DVec3,
    pub vfov: f64,
}

/// Parallel rays. `height` is the film's height in scene units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Orthographic {
    pub eye: DVec3,
    pub target: DVec3,
    pub up: DVec3,
    pub height: f64,
}

/// Pixel counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub struct Film {
    pub width: u32,
    pub height: u32,
}

/// A material.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum Material {
    Lambertian(Lambertian),
    Emitter(Emitter),
    Mirror(Mirror),
    Dielectric(Dielectric),
    Ggx(Ggx),
    Phong(Phong),
    Bsdf(Bsdf),
}

/// `albedo / pi`, on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Lambertian {
    pub albedo: Rgb,
}

/// Emits on the side of `(v1 - v0) x (v2 - v0)`; reflects as a Lambertian (both sides). `albedo` defaults to black.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Emitter {
    pub radiance: Rgb,
    pub albedo: Rgb,
}

/// A perfect mirror, on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Mirror {
    pub reflectance: Rgb,
}

/// Smooth glass with Fresnel reflectance. `ior` is of the side opposite to the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Dielectric {
    pub ior: f64,
}

/// GGX, Fresnel 1, separable Smith masking.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Ggx {
    pub alpha: f64,
    pub reflectance: Rgb,
}

/// `diffuse / pi + specular (n + 2) / (2 pi) max(0, cos a)^n`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Phong {
    pub diffuse: Rgb,
    pub specular: Rgb,
    pub exponent: f64,
}

/// The user's own BSDF: expressions as source text.
#[derive(Clone, Debug, PartialEq)]
pub struct Bsdf {
    /// `phi(u, v)`: the components x, y, z of a unit vector, z along the normal.
    pub map: [String; 3],
    /// `auto` (symbolic) by default, or an expression in `u`, `v` that is then checked.
    pub jacobian: Jacobian,
    /// RGB in `cos_i`, `cos_o`, `cos_a`, `u`, `v`; one expression means grey.
    pub value: Vec<String>,
}

/// Where a map's Jacobian comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum Jacobian {
    /// `|dphi/du x dphi/dv|`, differentiated symbolically.
    Auto,
    /// The author's expression.
    Stated(String),
}

/// A primitive or a mesh of them.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum Geometry {
    Quad(Quad),
    Triangle(Triangle),
    Mesh(Mesh),
}

/// A convex quadrilateral; one that is not planar splits along v0-v2.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Quad {
    pub vertices: [DVec3; 4],
    pub material: String,
}

/// A triangle.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Triangle {
    pub vertices: [DVec3; 3],
    pub material: String,
}

/// A Wavefront OBJ file, beside the scene's. Transformed by scale, then rotate (degrees about x,
/// then y, then z), then translate. Without a material, the file's MTL gives them.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Mesh {
    pub obj: String,
    pub material: Option<String>,
    pub scale: f64,
    pub rotate: DVec3,
    pub translate: DVec3,
}

/// The paths of a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampling {
    /// Digital net (default) or the paper's product lattice.
    pub sequence: Sequence,
    /// `R = 2^path_bits`. Default 12; under `product-lattice` the sum of all bits, and only that.
    pub path_bits: u32,
    /// One entry per ray; its length is D. Default: three of `bits: [8, 8]`.
    pub depths: Vec<DepthSampling>,
}

/// How path ids become points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sequence {
    /// `digital-net`
    DigitalNet,
    /// `product-lattice`
    ProductLattice,
}

/// Sampling of one ray.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DepthSampling {
    /// Resolution of each coordinate, in bits.
    pub bits: [u32; 2],
    /// The map from the unit square to directions; ignored for the primary ray, where it is an error to give one.
    pub map: Map,
}

/// The map from the unit square to directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Map {
    /// `auto`: each material's own.
    Auto,
    /// `cosine-hemisphere`
    CosineHemisphere,
    /// `uniform-hemisphere`
    UniformHemisphere,
}

/// Fraction bits of the circuit's numbers; `auto` is `None`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub struct Precision {
    pub fraction: Option<u32>,
}

/// The comparator register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub struct Comparator {
    pub bits: u32,
    pub at: ComparatorAt,
}

/// Where the comparators stand: at `(y + 1/2) h` or at `y h`, with `h = scale / 2^bits`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum ComparatorAt {
    Midpoints,
    Edges,
}

/// How the good ids are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub struct Counting {
    pub phase_bits: u32,
    pub repetitions: u32,
    pub window: Window,
    pub estimator: Estimator,
}

/// The window on the counting register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Window {
    Rect,
    Sine,
}

/// Estimators by their names in scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Estimator {
    Exact,
    MonteCarlo,
    Paper,
    PosteriorMean,
    Sine,
    AdaptiveBayes,
    RandomDepth,
    Mlae,
    Iqae,
    Miqae,
    Chebyshev,
    Qss,
    Qcoin,
    AbramsWilliams,
}

/// How the circuit is laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub struct Circuit {
    pub uncompute: Uncompute,
    pub nearest: Nearest,
}

/// When work registers are uncomputed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Uncompute {
    Keep,
    Scoped,
}

/// How the nearest intersection is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Nearest {
    Running,
    Paper,
}

/// Asked accuracy.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Accuracy {
    pub error: f64,
    pub confidence: f64,
}

/// Limits on the circuit's cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub struct Budget {
    pub qubits: Option<u64>,
    pub toffoli: Option<u64>,
}
