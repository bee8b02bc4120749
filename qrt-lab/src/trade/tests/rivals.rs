//! Tests of the rivals of counting.

use super::super::bench::{Bench, Effort};
use super::super::sweep::settings;
use super::super::{Setting, Sweep};
use super::{LIT, scene};
use qrt_runtime::memory::Memory;
use qrt_runtime::models::Model;
use qrt_runtime::sample::spread;
use qrt_runtime::workers::Workers;
use qrt_scene::Sequence;
use qrt_scene::valid::ValidScene;

/// A scene with two small lamps, out of sight and sampled.
fn lit() -> String {
    let lamp = "[[-1, 1.5, -1], [1, 1.5, -1], [1, 1.5, 1], [-1, 1.5, 1]], material: lamp }";
    let two = "[[-0.3, 3, 0], [0, 3, 0], [0, 3, 0.6], [-0.3, 3, 0.6]], material: lamp }
  - quad: { vertices: [[0, 3, 0], [0.3, 3, 0], [0.3, 3, 0.6], [0, 3, 0.6]], material: lamp }";
    assert!(LIT.contains(lamp));
    let text = LIT.replace(
        "{ bits: [8, 8] }], lights: none }",
        "{ bits: [8, 8], light: [8, 8] }] }",
    );
    text.replace(lamp, two)
}

fn bench(scene: &ValidScene) -> Bench<'_> {
    let effort = Effort {
        reference_bits: 15,
        depth_bits: 6,
        draws: 1,
        most_toffoli: None,
    };
    let mut bench = Bench::new(scene, 0, effort, Workers::default());
    bench.pixels = spread([6, 4], 24);
    bench.check(Memory::default()).unwrap();
    bench
}

fn of(scene: &ValidScene, sweep: Sweep) -> Vec<Setting> {
    let all = settings(&scene.parameters(), true).into_iter();
    all.filter(|setting| setting.sweep == sweep).collect()
}

/// Paths and errors of a rival.
fn rival(bench: &mut Bench<'_>, scene: &ValidScene, sweep: Sweep) -> Vec<(f64, f64)> {
    let rows = of(scene, sweep).into_iter().map(|setting| {
        let row = bench.row(setting).unwrap().unwrap();
        assert_eq!((row.errors[0], row.cost.toffoli), (row.errors[5], 0));
        (row.queries, row.errors[5].value)
    });
    rows.collect()
}

#[test]
fn gates_that_take_long_are_left_out_of_a_quick_measurement() {
    let scene = scene(&lit());
    let mut bench = bench(&scene);
    let rows = of(&scene, Sweep::Model);
    let [fixed, gates] = [Model::Fixed, Model::Gates]
        .map(|model| *rows.iter().find(|row| row.model == model).unwrap());
    let toffoli = bench.row(gates).unwrap().unwrap().cost.toffoli;
    let run = toffoli * (24 << scene.parameters().sampling.path_bits);
    for (most, is_run) in [(run, true), (run - 1, false)] {
        bench.effort.most_toffoli = Some(most);
        assert!(bench.row(fixed).unwrap().is_ok());
        match bench.row(gates).unwrap() {
            Ok(_) => assert!(is_run),
            Err(why) => assert!(!is_run && why.contains(&run.to_string()), "{why}"),
        }
    }
}

/// Checks the errors of rivals against the scene's own net and against theory.
///
/// A net that is run classically has the error of the scene's own net before counting. The error of
/// random paths falls as one over the square root of their number.
#[test]
fn rivals_are_measured_against_the_same_limit() {
    let scene = scene(&lit());
    let mut bench = bench(&scene);
    let nets = rival(&mut bench, &scene, Sweep::ClassicalNet);
    assert_eq!(nets.len(), 6);
    let mut smaller = vec![];
    for setting in of(&scene, Sweep::Paths) {
        if setting.sequence == Sequence::DigitalNet {
            let paths = f64::from(1 << setting.path_bits);
            let counted = bench.row(setting).unwrap().unwrap();
            let (_, off) = nets.iter().find(|(number, _)| *number == paths).unwrap();
            let ratio = off / counted.errors[0].value;
            if paths == 1024.0 {
                assert!((ratio - 1.0).abs() < 1e-9, "{ratio}");
            } else {
                smaller.push(ratio);
            }
        }
    }
    // The rival averages over several smaller nets. The scene's net is the first of them, by chance
    // nearer or farther.
    let middle = smaller.iter().product::<f64>().cbrt();
    assert!(
        smaller.len() == 3 && (0.6..1.7).contains(&middle),
        "{smaller:?}"
    );
    let random = rival(&mut bench, &scene, Sweep::RandomPaths);
    // There are rows with more random paths than the largest net has. At equal numbers the net is
    // ahead.
    assert!(random.len() > nets.len() && nets[5].1 < 0.3 * random[5].1);
    let law = |(paths, off): &(f64, f64)| (off * paths.sqrt() / random[0].1 - 1.0).abs() < 1e-9;
    assert!(random.iter().all(law), "{random:?}");
    // A net of one path is a random one.
    let ratio = nets[0].1 / random[0].1;
    assert!((0.7..1.4).contains(&ratio), "{ratio}");
}

/// Checks that rivals sample lamps that the scene does not, and come nearer to the same limit.
#[test]
fn rivals_sample_lamps_that_the_scene_does_not() {
    let scene = scene(&lit().replace("light: [8, 8]", "light: none"));
    let mut bench = bench(&scene);
    let nets = rival(&mut bench, &scene, Sweep::ClassicalNet);
    let blind = of(&scene, Sweep::Paths)[0];
    let blind = bench.row(blind).unwrap().unwrap();
    assert_eq!((blind.setting.path_bits, nets[2].0), (4, 16.0));
    assert!(10.0 * nets[2].1 < blind.errors[0].value);
}

/// Checks that a lattice with fewer bits than lamps is left out, with the reason.
#[test]
fn a_setting_that_cannot_choose_among_lamps_is_left_out() {
    let scene = scene(&lit());
    let mut bench = bench(&scene);
    let mut lattices = of(&scene, Sweep::Paths).into_iter();
    let few = lattices.find(|setting| setting.sequence == Sequence::ProductLattice);
    let why = bench.row(few.unwrap()).unwrap().unwrap_err();
    assert_eq!(why, "there are 2 lamps, and 0 bits choose among 1");
    assert!(bench.row(lattices.next_back().unwrap()).unwrap().is_ok());
}
