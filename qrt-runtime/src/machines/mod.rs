//! Machines: what runs the tracer.
//!
//! [`Real`] reads it over lanes of `f64`: pictures, meshes, and the limit that every finite width
//! converges to.

mod bvh;
mod lanes;
mod rays;
mod real;

pub use rays::{Met, SingleRay};
pub use real::{Block, PixelSum, Points, Real, Simd};
