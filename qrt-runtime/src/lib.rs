//! Machines, quantum counting and rendering.
pub mod checkpoint;
pub mod counting;
pub mod disk;
pub mod draw;
pub mod estimators;
pub mod image;
pub mod machines;
mod named;
pub mod peak_memory;
pub mod plan;
pub mod random;
pub mod render;
pub mod replace_file;
pub mod sample;
#[cfg(test)]
mod scratch;
pub mod search;
pub mod trade;
pub mod verify;
pub mod workers;
