//! Tests of complete counting circuits of single pixels: small enough for a simulator, with the right values,
//! and with the outcomes that theory predicts.

use crate::common::scene::written;
use qrt::core::inspect::{Inspection, OraclePixel};
use qrt::core::oracle::{Oracle, OracleOptions, Oracles};
use qrt::lab::simulate::{
    MOST_ITERATES, MOST_SUPERPOSED, MeanPhase, SimulateError, SimulateOptions, simulate,
    simulate_film, simulate_mean_phase,
};
use qrt::lab::verify::pixel_counts;
use qrt::prelude::*;
use qrt::runtime::memory::Memory;
use qrt::runtime::workers::Workers;
use qrt::scene::valid::ValidScene;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Scenes of `scenes-yaml/small`, and the most qubits of their complete counting circuits with 4 phase bits.
const SMALL: [(&str, u32); 5] = [
    ("edge", 20),
    ("lit-wall", 16),
    ("mirror", 20),
    ("corner", 20),
    ("slanted", 23),
];

/// The pixel that the lamp covers in part.
const PIXEL: OraclePixel = OraclePixel {
    place: [1, 0],
    seed: 0,
};

fn small(name: &str, sets: &[&str]) -> ValidScene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes-yaml/small");
    let text = std::fs::read_to_string(folder.join(format!("{name}.yaml"))).unwrap();
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    parse(&text, name, &sets, &folder).unwrap().valid
}

#[test]
fn small_scenes_fit_a_simulator_with_the_right_values() {
    for (name, most) in SMALL {
        fits(name, &[], most);
    }
}

/// Colours that are 0 or the scale need no comparator: the path index alone is in superposition, and half
/// the states.
#[test]
fn colours_that_are_zero_or_the_scale_need_no_comparator() {
    let none = "comparator.bits=0";
    for (name, most) in [
        ("edge", 19),
        ("mirror", 19),
        ("corner", 19),
        ("slanted", 22),
    ] {
        let amplitude = fits(name, &[none], most);
        assert_eq!(
            amplitude,
            fits(name, &["circuit.uncompute=keep"], 64),
            "{name}"
        );
    }
    // All colours of the lit wall are below half of the scale: the count is a constant.
    let wall = small("lit-wall", &[none]);
    let one = simulate(&Oracles::new(&wall), PIXEL, &SimulateOptions::default()).unwrap();
    assert_eq!((one.good, one.total), (0, 16));
    assert!(one.largest_difference() < 1e-12);
}

/// Checks the complete circuits of a small scene's channels. Returns the first channel's fraction of good indices.
fn fits(name: &str, sets: &[&str], most: u32) -> f64 {
    let scene = small(name, sets);
    let amplitudes = [0, 1, 2].map(|channel| {
        let options = SimulateOptions {
            channel: Some(channel),
            ..SimulateOptions::default()
        };
        let one = simulate(&Oracles::new(&scene), PIXEL, &options).unwrap();
        assert_eq!(one.phase_bits, 4);
        assert!(one.report.qubits <= most, "{name}: {}", one.report.qubits);
        assert!(one.largest_difference() < 1e-12, "{name}");
        assert!((one.report.norm - 1.0).abs() < 1e-12);
        let a = one.amplitude();
        assert!(a > 0.0 && a < 1.0 && a != 0.5, "{name}: {a}");
        let inspection = Inspection::of_pixel(&Oracles::new(&scene), Some(channel), PIXEL).unwrap();
        assert_eq!(inspection.complete_qubits(4, one.window), one.report.qubits);
        let counts = pixel_counts(&scene, &inspection.oracle, PIXEL);
        let counts = counts.unwrap().unwrap();
        assert_eq!((counts.good, counts.total), (one.good, one.total));
        assert_eq!((counts.differing, counts.agrees_at), (0, None), "{name}");
        a
    });
    amplitudes[0]
}

/// The most qubits of a complete counting circuit of `shadow`, over all pixels and channels.
const SHADOW: u32 = 470;

#[test]
fn the_circuits_of_the_shadow_have_the_qubits_that_it_says() {
    let scene = small("shadow", &[]);
    let counting = scene.scene().counting;
    let (bits, window) = (counting.phase_bits, counting.register_window());
    let oracles = Oracles::new(&scene);
    let places = (0..64).map(|place| [place % 8, place / 8]);
    let qubits = |place| {
        let pixel = OraclePixel { place, seed: 0 };
        let qubits = [0, 1, 2].map(|channel| {
            let inspection = Inspection::of_pixel(&oracles, Some(channel), pixel).unwrap();
            inspection.complete_qubits(bits, window)
        });
        qubits.into_iter().max()
    };
    assert_eq!(places.filter_map(qubits).max(), Some(SHADOW));
}

