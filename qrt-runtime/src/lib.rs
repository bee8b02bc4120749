//! Machines, quantum counting and rendering.
pub mod counting;
pub mod random;
