//! Programs that read paths, by a scene's compiled circuit or in a predicate, and the texts that their helps
//! replace.

use super::Applied;

pub(super) const COMPILED: &[Applied] = &[(
    "field_of_another_scene",
    &[("Other::LAYOUT", "Room::LAYOUT")],
)];

pub(super) const COMPILED_NOT_APPLIED: [(&str, &str); 3] = [
    ("id_changes_within", OF_THE_LANGUAGE),
    ("register_is_changed", OF_THE_LANGUAGE),
    ("register_leaves_within", OF_THE_LANGUAGE),
];

pub(super) const PREDICATES: &[Applied] = &[
    (
        "name_unknown",
        &[("MATERIALS.whit", "MATERIALS.white"), ("flor;", "floor;")],
    ),
    ("of_a_ray_that_is_not_traced", &[("path.ray1", "path.ray0")]),
    (
        "of_no_scene",
        &[(
            "struct Room;",
            "qrt! { scene Room from \"scenes/lit.yaml\" }",
        )],
    ),
    ("ray_beyond_the_last", &[("path.ray2", "path.ray0")]),
];

pub(super) const PREDICATES_NOT_APPLIED: [(&str, &str); 2] = [
    ("changes_the_path", OF_THE_LANGUAGE),
    ("register_of_another_width", OF_THE_LANGUAGE),
];

/// The reason of programs that the language refuses by the types of registers.
const OF_THE_LANGUAGE: &str = "the message is the language's own, without a help";
