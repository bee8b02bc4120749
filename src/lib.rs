//! Quantum ray tracing: scenes as countable sets of paths.
//!
// docs/gallery/lit-box-gates.png as a JPEG of 9 KB, in the text itself: rustdoc copies no pictures, and the
// pages load nothing from elsewhere. Only rustdoc reads it.
#![cfg_attr(doc, doc = include_str!("picture.html"))]
//!
//! qrt compiles a scene into a reversible quantum circuit that traces all its light paths in
//! superposition, and renders the picture that quantum counting over this circuit would measure.
//!
//! * **No quantum computer is needed.** The picture above was made by executing every gate of the
//!   circuit, at most 82,470 Toffolis and 46,000 qubits a channel, for each of its four million
//!   paths.
//! * **It works, gate by gate.** qrt implements "A Framework for Quantum Ray Tracing" by Lu & Lin
//!   ([arXiv:2203.15451](https://arxiv.org/abs/2203.15451)). The framework works once [eleven
//!   errata](https://github.com/qrt-rs/qrt/blob/main/book/src/errata.md) are corrected.
//! * **It has a price, and qrt reports it.** A 64 x 64 picture of the Cornell box without sampled
//!   lamps, with an error of 1 %, would take 217 million physical qubits for 6.1 years.
//!
//! In a clone of the [repository](https://github.com/qrt-rs/qrt), the first command renders a
//! picture, `lit-box.png`, the second runs the tests, and the third simulates all amplitudes of a
//! counting circuit of 20 qubits and compares them with theory:
//!
//! ```sh
//! cargo run --release -- render scenes-yaml/lit-box.yaml --exposure 1
//! cargo test
//! cargo run --release -- simulate scenes-yaml/small/edge.yaml --pixel 1,0
//! ```
//!
//! # The library
//!
//! A scene is written in YAML, or in Rust by the macro [`qrt!`]. For each pixel qrt traces the
//! `2^path_bits` paths that the circuit traces in superposition, and estimates their mean colour as
//! quantum counting would. The command `qrt render` is a front end of this library:
//!
//! ```
//! use qrt::prelude::*;
//!
//! let text = "
//! name: lit-floor
//! camera: { perspective: { eye: [0, 1, 2], target: [0, 0, 0], vfov: 45 } }
//! film: { width: 8, height: 8 }
//! materials:
//!   floor: { lambertian: { albedo: [0.8, 0.5, 0.2] } }
//!   sky: { emitter: { radiance: [1, 1, 1] } }
//! geometry:
//!   - quad: { vertices: [[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]], material: floor }
//!   - quad: { vertices: [[-900, 5, -900], [900, 5, -900], [900, 5, 900], [-900, 5, 900]], material: sky }
//! sampling: { path_bits: 8, depths: [{ bits: [8, 8] }, { bits: [8, 8] }], lights: none }
//! ";
//! // All errors of a scene are reported at once, with their places.
//! let scene = parse(text, "lit-floor.yaml", &[], "".as_ref())?.valid;
//!
//! // All paths of every pixel: under so wide a sky, a floor shows its albedo.
//! let exact = RenderOptions { estimator: Some(Estimator::Exact), ..RenderOptions::default() };
//! let rendered = render(&scene, &exact)?;
//! let [red, green, blue] = rendered.image.pixels[8 * 4 + 4];
//! assert!((red - 0.8).abs() < 0.01 && (green - 0.5).abs() < 0.01 && (blue - 0.2).abs() < 0.01);
//!
//! // The same by quantum counting, the scene's default, with the noise of its measurements.
//! let counted = render(&scene, &RenderOptions { seed: 7, ..RenderOptions::default() })?;
//! assert!(counted.total_queries() > 0);
//!
//! let path = std::env::temp_dir().join(format!("qrt-facade-{}.exr", std::process::id()));
//! counted.save(&path)?;
//! # std::fs::remove_file(path).ok();
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The feature `cli`, which is the default, contains all others: `png` and `exr` write pictures of
//! these kinds, `gltf` reads meshes of glTF files, `parts` renders a picture in parts and merges
//! them, `serde` reads and writes scenes and their parts, and `lab` studies a scene: it checks its
//! circuit, measures its error, estimates physical resources, draws, and exports to Mitsuba 3. With
//! `default-features = false` a crate builds none of the dependencies of these features.
//!
//! [`scene`] reads and checks scenes, and [`syntax`] reports their problems. [`tracer`] traces paths over any
//! arithmetic, and [`core`] compiles the tracer's operations to a scene's oracle. [`machines`] run circuits,
//! [`counting`] estimates amplitudes, and [`runtime`] renders pictures and writes files. [`drawing`] draws.
//!
//! # Where to go from here
//!
//! * [`prelude`]: the names to load a scene, render it and save the picture;
//! * [`qrt!`]: a scene as a type, with its circuit's cost as constants;
//! * [`reversible`]: a function that becomes gates, with a generated inverse;
//! * [`circuit::quantum`]: phase oracles, Grover's iterate and counting, gate by gate;
//! * [the book](https://github.com/qrt-rs/qrt/blob/main/book/src/introduction.md), from the
//!   rendering equation to a counted picture, with each of the paper's equations beside its code and
//!   test; `cargo book serve` builds it. Its chapter "One pixel, from nothing" writes a quantum ray
//!   tracer of a hundred lines, which is
//!   [`examples/one_pixel.rs`](https://github.com/qrt-rs/qrt/blob/main/examples/one_pixel.rs).

#![forbid(unsafe_code)]

/// Tests the README's examples.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// Points and directions: the vectors that scenes are written with, in the version that qrt uses.
///
/// ```
/// use qrt::scene::Perspective;
/// let eye = qrt::glam::DVec3::new(0.0, 1.0, 2.0);
/// let camera = Perspective { eye, ..Perspective::default() };
/// assert_eq!(camera.eye.length_squared(), 5.0);
/// ```
pub use glam;
/// Reversible circuits: registers, operations, programs, gates and their costs.
pub use qrt_circuit as circuit;
pub use qrt_core as core;
pub use qrt_counting as counting;
pub use qrt_drawing as drawing;
#[cfg(feature = "lab")]
pub use qrt_lab as lab;
pub use qrt_machines as machines;
#[doc = include_str!("scene_macro.md")]
pub use qrt_macros::qrt;
#[doc = include_str!("reversible.md")]
pub use qrt_macros::reversible;
pub use qrt_runtime as runtime;
/// The scene language: scenes, their checks, and the sequences of paths.
pub use qrt_scene as scene;
/// Syntax trees with places, problems and their reports, expressions.
pub use qrt_syntax as syntax;
pub use qrt_tracer as tracer;

/// Names of the standard library in the code of the macros: a crate without it has no `::std`.
#[doc(hidden)]
pub extern crate std as __std;

pub mod prelude;
