//! Machines, which run the tracer or the program compiled from it.
//!
//! [`Real`] runs the tracer over lanes of `f64`: for pictures, for meshes, and as the limit that
//! every finite width converges to. [`Fixed`] evaluates the program compiled from the tracer,
//! operation by operation, on integers of its registers' widths. [`Gates`] executes the circuit of
//! that program, gate by gate. [`run`] runs hand-written routines on the last two and by the
//! definition of their operations. [`statevector`] computes amplitudes: it runs the counting
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
