//! Tests of pictures whose primary hits are searched for: the same picture if the search does not fail, a
//! wrong one if it does, and an error if there is nothing to search with.

use crate::common::scene::{from_file, written};
use qrt::core::oracle::{MOST_FACES, NearestOracle};
use qrt::runtime::render::{Model, RenderError, RenderOptions, Rendered, Visibility, render};
use qrt::runtime::search::Guess;
use qrt::runtime::workers::Workers;
use qrt::scene::Estimator;
use qrt::scene::front;
use std::fmt::Write;
use std::num::NonZeroUsize;

fn options(model: Model, visibility: Visibility) -> RenderOptions<'static> {
    RenderOptions {
        seed: 3,
        model: Some(model),
        visibility,
        estimator: Some(Estimator::Exact),
        ..RenderOptions::default()
    }
}

/// Returns a search with a negligible failure probability.
fn surely(guess: Guess) -> Visibility {
    Visibility::Grover {
        failure: 1e-12,
        guess,
    }
}

fn differing(a: &Rendered, b: &Rendered) -> usize {
    let pixels = a.image.pixels.iter().zip(&b.image.pixels);
    pixels.filter(|(a, b)| a != b).count()
}

#[test]
fn a_search_that_does_not_fail_finds_the_tracers_picture() {
    // Fixed point loses nothing of this scene, so every way to compute a number gives the same.
    let blocks = from_file("tests/scenes/blocks.yaml", &[]);
    let traced = render(&blocks, &options(Model::Fixed, Visibility::Classical)).unwrap();
    assert!(traced.mean().iter().all(|&channel| channel > 0.1));
    assert_eq!(
        (traced.total_queries(), traced.primary_hits.searched),
        (0, None)
    );
    for model in [Model::Fixed, Model::Gates] {
        for guess in [Guess::Random, Guess::Coherent] {
            let found = render(&blocks, &options(model, surely(guess))).unwrap();
            assert!(found.image == traced.image, "{model:?}, {guess:?}");
            assert!(found.good() == traced.good());
            let searched = found.primary_hits.searched.unwrap();
            assert_eq!((searched.faces, searched.states), (8, 8));
            assert!(searched.failure <= 1e-12 && searched.toffoli > 100);
            assert!(
                found
                    .counted
                    .queries
                    .iter()
                    .all(|&queries| queries > 64 * 8)
            );
        }
    }
    // The time of uncomputation and the way to find later hits do not matter, either.
    let circuit = "circuit={ uncompute: scoped, nearest: paper }";
    let blocks = from_file("tests/scenes/blocks.yaml", &[circuit]);
    let found = render(&blocks, &options(Model::Gates, surely(Guess::Coherent))).unwrap();
    assert!(found.image == traced.image);
}

#[test]
fn a_search_that_does_not_fail_finds_what_asking_about_all_finds() {
    // In general, a table rounds differently from a constant, so the oracle itself is the reference.
    let lit = "sampling.depths=[{ bits: [8, 8] }, { bits: [6, 6], light: [6, 6] }]";
    for sets in [
        &[][..],
        &["sampling.depths=[{ bits: [8, 8] }]"],
        &[lit, "sampling.lights=auto"],
    ] {
        let room = from_file(
            "tests/scenes/box.yaml",
            &[sets, &["sampling.path_bits=6"]].concat(),
        );
        let all = render(&room, &options(Model::Fixed, Visibility::Exhaustive)).unwrap();
        assert_eq!(all.total_queries(), 13 * 11 * 64 * 6);
        assert!(all.mean().iter().all(|&channel| channel > 0.05));
        let mut queries = Vec::new();
        for guess in [Guess::Random, Guess::Coherent] {
            let found = render(&room, &options(Model::Fixed, surely(guess))).unwrap();
            assert!(found.image == all.image, "{guess:?}");
            queries.push(found.total_queries());
        }
        assert!(queries[1] < queries[0], "{queries:?}");
        let gates = render(&room, &options(Model::Gates, surely(Guess::Coherent))).unwrap();
        assert!(gates.image == all.image);
        assert_eq!(gates.total_queries(), queries[1]);
        // The picture is the tracer's, except for a few paths along edges.
        let traced = render(&room, &options(Model::Fixed, Visibility::Classical)).unwrap();
        let off = all.image.pixels.iter().zip(&traced.image.pixels);
        let off: f64 = off
            .map(|(a, b)| (0..3).map(|c| (a[c] - b[c]).abs()).sum::<f64>())
            .sum();
        let mean: f64 = traced.mean().iter().sum::<f64>() * traced.image.pixels.len() as f64;
        println!(
            "{} pixels differ, by {off} of {mean}",
            differing(&all, &traced)
        );
        assert!(off < 2e-3 * mean, "{off} of {mean}");
    }
}

