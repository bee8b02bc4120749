//! The scene language: from a text or from Rust values to a checked scene.
//!
//! * [`Scene`] is plain data, as its author wrote it; each of its parts is defined once, with its keys,
//!   defaults, ranges and documentation.
//! * [`front`] reads YAML and meshes (OBJ and MTL, PLY, glTF). [`qrt_syntax`] has the trees with places and
//!   the problems that a scene can have, [`qrt_syntax::expr`] the expressions of user-defined BSDFs.
//! * [`valid`] checks a scene and reports all errors at once. A [`valid::ValidScene`] is the only way to
//!   the crates above.
//! * [`sampling`] maps path indices to points of the unit cube, and [`lights`] bounds light sampling.
//! * [`schema`] writes the JSON Schema of the language.
//!
//! ```
//! let text = "
//! name: lamp
//! camera: { perspective: { eye: [0, 0, 2], target: [0, 0, 0], vfov: 40 } }
//! film: { width: 2, height: 2 }
//! materials: { lamp: { emitter: { radiance: 1 } } }
//! geometry:
//!   - triangle: { vertices: [[-1, -1, 0], [1, -1, 0], [0, 1, 0]], material: lampe }
//! ";
//! let report = qrt_scene::front::parse(text, "lamp.yaml", &[], "".as_ref()).unwrap_err();
//! assert!(report.to_string().contains("did you mean `lamp`?"));
//! ```

#![forbid(unsafe_code)]

pub mod front;
pub mod lights;
pub mod polygons;
pub mod sampling;
mod scene;
pub mod schema;
pub mod valid;

pub use scene::*;