/// The file's first comment names the qubits.
#[test]
fn the_first_comment_of_a_small_scene_has_its_qubits() {
    for (name, most) in SMALL.into_iter().chain([("shadow", SHADOW)]) {
        let path = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("scenes-yaml/small")
            .join(format!("{name}.yaml"));
        let text = std::fs::read_to_string(path).unwrap();
        let comment: Vec<&str> = text
            .lines()
            .take_while(|line| line.starts_with('#'))
            .collect();
        let said = format!("{most} qubits");
        assert!(comment.join(" ").contains(&said), "{name}: {comment:?}");
    }
}

/// With 4 fraction bits a lamp's edge at the centre of a cell is on the wrong side of it, and a lamp that
/// reaches far makes all numbers coarse.
#[test]
fn too_few_fraction_bits_are_told_of() {
    let scene = |left: &str, right: &str| {
        written(
            &format!(
                "name: edge
camera: {{ orthographic: {{ eye: [0, 0, 2], target: [0, 0, 0], height: 2 }} }}
film: {{ width: 1, height: 1 }}
materials: {{ lamp: {{ emitter: {{ radiance: [1, 0.5, 0.25] }} }} }}
geometry:
  - quad: {{ vertices: [[{left}, -1, 0], [{right}, -1, 0], [{right}, 1, 0], [{left}, 1, 0]], material: lamp }}
sampling: {{ path_bits: 4, depths: [{{ bits: [3, 3] }}] }}
precision: {{ fraction: 4 }}
comparator: {{ bits: 1 }}
"
            ),
            &[],
        )
    };
    let pixel = OraclePixel::default();
    for (left, right, wrong, real) in [("-1", "-0.5", 6, 4), ("-64", "0.0", 16, 8)] {
        let mut scene = scene(left, right);
        let counts = |scene: &ValidScene| {
            let oracle = Inspection::of_pixel(&Oracles::new(scene), Some(0), pixel)
                .unwrap()
                .oracle;
            pixel_counts(scene, &oracle, pixel).unwrap().unwrap()
        };
        let found = counts(&scene);
        // Each path has two comparators.
        assert_eq!((found.good, found.good_in_real), (2 * wrong, 2 * real));
        assert_eq!(found.differing, wrong - real);
        assert!(found.in_words().contains("precision.fraction="));
        let mut parameters = scene.parameters();
        parameters.precision.fraction = found.agrees_at;
        scene = scene.with_parameters(parameters).unwrap();
        assert_eq!(counts(&scene).differing, 0);
    }
}

/// The oracle of a pixel alone and the oracle of all pixels count alike, pixel by pixel.
#[test]
fn a_pixel_alone_counts_as_it_does_in_a_film() {
    let text = include_str!("../../examples/lit-wall.yaml");
    let scene = written(text, &["precision.fraction=14"]);
    let film = scene.scene().film;
    for y in 0..film.height {
        for x in 0..film.width {
            let pixel = OraclePixel {
                place: [x, y],
                seed: 3,
            };
            for channel in 0..3 {
                let all = Oracle::new(&scene, channel, OracleOptions::default()).unwrap();
                let alone =
                    Inspection::of_pixel(&Oracles::new(&scene), Some(channel), pixel).unwrap();
                let [all, one] = [&all, &alone.oracle]
                    .map(|oracle| pixel_counts(&scene, oracle, pixel).unwrap().unwrap());
                assert_eq!((one.good, one.differing), (all.good, all.differing));
                assert_eq!(one.differing, 0);
            }
        }
    }
}

#[test]
#[should_panic(expected = "an oracle of pixel [1, 0] alone cannot serve pixel [0, 0]")]
fn an_oracle_of_one_pixel_serves_no_other() {
    let scene = small("edge", &[]);
    let oracle = Inspection::of_pixel(&Oracles::new(&scene), Some(0), PIXEL)
        .unwrap()
        .oracle;
    let _ = oracle.phase(0, 0, [0, 0]);
}

#[test]
fn a_film_is_counted_by_a_circuit_for_each_channel_of_each_pixel() {
    let scene = small("edge", &["counting.repetitions=64"]);
    let film = simulate_film(&Oracles::new(&scene), 0, &SimulateOptions::default()).unwrap();
    assert_eq!([film.image.width, film.image.height], [2, 2]);
    assert_eq!(film.circuits, 12);
    assert!(film.largest_difference < 1e-12);
    // The lamp covers the left pixels and a quarter of the right ones.
    let pixels = film.image.pixels.iter().zip(&film.amplitudes);
    for (place, (pixel, amplitudes)) in pixels.enumerate() {
        let right = if place % 2 == 0 { 1.0 } else { 0.25 };
        assert_eq!(*amplitudes, [right; 3]);
        let near = pixel.iter().all(|value| (value - right).abs() < 0.05);
        assert!(near, "{pixel:?}");
    }
    // The same seed draws the same outcomes, on any number of threads.
    let threads = Workers {
        threads: std::num::NonZeroUsize::new(1),
        ..Workers::default()
    };
    let options = SimulateOptions {
        workers: threads,
        ..SimulateOptions::default()
    };
    let again = simulate_film(&Oracles::new(&scene), 0, &options).unwrap();
    assert_eq!(again.image.pixels, film.image.pixels);
    // A scene is recorded once for all channels of a pixel; a search for a strategy records more.
    let wall = small("lit-wall", &[]);
    simulate_film(&Oracles::new(&wall), 0, &options).unwrap();
    assert_eq!(wall.recordings(), 4);
}