#[test]
fn a_search_that_gives_up_early_paints_what_it_found() {
    let blocks = from_file("tests/scenes/blocks.yaml", &[]);
    let early = |failure: f64| {
        let guess = Guess::Random;
        render(
            &blocks,
            &options(Model::Fixed, Visibility::Grover { failure, guess }),
        )
        .unwrap()
    };
    let traced = render(&blocks, &options(Model::Fixed, Visibility::Classical)).unwrap();
    let (often, seldom) = (early(0.9), early(1e-12));
    assert!(
        differing(&often, &traced) > 100,
        "{}",
        differing(&often, &traced)
    );
    assert!(2 * often.total_queries() < seldom.total_queries());
    assert!(early(0.9).image == often.image);
}

#[test]
fn neither_threads_nor_tiles_nor_crops_change_a_search() {
    let room = from_file("tests/scenes/box.yaml", &["sampling.path_bits=5"]);
    let visibility = Visibility::Grover {
        failure: 0.2,
        guess: Guess::Coherent,
    };
    let plain = options(Model::Fixed, visibility);
    let whole = render(&room, &plain).unwrap();
    for (tile, threads) in [([1, 1], 1), ([5, 3], 3), ([13, 11], 2)] {
        let cut = RenderOptions {
            tile: Some(tile),
            workers: Workers {
                threads: NonZeroUsize::new(threads),
                ..Workers::default()
            },
            ..plain.clone()
        };
        let cut = render(&room, &cut).unwrap();
        assert!(
            (&cut.image, &cut.counted.queries) == (&whole.image, &whole.counted.queries),
            "{tile:?}"
        );
    }
    let part = RenderOptions {
        crop: Some([4, 5, 3, 2]),
        ..plain.clone()
    };
    let part = render(&room, &part).unwrap();
    assert_eq!(
        part.counted.queries[..3],
        whole.counted.queries[5 * 13 + 4..][..3]
    );
    assert_eq!(
        part.image.pixels[..3],
        whole.image.pixels[5 * 13 + 4..][..3]
    );
    let other = RenderOptions { seed: 4, ..plain };
    assert_ne!(
        render(&room, &other).unwrap().counted.queries,
        whole.counted.queries
    );
}

#[test]
fn neighbouring_pixels_guess_for_each_other_however_the_film_is_cut() {
    // One path a pixel: there is no path before it to guess from.
    let room = from_file("tests/scenes/box.yaml", &["sampling.path_bits=0"]);
    let with = |guess: Guess, tile: Option<[u32; 2]>, crop: Option<[u32; 4]>| {
        let visibility = Visibility::Grover {
            failure: 1e-3,
            guess,
        };
        let options = RenderOptions {
            tile,
            crop,
            ..options(Model::Fixed, visibility)
        };
        render(&room, &options).unwrap()
    };
    let [random, coherent] = [Guess::Random, Guess::Coherent].map(|guess| with(guess, None, None));
    let queries = |rendered: &Rendered| rendered.total_queries() as f64;
    assert!(
        queries(&coherent) < 0.95 * queries(&random),
        "{} of {}",
        queries(&coherent),
        queries(&random)
    );
    for tile in [[1, 1], [3, 2], [7, 11], [13, 1]] {
        let cut = with(Guess::Coherent, Some(tile), None);
        assert!((&cut.image, &cut.counted.queries) == (&coherent.image, &coherent.counted.queries));
    }
    // A part whose left neighbours are not in the picture.
    let part = with(Guess::Coherent, None, Some([6, 2, 5, 4]));
    for row in 0..4 {
        assert_eq!(
            part.counted.queries[5 * row..][..5],
            coherent.counted.queries[13 * (row + 2) + 6..][..5]
        );
    }
}

#[test]
fn a_checkpoint_of_another_search_is_not_gone_on_from() {
    let blocks = from_file("tests/scenes/blocks.yaml", &["sampling.path_bits=2"]);
    let path = std::env::temp_dir().join(format!("qrt-searched-{}", std::process::id()));
    let with = |visibility: Visibility| RenderOptions {
        checkpoint: Some(path.clone()),
        resume: true,
        ..options(Model::Fixed, visibility)
    };
    let first = render(&blocks, &with(surely(Guess::Random))).unwrap();
    let again = render(&blocks, &with(surely(Guess::Random))).unwrap();
    assert_eq!(again.resumed_paths, 16 * 16 * 4);
    assert!((again.image, again.counted.queries) == (first.image, first.counted.queries));
    for other in [
        surely(Guess::Coherent),
        Visibility::Exhaustive,
        Visibility::Classical,
    ] {
        let error = render(&blocks, &with(other)).unwrap_err();
        assert!(
            matches!(error, RenderError::Checkpoint(_)),
            "{other:?}: {error}"
        );
    }
    std::fs::remove_file(path).unwrap();
}

#[test]
fn what_cannot_be_searched_is_refused() {
    let blocks = from_file("tests/scenes/blocks.yaml", &[]);
    let refused = |options: RenderOptions<'_>| {
        let error = render(&blocks, &options).unwrap_err();
        assert!(error.is_refusal());
        error.to_string()
    };
    let text = refused(options(Model::Real, Visibility::GROVER));
    assert!(text.contains("use `fixed` or `gates`"), "{text}");
    let text = refused(RenderOptions {
        estimator: Some(Estimator::Sine),
        ..options(Model::Fixed, Visibility::Exhaustive)
    });
    assert!(
        text.contains("the estimator `sine` counts paths in superposition"),
        "{text}"
    );
    for failure in [0.0, 1.0, -1.0, f64::NAN] {
        let guess = Guess::Random;
        let text = refused(options(Model::Fixed, Visibility::Grover { failure, guess }));
        assert!(
            text.contains("a search cannot fail with probability"),
            "{text}"
        );
    }
}

