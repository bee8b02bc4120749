//! `Scene` -> [`ValidScene`], or every error at once.

pub mod bsdf;

use crate::expr::Expr;
use crate::scene::{Rgb, Scene};
use glam::DVec3;

/// A checked scene: the only way on. It can be made by [`validate`] alone.
#[derive(Clone, Debug)]
pub struct ValidScene {
    pub(crate) scene: Scene,
    pub(crate) materials: Vec<Surface>,
    pub(crate) polygons: Vec<Polygon>,
}

/// What a polygon's surface does: the scene's materials first, in their order, then those of MTL files.
#[derive(Clone, Debug)]
pub struct Surface {
    /// The name in the scene, or `FILE.mtl:NAME`.
    pub name: String,
    /// What leaves the front, W/(sr m^2) in linear RGB.
    pub radiance: Rgb,
    /// What scatters.
    pub scatter: Scatter,
}

/// How a surface scatters.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub enum Scatter {
    /// Nothing leaves: the path ends here.
    Black,
    Lambertian {
        albedo: Rgb,
    },
    Mirror {
        reflectance: Rgb,
    },
    Dielectric {
        ior: f64,
    },
    Ggx {
        alpha: f64,
        reflectance: Rgb,
    },
    Phong {
        diffuse: Rgb,
        specular: Rgb,
        exponent: f64,
    },
    Custom(Box<CustomBsdf>),
}

/// A checked BSDF of the user's own.
#[derive(Clone, Debug)]
pub struct CustomBsdf {
    /// phi(u, v)
    pub map: [Expr; 3],
    /// `J |phi_z|`, in `u`, `v`: what multiplies `value` to make the weight `f |n.i| J`. With
    /// `jacobian: auto` it is `|x_u y_v - x_v y_u|`, simplified, so that products that cancel do.
    pub projected_jacobian: Expr,
    /// f, per channel, in `cos_i`, `cos_o`, `cos_a`, `u`, `v`.
    pub value: [Expr; 3],
    /// An upper bound, per channel, of the weight `value * projected_jacobian` over its domain.
    pub weight_bound: Rgb,
}

/// A triangle or a planar convex quadrilateral in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polygon {
    /// Corners; a triangle repeats its last one.
    pub vertices: [DVec3; 4],
    /// 3 or 4.
    pub corners: u8,
    /// Index into [`ValidScene::surfaces`].
    pub surface: u32,
}

impl ValidScene {
    /// The scene as written.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }
    /// All surfaces that polygons may refer to.
    pub fn surfaces(&self) -> &[Surface] {
        &self.materials
    }
    /// All polygons.
    pub fn polygons(&self) -> &[Polygon] {
        &self.polygons
    }
}
