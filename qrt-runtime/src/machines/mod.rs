//! Machines: what runs the tracer.
//!
//! [`Real`] reads it over lanes of `f64`: pictures, meshes, and the limit that every finite width
//! converges to. [`Gates`] executes the circuit that it is compiled to, gate by gate.

mod bvh;
mod gates;
mod instructions;
mod lanes;
mod real;
mod span;

pub use gates::{Dirty, Gates, InvalidGate, LANES, Rows};
pub use instructions::InstructionSet;
pub use real::{Block, PixelSum, Points, Real, Simd};
pub use span::Span;
