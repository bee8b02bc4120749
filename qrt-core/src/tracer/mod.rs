//! (tracer)