#[test]
fn amplitudes_beyond_the_memory_budget_are_refused_and_a_cancelled_run_ends() {
    let scene = small("edge", &["counting.phase_bits=12"]);
    let oracles = Oracles::new(&scene);
    let tight = SimulateOptions {
        memory: Memory::new(Some(10_000_000)),
        ..SimulateOptions::default()
    };
    let refused = simulate(&oracles, PIXEL, &tight).unwrap_err();
    assert!(refused.is_refusal());
    assert!(
        matches!(refused, SimulateError::WouldNotFit(_)),
        "{refused}"
    );
    let cancel = AtomicBool::new(true);
    let workers = Workers {
        cancel: Some(&cancel),
        ..Workers::default()
    };
    let options = SimulateOptions {
        workers,
        ..SimulateOptions::default()
    };
    let ended = simulate(&oracles, PIXEL, &options).unwrap_err();
    assert!(matches!(ended, SimulateError::Interrupted));
}

#[test]
fn a_circuit_with_too_many_amplitudes_is_refused_before_it_is_compiled() {
    let scene = small("edge", &["counting.phase_bits=23"]);
    let refused = simulate(&Oracles::new(&scene), PIXEL, &SimulateOptions::default()).unwrap_err();
    assert!(refused.is_refusal());
    assert!(matches!(
        refused,
        SimulateError::TooManySuperposed {
            path: 4,
            comparator: 1,
            phase: 23
        }
    ));
    assert_eq!(MOST_SUPERPOSED, 24);
    let text = refused.to_string();
    assert!(text.contains("lower `sampling.path_bits`"), "{text}");
}

/// Every gate of the mean-phase circuit, beside what the levels of the paths say, at every number of
/// iterates.
#[test]
fn the_mean_phase_of_small_scenes_is_that_of_their_levels() {
    let mut zeros = Vec::new();
    for name in ["edge", "lit-wall", "corner", "mirror", "shadow", "slanted"] {
        let scene = small(name, &[]);
        let oracles = Oracles::new(&scene);
        for iterates in (0..=16).chain([64]) {
            let asked = MeanPhase {
                iterates,
                slope: None,
                reference: None,
            };
            let options = SimulateOptions::default();
            let found = simulate_mean_phase(&oracles, PIXEL, &options, &asked).unwrap();
            assert!(found.largest_difference() < 1e-12, "{name}: {found:?}");
            let paths: u64 = found.levels.iter().map(|level| level.paths).sum();
            assert_eq!(paths, 1 << found.path_bits);
            assert_eq!(found.queries, if iterates == 0 { 0 } else { iterates + 1 });
            zeros.push(found.zero()[0]);
        }
    }
    let fringes = zeros.iter().filter(|zero| (*zero - 0.5).abs() > 0.2);
    assert!(fringes.count() > 10, "{zeros:?}");
}

#[test]
fn a_mean_phase_out_of_range_is_refused() {
    let scene = small("edge", &[]);
    let refused = |asked: MeanPhase, says: &str| {
        let options = SimulateOptions::default();
        let error = simulate_mean_phase(&Oracles::new(&scene), PIXEL, &options, &asked);
        let error = error.unwrap_err();
        assert!(error.is_refusal(), "{error}");
        assert!(error.to_string().contains(says), "{error}");
    };
    let good = MeanPhase {
        iterates: 1,
        slope: Some(1.0),
        reference: Some(0.5),
    };
    for (set, says) in [
        ("sampling.path_bits=26", "lower `sampling.path_bits`"),
        ("comparator.bits=13", "lower `comparator.bits`"),
    ] {
        let scene = small("edge", &[set]);
        let options = SimulateOptions::default();
        let error = simulate_mean_phase(&Oracles::new(&scene), PIXEL, &options, &good);
        let error = error.unwrap_err();
        assert!(
            error.is_refusal() && error.to_string().contains(says),
            "{error}"
        );
    }
    let many = MOST_ITERATES + 1;
    refused(
        MeanPhase {
            iterates: many,
            ..good
        },
        "65537 iterates",
    );
    for slope in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        refused(
            MeanPhase {
                slope: Some(slope),
                ..good
            },
            "positive, finite slope",
        );
    }
    for reference in [-0.1, 1.1, f64::NAN] {
        refused(
            MeanPhase {
                reference: Some(reference),
                ..good
            },
            "reference from 0 to 1",
        );
    }
}