#[test]
fn without_faces_there_is_nothing_to_ask() {
    let text = "
name: nothing
camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 1 } }
film: { width: 2, height: 2 }
materials: {}
geometry: []
";
    let scene = written(text, &[]);
    assert!(NearestOracle::new(&scene).unwrap().is_none());
    for model in [Model::Fixed, Model::Gates] {
        let rendered = render(&scene, &options(model, Visibility::GROVER)).unwrap();
        assert_eq!(rendered.mean(), [0.0; 3]);
        assert_eq!(
            (rendered.total_queries(), rendered.primary_hits.searched),
            (0, None)
        );
    }
}

#[test]
fn more_faces_than_a_table_holds_are_refused() {
    let mut grid = String::new();
    // Two triangles a cell.
    let side = 182;
    for y in 0..=side {
        for x in 0..=side {
            writeln!(grid, "v {x} {y} {}", (7 * x + 13 * y + x * y) % 17).unwrap();
        }
    }
    for y in 0..side {
        for x in 1..=side {
            let (a, b) = (y * (side + 1) + x, (y + 1) * (side + 1) + x);
            writeln!(grid, "f {a} {} {b}\nf {} {} {b}", a + 1, a + 1, b + 1).unwrap();
        }
    }
    assert!(2 * side * side > MOST_FACES);
    let folder = std::env::temp_dir().join(format!("qrt-grid-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("grid.obj"), grid).unwrap();
    let text = "
name: grid
camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 1 } }
film: { width: 1, height: 1 }
materials: { grey: { lambertian: { albedo: [0.5, 0.5, 0.5] } } }
geometry: [mesh: { obj: grid.obj, material: grey }]
sampling: { path_bits: 2, depths: [{ bits: [1, 1] }] }
";
    let loaded = front::parse(text, "grid.yaml", &[], &folder).unwrap();
    let error = NearestOracle::new(&loaded.valid).unwrap_err();
    let report = loaded.report(vec![error.problem()]).to_string();
    for expected in ["error[QRT0612]: the scene has 6", "use a coarser mesh"] {
        assert!(report.contains(expected), "{report}");
    }
    std::fs::remove_dir_all(folder).unwrap();
}

/// The eye is on a face, on an edge and at a corner of the faces that it sees, or the film is on a face: rays
/// do not meet the faces on which they start.
#[test]
fn a_search_does_not_meet_the_face_on_which_the_eye_stands() {
    let cameras = [
        "perspective: { eye: [0, 0, 0], target: [0, 0.3, -1], vfov: 20 }",
        // On a slanted face, whose plane rounding moves.
        "perspective: { eye: [0.3, 0.1, 0.7], target: [0, 0.4, -1], vfov: 20 }",
        "perspective: { eye: [-1, 0, 0], target: [0, 0.3, -1], vfov: 20 }",
        "perspective: { eye: [-1, 0, 1], target: [0, 0.5, -1], vfov: 20 }",
        "orthographic: { eye: [0.25, 0.8, 1], target: [0.25, 0.8, -1], height: 0.5 }",
    ];
    for camera in cameras {
        let text = format!(
            "name: eye-on-face\ncamera: {{ {camera} }}\nfilm: {{ width: 2, height: 2 }}\nmaterials:\n  white: \
             {{ lambertian: {{ albedo: [0.5, 0.5, 0.5] }} }}\n  lamp: {{ emitter: {{ radiance: [2, 2, 2] }} \
             }}\ngeometry:\n  - quad: {{ vertices: [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], material: \
             white }}\n  - quad: {{ vertices: [[-1, 0, 1], [-1, 0, -1], [-1, 2, -1], [-1, 2, 1]], material: white \
             }}\n  - quad: {{ vertices: [[-1, 0, 1], [-1, 2, 1], [1, 2, 1], [1, 0, 1]], material: white }}\n  - \
             triangle: {{ vertices: [[0, 0, 1], [0.6, 0, 1], [0.3, 0.3, 0.1]], material: white }}\n  - quad: {{ \
             vertices: [[-9, -9, -3], [9, -9, -3], [9, 9, -3], [-9, 9, -3]], material: lamp }}\nsampling: {{ \
             path_bits: 4, depths: [{{ bits: [4, 4] }}] }}\n"
        );
        let scene = written(&text, &[]);
        let visibilities = [
            (Model::Real, Visibility::Classical),
            (Model::Fixed, Visibility::Classical),
            (Model::Fixed, Visibility::Exhaustive),
            (Model::Fixed, surely(Guess::Random)),
            (Model::Gates, surely(Guess::Coherent)),
        ];
        for (model, visibility) in visibilities {
            let found = render(&scene, &options(model, visibility)).unwrap();
            assert_eq!(found.mean(), [2.0; 3], "{camera} {model:?} {visibility:?}");
        }
    }
}
