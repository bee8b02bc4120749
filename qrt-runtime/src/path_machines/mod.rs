//! Path machines: trace the paths of a scene's pixels.
//!
//! A [`PathMachine`] traces the paths of pixels; [`crate::models`] makes the one of a model.
//! [`Real`] reads the tracer over lanes of `f64`: pictures, meshes, and the limit that every finite width
//! converges to. [`OracleMachine`] runs the scene's oracle, on [`qrt_machines::FixedMachine`] or
//! [`qrt_machines::GatesMachine`]. [`NearestMachine`] runs the search of one ray's nearest face. [`run_paths`]
//! runs an oracle that is bound to one pixel, and [`PathState`] starts a [`qrt_machines::State`] at one
//! path.

mod bvh;
mod lanes;
mod masks;
mod nearest;
mod oracle;
mod path_machine;
mod path_numbers;
mod path_state;
mod pool;
mod predicate;
mod rays;
mod real;
pub mod run_paths;

pub use nearest::{Answers, Candidate, NearestMachine, NearestQuery};
pub use oracle::{Defect, Finished, OracleCircuits, OracleMachine, PathRun, PrimaryHits};
pub use path_machine::{PathMachine, QueryCost, Traced};
pub use path_state::PathState;
pub use rays::{Met, SingleRay};
pub use real::{PathBlock, PixelSum, Points, Real, Simd};
