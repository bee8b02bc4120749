//! The compiler: from a checked scene to the oracle that the machines run, and its cost.
//!
//! The tracer of [`qrt_tracer`] is written over an arithmetic. [`compile::Builder`] is an arithmetic
//! that records: it turns the tracer into a program of reversible operations. [`oracle::Oracles`] has
//! the oracles of a scene, one for each channel and each class of its pixels:
//!
//! ```
//! use qrt_core::oracle::Oracles;
//!
//! let text = "
//! name: lamp
//! camera: { perspective: { eye: [0, 0, 4], target: [0, 0, 0], vfov: 40 } }
//! film: { width: 4, height: 4 }
//! materials: { lamp: { emitter: { radiance: [2, 1, 0] } } }
//! geometry:
//!   - triangle: { vertices: [[-1, -1, 0], [1, -1, 0], [0, 1, 0]], material: lamp }
//! sampling: { path_bits: 4, depths: [{ bits: [4, 4] }], lights: none }
//! ";
//! let scene = qrt_scene::front::parse(text, "lamp.yaml", &[], "".as_ref())?.valid;
//! let oracles = Oracles::new(&scene);
//! let red = oracles.names()[0];
//! let oracle = oracles.channel(red.channel, red.class)?;
//! // Colours are in units of this bound, the lamp's radiance.
//! assert_eq!(oracle.channels[0].scale, 2.0);
//! // A call computes the colour, compares it, and undoes both.
//! assert!(oracle.whole(0).instructions.len() > 2 * oracle.program.instructions.len());
//! assert!(oracles.costs()?.iter().all(|cost| cost.call.qubits > 4));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Where to go from here
//!
//! * [`compile`]: the builder, its passes, and the strategies that undo its work;
//! * [`oracle`]: the oracles of a path and of nearest hits;
//! * [`inspect`]: the cost of an oracle and of its parts.

#![forbid(unsafe_code)]

pub mod compile;
pub mod inspect;
pub mod oracle;
