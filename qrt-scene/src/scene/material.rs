//! Materials: the effects of surfaces on light.

use super::record::{record, variant};
use super::reflectance::{REFLECTED, ReflectanceShape};
use super::shape::{Array, Channels, Expression, Maybe, Shape, is_auto, number};
use super::text::Data;
use super::{RADIANCE, Reflectance, Rgb};
use qrt_syntax::tree::Node;
use qrt_syntax::{Place, Problems};

variant! {
    /// The effect of a surface on light.
    #[derive(Clone, Debug, PartialEq)]
    pub enum Material = "a material";
    /// Matte, on both sides: albedo / pi.
    Lambertian(Lambertian) = "lambertian";
    /// Emits on the front: the side of (v1 - v0) x (v2 - v0), or of a disc's `normal`. Reflects as a
    /// Lambertian.
    Emitter(Emitter) = "emitter";
    /// A perfect mirror, on both sides.
    Mirror(Mirror) = "mirror";
    /// Smooth glass with Fresnel reflectance.
    Dielectric(Dielectric) = "dielectric";
    /// GGX with Fresnel 1 and separable Smith masking.
    Ggx(Ggx) = "ggx";
    /// Metal, smooth or rough: its reflectance grows to 1 towards grazing angles, by Schlick's formula.
    Metal(Metal) = "metal";
    /// Matte with a highlight: kd / pi + ks (n + 2) / (2 pi) max(0, cos a)^n about the mirror
    /// direction.
    Phong(Phong) = "phong";
    /// The author's own BSDF.
    Bsdf(Bsdf) = "bsdf";
}

record! {
    /// Matte, on both sides: albedo / pi.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Lambertian = "a lambertian material";
    /// The share of light that is reflected, in linear RGB: a colour or a pattern.
    pub albedo: Reflectance = ReflectanceShape;
}

record! {
    /// Emits on the front: the side of (v1 - v0) x (v2 - v0), or of a disc's `normal`. Reflects as a
    /// Lambertian on both sides.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Emitter = "an emitter";
    /// The radiance that leaves the front, in linear RGB. The picture's values have the same unit.
    pub radiance: Rgb = RADIANCE;
    /// The share of light that is reflected, in linear RGB: a colour or a pattern;
    /// default black.
    pub albedo: Reflectance = ReflectanceShape, or Reflectance::Uniform([0.0; 3]);
}

record! {
    /// A perfect mirror, on both sides.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Mirror = "a mirror";
    /// The share of light that is reflected, in linear RGB: a colour or a pattern.
    pub reflectance: Reflectance = ReflectanceShape;
}

record! {
    /// Smooth glass with Fresnel reflectance.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Dielectric = "a dielectric";
    /// The index of refraction of the side opposite to the normal, relative to the other.
    pub ior: f64 = number(1e-3, 1e3);
    /// Fraction of the transmitted light that each crossing of the surface keeps, in linear RGB;
    /// default white, clear glass.
    pub transmittance: Rgb = REFLECTED, or [1.0; 3];
}

impl Dielectric {
    /// Creates clear glass of the index of refraction `ior`.
    pub const fn clear(ior: f64) -> Self {
        Self {
            ior,
            transmittance: [1.0; 3],
        }
    }
}

record! {
    /// GGX with Fresnel 1 and separable Smith masking.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Ggx = "a ggx material";
    /// Roughness: above 0 (a mirror) and at most 1.
    pub alpha: f64 = number(0.0, 1.0).above();
    /// The colour of the reflection, in linear RGB: a colour or a pattern.
    pub reflectance: Reflectance = ReflectanceShape;
}

record! {
    /// Metal, smooth or rough: its reflectance grows to 1 towards grazing angles, by Schlick's formula.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Metal = "a metal";
    /// The share of light that is reflected along the normal, in linear RGB: a colour or a pattern.
    pub reflectance: Reflectance = ReflectanceShape;
    /// Roughness: 0 (smooth, the default) to 1, as that of `ggx`.
    pub alpha: f64 = number(0.0, 1.0), or 0.0;
}

record! {
    /// Matte with a highlight: kd / pi + ks (n + 2) / (2 pi) max(0, cos a)^n about the mirror
    /// direction.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Phong = "a phong material";
    /// The share kd that is reflected to all sides, in linear RGB.
    pub diffuse: Rgb = REFLECTED;
    /// The share ks of the highlight, in linear RGB. In each channel, diffuse + specular is at
    /// most 1.
    pub specular: Rgb = REFLECTED;
    /// The exponent n: the larger, the narrower the highlight.
    pub exponent: f64 = number(0.0, 1e6);
}

record! {
    /// The author's own BSDF, by expressions.
    #[derive(Clone, Debug, PartialEq, Eq, Hash)]
    pub struct Bsdf = "a bsdf";
    /// The map phi(u, v), from the unit square to unit vectors x, y, z with z along the normal.
    pub map: [String; 3] = Array::<_, 3>(Expression);
    /// `auto` (differentiated), or an expression in u, v that is then checked.
    pub jacobian: Jacobian = JacobianShape, or Jacobian::Auto;
    /// The value f, per steradian, in cos_i, cos_o, cos_a, u, v, and the point x, y, z that is hit, in
    /// units of the scene: one expression (grey) or three (red, green, blue).
    pub value: Vec<String> = Channels;
    /// The density of the map's directions, per steradian, in cos_i, cos_o, cos_a: 1 over the
    /// Jacobian, which is checked. With it, lamps can be sampled from here.
    pub pdf: Option<String> = Maybe(Expression), or None;
}

/// The source of a map's Jacobian.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Jacobian {
    /// `|dphi/du x dphi/dv|`, differentiated symbolically.
    Auto,
    /// The author's expression.
    Stated(String),
}

/// The shape of a Jacobian: `auto`, or an expression.
struct JacobianShape;

impl Shape for JacobianShape {
    type Value = Jacobian;
    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> Jacobian {
        if is_auto(node) {
            return Jacobian::Auto;
        }
        Jacobian::Stated(Expression.decode(node, at, problems))
    }
    fn fallback(&self) -> Jacobian {
        Jacobian::Auto
    }
    fn check(&self, value: &Jacobian, at: &Place<'_>, problems: &mut Problems) {
        if let Jacobian::Stated(text) = value {
            Expression.check(text, at, problems);
        }
    }
    fn encode(&self, value: &Jacobian) -> Option<Data> {
        match value {
            Jacobian::Auto => Some(Data::text("auto")),
            Jacobian::Stated(text) => Expression.encode(text),
        }
    }
    fn schema(&self) -> Data {
        Expression.schema()
    }
}
