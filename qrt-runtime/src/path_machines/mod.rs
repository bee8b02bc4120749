//! Path machines: trace the paths of a scene's pixels.
//!
//! [`Real`] reads the tracer over lanes of `f64`: pictures, meshes, and the limit that every finite width
//! converges to. [`OracleMachine`] runs the scene's oracle, on [`qrt_machines::Fixed`],
//! [`qrt_machines::Gates`] or native code of [`NativeOracle`]. [`NearestMachine`] runs the search of
//! one ray's nearest face. [`run_paths`] runs an oracle that is bound to one pixel, and [`PathState`] starts
//! a [`qrt_machines::State`] at one path.

mod bvh;
mod lanes;
mod masks;
pub mod native;
mod nearest;
mod oracle;
mod path_state;
mod pool;
mod predicate;
mod rays;
mod real;
pub mod run_paths;

pub use native::NativeOracle;
pub use nearest::{Answers, Asked, Candidate, NearestMachine};
pub use oracle::{Defect, Finished, OracleCircuits, OracleMachine, PathRun, PrimaryHits};
pub use path_state::PathState;
pub use rays::{Met, SingleRay};
pub use real::{PathBlock, PixelSum, Points, Real, Simd};
