//! Path machines, rendering, pictures and files.
pub mod checkpoint;
pub mod disk;
pub mod draw;
pub mod image;
pub mod layouts;
pub mod memory;
pub mod mitsuba;
mod named;
pub mod path_machines;
pub mod physical;
pub mod plan;
pub mod playground;
pub mod predicates;
pub mod render;
pub mod replace_file;
pub mod sample;
#[cfg(test)]
mod scratch;
pub mod search;
pub mod shell;
pub mod trade;
pub mod verify;
pub mod workers;

/// Name of this build: a hash of the sources that decide a picture's bits. A build does not
/// continue the unfinished work of another build, even of the same version.
pub(crate) const BUILD: &str = env!("QRT_BUILD");
