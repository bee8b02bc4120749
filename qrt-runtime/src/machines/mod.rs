//! Machines: what runs the tracer.
//!
//! [`Real`] reads it over lanes of `f64`: pictures, meshes, and the limit that every finite width
//! converges to. [`Fixed`] evaluates the program that it is compiled to, operation by operation, on
//! integers of its registers' widths. [`Gates`] executes the circuit of that program, gate by gate.
//! [`run`] does so with routines written by hand. [`statevector`] follows amplitudes: the counting
//! circuit around an oracle, gate by gate.

mod bvh;
mod fixed;
mod gates;
mod instructions;
mod lanes;
mod masks;
pub mod native;
mod nearest;
mod oracle;
mod pool;
mod predicate;
mod rays;
mod real;
pub mod run;
mod span;
mod state;
pub mod statevector;
mod transpose;

pub use fixed::{Extremes, Fixed, Lanes, contents};
pub use gates::{Dirty, Gates, InvalidGate, Queue, Rows, Template};
pub use instructions::{InstructionSet, InstructionsError};
pub use native::NativeOracle;
pub use nearest::{Answers, Asked, Candidate, NearestMachine};
pub use oracle::{Defect, Finished, OracleCircuits, OracleMachine, PathRun, PrimaryHits};
pub use rays::{Met, SingleRay};
pub use real::{PathBlock, PixelSum, Points, Real, Simd};
pub use span::Span;
pub use state::{State, Unclean};
