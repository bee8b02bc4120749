//! The paper's Path Tracing frame, stated once.
//!
//! [`trace`] is the complete frame: *Generate Ray*, then per depth *Find Intersection*, emission
//! and scattering. It is generic over the trait [`Arith`], so that one source has several uses:
//! over lanes of `f64` it renders pictures, over a circuit builder it records a reversible program.
//! Both run the same code, so they cannot diverge.
//!
//! A [`Stage`] is the scene prepared for it: planes with the polygons that lie on them,
//! shading frames, tables over sample indices, and the bound on a path's colour.
//!
//! The colour of a path (the paper's `color_id`) is
//!
//! ```text
//! colour = sum_k  Le(hit_k) * prod_{j<k} W_j,      W = f(i, o) |n.i| J
//! ```
//!
//! where `i` is the sampled direction towards the light, `o` the direction towards the viewer,
//! `f` the BSDF and `J = |phi_u x phi_v|` the Jacobian of the map `phi` from the unit square to
//! directions.

#[macro_use]
mod math;

mod arith;
mod ball;
mod ball_ray;
mod bound;
mod bsdf;
mod camera;
mod checker;
mod compiled;
mod convex;
mod crossing;
mod face_table;
mod frame;
mod geometry;
mod intersect;
mod lamp_shapes;
mod lighting;
mod lights;
mod paper;
mod pixel_class;
mod places;
mod polygon;
mod radiance;
mod ray;
mod refraction;
mod sampled;
#[cfg(test)]
mod scalar;
mod search;
mod sky;
mod smooth;
mod stage;
mod sun;
pub(crate) mod vector;

pub use arith::{Arith, Axis, Coordinate, Named, Quantity, Segment, TracerPart, Work};
pub use ball::StageBall;
pub use ball_ray::BallRay;
pub use camera::CameraStage;
pub use crossing::{AxisPermuted, Crossing, between, cross, weighted};
pub use face_table::FaceTable;
pub(crate) use face_table::PrimaryHitGiven;
pub use frame::trace;
pub use geometry::{Face, INWARD, NO_FACE, NO_PLANE, StageGeometry, TOLERANCE};
pub use intersect::DiscNumbers;
pub(crate) use paper::Records;
pub use pixel_class::{ByClass, PixelClass, PixelClasses};
pub use polygon::{DiscTest, EdgeTest, FaceFrame, Plane};
pub use ray::{Hit, NearestSearch, Ray, Start};
pub use sampled::Sampled;
pub(crate) use search::Search;
pub(crate) use smooth::SmoothStage;
pub use stage::{Stage, WideValue};
