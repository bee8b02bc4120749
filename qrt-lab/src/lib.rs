//! Studies of a scene: checks of its circuit, measurements, costs, drawings and exports.
//!
//! Rendering needs none of them. Each module takes a checked scene, a
//! [`ValidScene`](qrt_scene::valid::ValidScene), and answers one question about it. The first question
//! is whether the circuit computes the picture. [`verify()`](verify::verify) runs the same paths on
//! the machines `real`, `fixed` and `gates`, and compares them; a [`verify::VerifyReport`] says what it
//! found. The next question is what the picture would take on a quantum computer.
//! [`physical::PictureCounts`] counts its qubits and gates:
//!
//! ```
//! use qrt_core::oracle::Oracles;
//! use qrt_lab::physical::PictureCounts;
//! use qrt_lab::verify::{self, verify};
//!
//! let text = "
//! name: lit-floor
//! camera: { perspective: { eye: [0, 1, 2], target: [0, 0, 0], vfov: 45 } }
//! film: { width: 4, height: 4 }
//! materials:
//!   floor: { lambertian: { albedo: [0.8, 0.5, 0.2] } }
//!   sky: { emitter: { radiance: [1, 1, 1] } }
//! geometry:
//!   - quad: { vertices: [[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]], material: floor }
//!   - quad: { vertices: [[-9, 5, -9], [9, 5, -9], [9, 5, 9], [-9, 5, 9]], material: sky }
//! sampling: { path_bits: 4, depths: [{ bits: [6, 6] }, { bits: [6, 6] }], lights: none }
//! comparator: { bits: 6 }
//! counting: { phase_bits: 5 }
//! ";
//! let scene = qrt_scene::front::parse(text, "lit-floor.yaml", &[], "".as_ref())?.valid;
//!
//! let report = verify(&scene, &verify::VerifyOptions { pixels: 2, ..Default::default() })?;
//! assert!(report.holds());
//! // Every qubit except those of the path index was zero again after each of these paths.
//! assert_eq!(report.paths, 2 << 4);
//!
//! let oracles = Oracles::new(&scene);
//! let red = oracles.names()[0];
//! let counts = PictureCounts::for_scene(&oracles, red, None)?;
//! assert!(counts.film.unitary.toffoli > counts.pixel.unitary.toffoli);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Where to go from here
//!
//! * [`trade`]: speed against accuracy. It measures each source of error and the effect of each
//!   parameter, and writes a table, plots and a page;
//! * [`layouts`]: qubits against gates, under every strategy of the compiler;
//! * [`inspect`]: the costs of an oracle and of its parts;
//! * [`simulate`]: a pixel's complete counting circuit, run as amplitudes;
//! * [`count`]: the outcomes of the phase register for S of N, without a scene;
//! * `json` (feature `json`): the figures of all of these as JSON;
//! * [`draw`]: an inspected oracle and small circuits as drawings;
//! * [`compare`]: the difference of two pictures, as numbers and as a picture;
//! * [`mitsuba`]: a scene for the renderer Mitsuba 3, which checks qrt independently;
//! * [`playground`]: answers to the page on which a scene is written;
//! * [`shell`]: file names in commands that messages suggest.

#![forbid(unsafe_code)]

pub mod compare;
pub mod count;
pub mod draw;
pub mod inspect;
#[cfg(feature = "json")]
pub mod json;
pub mod layouts;
pub mod mitsuba;
pub mod physical;
pub mod playground;
#[cfg(test)]
#[path = "../../qrt-runtime/src/scratch.rs"]
mod scratch;
pub mod shell;
pub mod simulate;
pub mod trade;
pub mod verify;
