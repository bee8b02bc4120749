//! Machines, quantum counting and rendering.
pub mod checkpoint;
pub mod counting;
pub mod machines;
pub mod image;
pub mod peak_memory;
pub mod replace_file;
#[cfg(test)]
mod scratch;
pub mod random;
