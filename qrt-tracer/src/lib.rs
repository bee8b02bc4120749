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
//! ```
//! use qrt_tracer::{PixelClass, Stage};
//!
//! let text = "
//! name: lamp
//! camera: { perspective: { eye: [0, 0, 4], target: [0, 0, 0], vfov: 40 } }
//! film: { width: 4, height: 4 }
//! materials: { lamp: { emitter: { radiance: [2, 1, 0] } } }
//! geometry:
//!   - triangle: { vertices: [[-1, -1, 0], [1, -1, 0], [0, 1, 0]], material: lamp }
//! sampling: { path_bits: 4, depths: [{ bits: [4, 4] }, { bits: [4, 4] }], lights: none }
//! ";
//! let scene = qrt_scene::front::parse(text, "lamp.yaml", &[], "".as_ref())?.valid;
//! let stage = Stage::rgb(&scene, PixelClass::MayMeetLamp);
//! // Two rays on a path, of which none brings more than the lamp's radiance.
//! assert_eq!((stage.depths(), stage.bound()), (2, [2.0, 1.0, 0.0]));
//! // The lamp is on the only plane, and faces the camera.
//! assert_eq!((stage.geometry().planes.len(), stage.normal(0)), (1, [0.0, 0.0, 1.0]));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
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
//!
//! # Where to go from here
//!
//! * [`Arith`]: the operations that an arithmetic provides. `qrt-runtime` implements it for lanes of
//!   `f64`, and `qrt-core` for the builder of circuits;
//! * [`NearestSearch`]: the search for hits that a trace uses. [`StageGeometry`] asks every plane,
//!   [`Stage::search`] only those that a ray can meet, and [`Stage::recorded_search`] keeps the paper's
//!   full records;
//! * [`FaceTable`]: faces whose number is in superposition;
//! * [`PixelClasses`]: the pixels that may see a lamp, and those that cannot.

#![forbid(unsafe_code)]

#[macro_use]
mod math;

mod arith;
mod ball;
mod ball_ray;
mod bound;
mod bsdf;
mod camera;
mod checker;
mod colours;
mod compiled;
mod convex;
mod corners;
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
mod vector;

pub use arith::{Arith, Axis, Coordinate, Named, Quantity, Segment, TracerPart, Work};
pub use ball::StageBall;
pub use ball_ray::BallRay;
pub use camera::CameraStage;
pub use corners::Corners;
pub use crossing::{AxisPermuted, Crossing, between, cross, weighted};
pub use face_table::{FaceTable, PrimaryHitGiven};
pub use frame::trace;
pub use geometry::{Face, INWARD, NO_FACE, NO_PLANE, StageGeometry, TOLERANCE};
pub use intersect::DiscNumbers;
pub use pixel_class::{ByClass, PixelClass, PixelClasses};
pub use polygon::{DiscTest, EdgeTest, FaceFrame, Plane};
pub use ray::{Hit, NearestSearch, Ray, Start};
pub use sampled::Sampled;
pub use stage::{Stage, WideValue};
pub use vector::dot;
