//! Path machines, rendering, pictures and files.

#![forbid(unsafe_code)]

pub mod checkpoint;
mod counted_pixels;
pub mod disk;
pub mod image;
pub mod line_file;
pub mod memory;
pub mod models;
mod named;
pub mod path_machines;
pub mod plan;
pub mod predicates;
pub mod prepared;
pub mod render;
pub mod replace_file;
pub mod sample;
#[cfg(test)]
mod scratch;
pub mod search;
#[cfg(feature = "parts")]
mod serialized;
pub mod traced_path;
pub mod workers;

pub use prepared::Prepared;

/// Name of this build: a hash of the sources that decide a picture's bits. A build does not
/// continue the unfinished work of another build, even of the same version.
pub const BUILD: &str = env!("QRT_BUILD");
