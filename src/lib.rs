//! qrt: quantum ray tracing.
pub use qrt_core as core;
pub use qrt_runtime as runtime;
