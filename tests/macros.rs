//! Tests of `qrt!` and `#[reversible]`: their results are the scene, the circuit and the function that
//! were written.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod macros {
    mod compiled_scenes;
    mod macro_scene;
    mod predicates;
    mod reversible;
    mod textbook;
    mod whole_registers;
    mod widths_and_types;
}
