//! The Rust listings of the book: every ```` ```rust ```` block of every page is a test.
//!
//! `cargo test -p qrt-book-listings` runs them. A page that is added to the book's `SUMMARY.md` gets
//! a line here; the test below says so.

#![forbid(unsafe_code)]

macro_rules! pages {
    ($($name:ident = $file:literal,)*) => {
        /// The pages whose listings are tests.
        pub const PAGES: &[&str] = &[$($file),*];

        $(
            #[cfg(doctest)]
            #[doc = include_str!(concat!("../../src/", $file))]
            mod $name {}
        )*
    };
}

pages! {
    introduction = "introduction.md",
    first_picture = "first-picture.md",
    one_pixel = "one-pixel.md",
    simulator = "simulator.md",
    quantum_computing = "quantum-computing.md",
    path_tracing = "path-tracing.md",
    superposition = "superposition.md",
    sampling = "sampling.md",
    intersection = "intersection.md",
    shading = "shading.md",
    lights = "lights.md",
    meshes = "meshes.md",
    spheres = "spheres.md",
    comparator = "comparator.md",
    oracle = "oracle.md",
    grover = "grover.md",
    counting = "counting.md",
    estimators = "estimators.md",
    mean_phase = "mean-phase.md",
    speed_up = "speed-up.md",
    cost = "cost.md",
    accuracy = "accuracy.md",
    extremes = "extremes.md",
    open_problems = "open-problems.md",
    what_qrt_draws = "what-qrt-draws.md",
    yaml = "yaml.md",
    format = "format.md",
    macros = "macros.md",
    predicates = "predicates.md",
    cli = "cli.md",
    playground = "playground.md",
    clusters = "clusters.md",
    python = "python.md",
    renderers = "renderers.md",
    error_codes = "error-codes.md",
    internals = "internals.md",
    equations = "equations.md",
    errata = "errata.md",
    related_work = "related-work.md",
    glossary = "glossary.md",
    list_of_figures = "list-of-figures.md",
    summary_card = "summary.md",
}

/// The program that the chapter "One pixel, from nothing" builds.
#[cfg(test)]
#[path = "../../../examples/one_pixel.rs"]
#[allow(
    dead_code,
    reason = "the program's own `main`, and what only figures read"
)]
mod one_pixel_program;

#[cfg(test)]
mod tests {
    use super::{PAGES, one_pixel_program};
    use std::collections::BTreeSet;
    use std::path::Path;

    #[test]
    fn every_page_of_the_book_is_tested() {
        let book = Path::new(env!("CARGO_MANIFEST_DIR")).join("../src");
        let summary = std::fs::read_to_string(book.join("SUMMARY.md")).unwrap();
        let links = summary.split("](").skip(1);
        let listed: BTreeSet<&str> = links.filter_map(|link| link.split(')').next()).collect();
        assert!(listed.len() > 20 && listed.iter().all(|page| page.strip_suffix(".md").is_some()));
        assert_eq!(listed, PAGES.iter().copied().collect());
        assert_eq!(listed.len(), PAGES.len(), "a page stands here twice");
    }

    /// The chapter's program runs, and says what the page says that it says.
    #[test]
    fn the_pixel_is_built_as_the_page_says() {
        let lines = one_pixel_program::report().unwrap();
        let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../src/one-pixel.md");
        let page = std::fs::read_to_string(page).unwrap();
        let told = format!("```text\n{}\n```", lines.join("\n"));
        assert!(page.contains(&told), "the page does not have\n{told}");
    }
}
