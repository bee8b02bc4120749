//! Tests of pictures against physics and against other renderers, by every way to compute them.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

mod pictures {
    mod cube;
    mod glass;
    mod independent;

    mod asked_accuracy;
    mod boxes_change_nothing;
    mod checkers;
    mod counted_pictures;
    mod discs;
    mod estimated_brightness;
    mod extremes;
    mod knot_mesh_is_a_closed_tube;
    mod lamps;
    mod metals;
    mod one_run_colour;
    mod own_estimators;
    mod patterns;
    mod physics;
    mod references;
    mod same_bytes_same_counts;
    mod same_picture;
    mod searched_pictures;
    mod smooth;
    mod spheres;
    mod stopping;
    mod strata_of_thresholds;
    mod suns;
    mod vertex_colours;
}
