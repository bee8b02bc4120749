//! Tests that the example scenes are valid, and that their comments are true.

use qrt_runtime::path_machines::Real;
use qrt_scene::front::load;
use qrt_scene::valid::ValidScene;
use qrt_syntax::{Problem, Report};
use std::path::PathBuf;

// Its `main` is the program's alone.
#[allow(dead_code)]
#[path = "../../examples/weekend.rs"]
mod weekend;

/// The file of the cover is what its program writes.
#[test]
fn the_cover_is_written_by_its_program() {
    let file = std::fs::read_to_string(folder().join("weekend.yaml")).unwrap();
    assert!(
        file == weekend::text(),
        "write it anew: cargo run --example weekend > scenes-yaml/weekend.yaml"
    );
}

fn folder() -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "scenes-yaml"].iter().collect()
}

fn scene(name: &str, sets: &[&str]) -> Result<ValidScene, Box<Report>> {
    let sets: Vec<String> = sets.iter().map(|&set| set.to_owned()).collect();
    let path = folder().join(format!("{name}.yaml"));
    match load(&path, &sets) {
        Ok(loaded) => Ok(loaded.valid),
        Err(report) => Err(Box::new(report)),
    }
}

/// Renders the scene on a film of 16 x 16 pixels, with 2^8 paths each.
fn small(name: &str, sets: &[&str]) -> Vec<[f64; 3]> {
    let few = ["film.width=16", "film.height=16", "sampling.path_bits=8"];
    let scene = match scene(name, &[&few, sets].concat()) {
        Ok(scene) => scene,
        Err(report) => panic!("{report}"),
    };
    let pixels: Vec<[u32; 2]> = (0..256).map(|i| [i % 16, i / 16]).collect();
    let real = Real::new(&scene, 1).unwrap_or_else(|error| panic!("{error}"));
    let sums = real.sums(&pixels);
    sums.iter()
        .map(|sum| sum.colour.map(|c| c / 256.0))
        .collect()
}

#[test]
fn every_scene_shows_something() {
    let mut names: Vec<String> = std::fs::read_dir(folder())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "yaml")
        })
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .collect();
    names.sort();
    let expected = [
        "cornell-box",
        "cornell-ggx",
        "cornell-glass",
        "cornell-mirror",
        "floor-and-light",
        "furnace",
        "knot",
        "lit-box",
        "terrace",
        "velvet",
        "weekend",
    ];
    assert_eq!(names, expected);
    for name in expected {
        assert_eq!(scene(name, &[]).unwrap().warnings(), [], "{name}");
        let picture = small(name, &[]);
        let lit = picture
            .iter()
            .filter(|pixel| pixel.iter().sum::<f64>() > 0.01);
        assert!(lit.count() > 100, "{name} is nearly black");
        assert!(
            picture
                .as_flattened()
                .iter()
                .all(|c| c.is_finite() && *c >= 0.0)
        );
        match scene(name, &[]) {
            // The scene has the name of its file.
            Ok(valid) => assert_eq!(valid.scene().name, name),
            Err(report) => panic!("{report}"),
        }
    }
}

#[test]
fn the_cornell_box_stands_upright_with_its_red_wall_on_the_left() {
    for name in [
        "cornell-box",
        "cornell-mirror",
        "cornell-glass",
        "cornell-ggx",
    ] {
        let picture = small(name, &["sampling.path_bits=10"]);
        let area = |columns: std::ops::Range<usize>, rows: std::ops::Range<usize>| {
            let mut sum = [0.0; 3];
            for row in rows {
                for pixel in &picture[16 * row..][columns.clone()] {
                    for c in 0..3 {
                        sum[c] += pixel[c];
                    }
                }
            }
            sum
        };
        let [red, green, _] = area(0..2, 4..12);
        assert!(red > 3.0 * green, "{name}: left {red} {green}");
        let [red, green, _] = area(14..16, 4..12);
        assert!(green > 1.5 * red, "{name}: right {red} {green}");
        // The lamp hangs in the upper half of the picture and outshines everything.
        let brightest = picture
            .iter()
            .enumerate()
            .max_by(|a, b| a.1[0].total_cmp(&b.1[0]));
        let (place, pixel) = brightest.unwrap();
        assert!(
            pixel[0] > 5.0 && place / 16 < 4,
            "{name}: {pixel:?} at {place}"
        );
    }
}

#[test]
fn the_furnace_has_the_colour_that_its_comment_says() {
    for pixel in small("furnace", &[]) {
        for (ours, said) in pixel.iter().zip([0.199, 0.375, 0.443]) {
            assert!((ours - said).abs() < 0.0005, "{pixel:?}");
        }
    }
}

#[test]
fn a_lamp_turned_over_leaves_the_floor_black() {
    let other_way = "geometry[1].quad.vertices=[[-0.5, 2, 0.5], [0.5, 2, 0.5], [0.5, 2, -0.5], \
                     [-0.5, 2, -0.5]]";
    let picture = small("floor-and-light", &[other_way]);
    assert_eq!(picture, vec![[0.0; 3]; 256]);
    // The command warns the author.
    let scene = scene("floor-and-light", &[other_way]).unwrap();
    let codes: Vec<&str> = scene.warnings().iter().map(Problem::code).collect();
    assert_eq!(codes, ["QRT0221"]);
}

#[test]
fn the_cornell_box_may_be_seen_by_the_papers_lattice() {
    let sets = [
        "sampling.sequence=product-lattice",
        "sampling.depths=[{bits: [2, 2]}, {bits: [3, 2]}, {bits: [3, 3]}]",
        "sampling.path_bits=15",
    ];
    assert!(scene("cornell-box", &sets).is_ok());
}

#[test]
fn the_velvets_jacobian_is_two_pi_and_nothing_else() {
    assert!(scene("velvet", &["materials.velvet.bsdf.jacobian=2*pi"]).is_ok());
    let report = scene("velvet", &["materials.velvet.bsdf.jacobian=pi"]).unwrap_err();
    assert_eq!(report.codes(), ["QRT0414"]);
}
