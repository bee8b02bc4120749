//! (front)
pub mod obj;
