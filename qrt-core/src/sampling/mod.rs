//! (sampling)
pub mod maps;
