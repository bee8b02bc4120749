//! Meshes from glTF 2 files, as text or as one binary file, with their materials.
//!
//! The crate `gltf` reads the JSON text and checks the indices in it. The functions of that crate
//! that read binary data trust offsets and lengths, so this module has its own.

#[cfg(not(feature = "gltf"))]
mod missing;
#[cfg(feature = "gltf")]
mod reader;
#[cfg(all(test, feature = "gltf"))]
mod tests;

#[cfg(not(feature = "gltf"))]
pub(super) use missing::parse;
#[cfg(feature = "gltf")]
pub(super) use reader::parse;
