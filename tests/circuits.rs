//! Tests of a scene's circuit: it is correct, checked, no larger than the scene requires, and exported as it is.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

mod circuits {
    mod openqasm;
    mod paths;
    mod rays;
    mod simulate;

    mod bound_programs;
    mod coarse_scenes;
    mod coplanar_faces;
    mod every_width;
    mod export_command;
    mod fronts;
    mod mean_phase;
    mod models_agree;
    mod nearest_hits;
    mod only_what_the_scene_requires;
    mod random_scenes;
    mod strategies;
    mod the_checker_is_checked;
    mod the_counting_circuit;
    mod the_shortcut_is_exact;
    mod verify_command;
    mod what_registers_hold;
}
