//! Primitives: single shapes of one material.

use super::LENGTH;
use super::record::record;
use super::shape::{Array, Omitted, Text, point};
use glam::DVec3;

record! {
    /// A convex quadrilateral, scaled, then rotated, then translated; one that is not planar splits along
    /// v0-v2.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Quad = "a quad";
    /// Four points around the outline, in scene units; (v1 - v0) x (v2 - v0) is the front.
    pub vertices: [DVec3; 4] = Array::<_, 4>(point());
    /// The name of a material.
    pub material: String = Text;
    /// The factor of its size, about the origin: 1 if it is left out.
    pub scale: f64 = Omitted(LENGTH, 1.0), or 1.0;
    /// Degrees about x, then y, then z, all through the origin; default none.
    pub rotate: DVec3 = Omitted(point(), DVec3::ZERO), or DVec3::ZERO;
    /// Added to every point, in scene units; default none.
    pub translate: DVec3 = Omitted(point(), DVec3::ZERO), or DVec3::ZERO;
}

record! {
    /// A triangle, scaled, then rotated, then translated.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Triangle = "a triangle";
    /// Three points, in scene units; (v1 - v0) x (v2 - v0) is the front.
    pub vertices: [DVec3; 3] = Array::<_, 3>(point());
    /// The name of a material.
    pub material: String = Text;
    /// The factor of its size, about the origin: 1 if it is left out.
    pub scale: f64 = Omitted(LENGTH, 1.0), or 1.0;
    /// Degrees about x, then y, then z, all through the origin; default none.
    pub rotate: DVec3 = Omitted(point(), DVec3::ZERO), or DVec3::ZERO;
    /// Added to every point, in scene units; default none.
    pub translate: DVec3 = Omitted(point(), DVec3::ZERO), or DVec3::ZERO;
}

record! {
    /// A sphere, whose front is outside, scaled, then rotated, then translated.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Sphere = "a sphere";
    /// The centre, in scene units.
    pub center: DVec3 = point();
    /// The radius, in scene units.
    pub radius: f64 = LENGTH;
    /// The name of a material.
    pub material: String = Text;
    /// The factor of its size, about the origin: 1 if it is left out.
    pub scale: f64 = Omitted(LENGTH, 1.0), or 1.0;
    /// Degrees about x, then y, then z, all through the origin; default none.
    pub rotate: DVec3 = Omitted(point(), DVec3::ZERO), or DVec3::ZERO;
    /// Added to every point, in scene units; default none.
    pub translate: DVec3 = Omitted(point(), DVec3::ZERO), or DVec3::ZERO;
}

record! {
    /// A disc, the flat region within a circle, scaled, then rotated, then translated.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Disc = "a disc";
    /// The centre, in scene units.
    pub center: DVec3 = point();
    /// The direction that the front faces, of any length.
    pub normal: DVec3 = point();
    /// The radius, in scene units.
    pub radius: f64 = LENGTH;
    /// The name of a material.
    pub material: String = Text;
    /// The factor of its size, about the origin: 1 if it is left out.
    pub scale: f64 = Omitted(LENGTH, 1.0), or 1.0;
    /// Degrees about x, then y, then z, all through the origin; default none.
    pub rotate: DVec3 = Omitted(point(), DVec3::ZERO), or DVec3::ZERO;
    /// Added to every point, in scene units; default none.
    pub translate: DVec3 = Omitted(point(), DVec3::ZERO), or DVec3::ZERO;
}

record! {
    /// A box, whose fronts are outside: along the axes from `min` to `max`, then scaled, then rotated,
    /// then translated.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Cuboid = "a box";
    /// The corner with the least coordinates, in scene units.
    pub min: DVec3 = point();
    /// The corner with the greatest coordinates, in scene units.
    pub max: DVec3 = point();
    /// The factor of its size, about the origin: 1 if it is left out.
    pub scale: f64 = Omitted(LENGTH, 1.0), or 1.0;
    /// Degrees about x, then y, then z, all through the origin; default none.
    pub rotate: DVec3 = point(), or DVec3::ZERO;
    /// Added to every point, in scene units; default none.
    pub translate: DVec3 = point(), or DVec3::ZERO;
    /// The name of a material.
    pub material: String = Text;
}

impl Quad {
    /// Creates a quad of a material from four points around its outline.
    pub fn new(vertices: [DVec3; 4], material: impl Into<String>) -> Self {
        Self {
            vertices,
            material: material.into(),
            scale: 1.0,
            rotate: DVec3::ZERO,
            translate: DVec3::ZERO,
        }
    }
}

impl Triangle {
    /// Creates a triangle of a material from three points.
    pub fn new(vertices: [DVec3; 3], material: impl Into<String>) -> Self {
        Self {
            vertices,
            material: material.into(),
            scale: 1.0,
            rotate: DVec3::ZERO,
            translate: DVec3::ZERO,
        }
    }
}

impl Sphere {
    /// Creates a sphere of a material.
    pub fn new(center: DVec3, radius: f64, material: impl Into<String>) -> Self {
        Self {
            center,
            radius,
            material: material.into(),
            scale: 1.0,
            rotate: DVec3::ZERO,
            translate: DVec3::ZERO,
        }
    }
}

impl Disc {
    /// Creates a disc of a material, whose front faces along `normal`.
    pub fn new(center: DVec3, normal: DVec3, radius: f64, material: impl Into<String>) -> Self {
        Self {
            center,
            normal,
            radius,
            material: material.into(),
            scale: 1.0,
            rotate: DVec3::ZERO,
            translate: DVec3::ZERO,
        }
    }
}
