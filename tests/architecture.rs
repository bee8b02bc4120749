//! Checks that the sources are built as ARCHITECTURE.md says.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod architecture {
    mod no_circles_of_files;
    mod pages_name_the_rust_version;
    mod rooms_import_downwards;
    mod the_prelude_has_examples;
}
