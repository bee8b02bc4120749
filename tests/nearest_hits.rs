//! The oracle of nearest hits marks the faces that textbook geometry says it should, on the machine of
//! integers and gate by gate, and a search finds the nearest of them as often as it promises.
#![allow(clippy::unwrap_used)]

mod rays;

use qrt::core::front;
use qrt::core::oracle::NearestOracle;
use qrt::core::valid::ValidScene;
use qrt::runtime::machines::{Answers, Asked, Candidate, NearestMachine};
use qrt::runtime::random::Stream;
use rays::{Meeting, meetings};
use std::path::Path;
use std::sync::Arc;

const SEED: u64 = 11;

fn from_file(file: &str, sets: &[&str]) -> ValidScene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    let sets: Vec<String> = sets.iter().map(|&set| set.to_owned()).collect();
    front::load(&path, &sets).unwrap().valid
}

fn from_text(text: &str) -> ValidScene {
    front::parse(text, "scene.yaml", &[], "".as_ref()).unwrap().valid
}

fn oracle(scene: &ValidScene) -> Arc<NearestOracle> {
    Arc::new(NearestOracle::new(scene).unwrap().unwrap())
}

/// Paths all over the film.
fn some_rays(scene: &ValidScene, count: u64) -> Vec<Asked> {
    let film = scene.scene().film;
    let mut stream = Stream::new(1, 0, 0, 0);
    let mut below = |bound: u32| (stream.uniform() * f64::from(bound)) as u32;
    let paths = 1 << scene.scene().sampling.path_bits;
    (0..count)
        .map(|_| Asked {
            pixel: [below(film.width), below(film.height)],
            id: u64::from(below(paths)),
            best: None,
        })
        .collect()
}

/// How far a distance and a place may be off, in stage units.
fn tolerance(oracle: &NearestOracle, met: &Meeting) -> [f64; 2] {
    let ulp = 1.0 / f64::from(1_u32 << oracle.fraction);
    let distance = ulp * (2.0 + 4.0 * met.distance.abs()) * (1.0 + 1.0 / met.slope);
    [distance, met.length * distance + 4.0 * ulp * (1.0 + met.distance.abs())]
}

/// Every face and many rays against textbook geometry, as far as rounding leaves no doubt; at most
/// `doubt` of the meetings are in doubt.
fn marks_what_is_met(scene: &ValidScene, count: u64, doubt: f64) {
    let oracle = oracle(scene);
    let machine = NearestMachine::fixed(oracle.clone(), SEED);
    let rays = some_rays(scene, count);
    let mut answers = Answers::default();
    machine.ask(&rays, &mut answers).unwrap();
    let units = f64::from(1_u32 << oracle.fraction);
    let (mut met, mut missed, mut doubtful) = (0_u64, 0_u64, 0_u64);
    for (place, ray) in rays.iter().enumerate() {
        let all = meetings(scene, SEED, ray.pixel, ray.id);
        let marks = answers.marks(place);
        for (number, &mark) in marks.iter().enumerate() {
            let Some(&label) = oracle.labels.get(number).filter(|_| number < oracle.faces()) else {
                assert!(!mark, "{ray:?} meets number {number} of {}", oracle.faces());
                continue;
            };
            let meeting = all[label as usize];
            let [far, wide] = tolerance(&oracle, &meeting);
            let reached = meeting.distance;
            // Parallel, or through an edge.
            if !(reached.abs() > far && meeting.margin.abs() > wide) {
                doubtful += 1;
                continue;
            }
            let should = reached > 0.0 && meeting.margin > 0.0;
            assert_eq!(mark, should, "{ray:?}, face {label}: {meeting:?}");
            if mark {
                let distance = answers.distances(place)[number] as f64 / units;
                assert!(
                    (distance - reached).abs() <= far,
                    "{ray:?}, face {label}: {distance} instead of {meeting:?}"
                );
                met += 1;
            } else {
                missed += 1;
            }
        }
    }
    println!("{met} met, {missed} missed, {doubtful} doubtful");
    assert!(met >= count / 2 && missed >= count / 2);
    assert!(doubtful as f64 <= doubt * (met + missed) as f64, "{doubtful} of {met}, {missed}");
}

#[test]
fn faces_are_marked_that_textbook_geometry_says_are_met() {
    let cornell = from_file("scenes-yaml/cornell-box.yaml", &[]);
    marks_what_is_met(&cornell, 3000, 0.01);
    let blocks = from_file("tests/scenes/blocks.yaml", &[]);
    // The floor is seen edge on.
    marks_what_is_met(&blocks, 3000, 0.2);
    let knot = from_file("scenes-yaml/knot.yaml", &["precision.fraction=20"]);
    marks_what_is_met(&knot, 60, 0.02);
}
