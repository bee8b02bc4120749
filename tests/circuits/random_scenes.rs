//! Runs random small scenes path by path through all models: the circuit computes the same as the integers, bit for
//! bit, and floating point differs only by the width of numbers.

use crate::common::numbers::Numbers;
use qrt::lab::verify::{VerifyOptions, verify};
use qrt::scene::front::{Files, parse_with};
use std::fmt::Write as _;

/// Returns a scene that shows a few surfaces; coordinates are eighths, so that parallelograms are flat.
pub(super) fn scene(numbers: &mut Numbers) -> String {
    let mut text = String::from("name: random\n");
    let eighths = |numbers: &mut Numbers, most: usize| {
        (numbers.below(2 * most + 1) as f64 - most as f64) / 8.0
    };
    let point = |numbers: &mut Numbers, most| [(); 3].map(|()| eighths(numbers, most));
    let eye = [eighths(numbers, 8), eighths(numbers, 8), 3.0];
    let target = point(numbers, 4);
    let vfov = 20 + numbers.below(100);
    let _ = writeln!(
        text,
        "camera: {{ perspective: {{ eye: {eye:?}, target: {target:?}, vfov: {vfov} }} }}"
    );
    text += "film: { width: 3, height: 2 }\nmaterials:\n";
    let fraction = |numbers: &mut Numbers| numbers.below(9) as f64 / 10.0;
    let surfaces = 1 + numbers.below(5);
    for number in 0..surfaces {
        let rgb = [(); 3].map(|()| fraction(numbers));
        let mut reflected = || {
            let other = [(); 3].map(|()| fraction(numbers));
            match numbers.below(3) {
                0 => format!(
                    "{{ checker: {{ of: [{rgb:?}, {other:?}], scale: 0.{} }} }}",
                    5 + numbers.below(5)
                ),
                _ => format!("{rgb:?}"),
            }
        };
        let reflected = reflected();
        let material = match numbers.below(if number == 0 { 1 } else { 8 }) {
            0 => format!("emitter: {{ radiance: {:?} }}", rgb.map(|c| 4.0 * c + 0.5)),
            1 => format!("mirror: {{ reflectance: {reflected} }}"),
            2 => format!("dielectric: {{ ior: 1.{} }}", 1 + numbers.below(8)),
            3 => format!(
                "dielectric: {{ ior: 1.{}, transmittance: {rgb:?} }}",
                1 + numbers.below(8)
            ),
            4 => format!(
                "ggx: {{ reflectance: {reflected}, alpha: 0.{} }}",
                2 + numbers.below(7)
            ),
            5 => format!(
                "metal: {{ reflectance: {reflected}, alpha: {} }}",
                ["0", "0.4", "0.7"][numbers.below(3)]
            ),
            _ => format!("lambertian: {{ albedo: {reflected} }}"),
        };
        let _ = writeln!(text, "  m{number}: {{ {material} }}");
    }
    text += "geometry:\n";
    for number in 0..surfaces {
        let corner = point(numbers, 12);
        let sides = [point(numbers, 16), point(numbers, 16)];
        let at = |u: f64, v: f64| [0, 1, 2].map(|k| corner[k] + u * sides[0][k] + v * sides[1][k]);
        let [a, b, c, d] = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];
        let _ = match numbers.below(4) {
            3 => {
                let radius = (1 + numbers.below(12)) as f64 / 8.0;
                writeln!(
                    text,
                    "  - disc: {{ center: {corner:?}, normal: {:?}, radius: {radius}, material: m{number} }}",
                    sides[0]
                )
            }
            0 => writeln!(
                text,
                "  - triangle: {{ vertices: [{a:?}, {b:?}, {c:?}], material: m{number} }}"
            ),
            _ => writeln!(
                text,
                "  - quad: {{ vertices: [{a:?}, {b:?}, {c:?}, {d:?}], material: m{number} }}"
            ),
        };
    }
    let (bits, comparator) = (12 + numbers.below(7), 2 + numbers.below(5));
    let _ = writeln!(
        text,
        "precision: {{ fraction: {bits} }}\ncomparator: {{ bits: {comparator} }}"
    );
    let second = numbers.below(3);
    // Half of the scenes sample their lamps, in every way.
    let lights = ["none", "none", "none", "auto", "mis", "next-event"][numbers.below(6)];
    let light = if lights == "none" {
        ""
    } else {
        ", light: [1, 2]"
    };
    let _ = writeln!(
        text,
        "sampling: {{ path_bits: 5, lights: {lights}, depths: [{{ bits: [2, 3] }}{}] }}",
        format!(", {{ bits: [2, 2]{light} }}").repeat(second)
    );
    if numbers.below(4) == 0 {
        text += "circuit: { uncompute: scoped }\n";
    }
    if numbers.below(3) == 0 {
        let direction = [eighths(numbers, 8), 0.5, eighths(numbers, 8)];
        let angle = ["0.53", "20", "120"][numbers.below(3)];
        let _ = writeln!(
            text,
            "sun: {{ direction: {direction:?}, angle: {angle}, radiance: 2 }}"
        );
    }
    text
}

/// Returns a scene without meshes.
fn plain(numbers: &mut Numbers) -> (String, String) {
    (scene(numbers), String::new())
}

/// Returns a scene as [`scene`] does, with a mesh of colours at its vertices, and the mesh as an OBJ file.
fn coloured(numbers: &mut Numbers) -> (String, String) {
    let eighths = |numbers: &mut Numbers| (numbers.below(25) as f64 - 12.0) / 8.0;
    let corners = 4 + numbers.below(3);
    let mut obj = String::new();
    // Some vertices share a colour.
    let palette = [(); 3].map(|()| [(); 3].map(|()| numbers.below(9) as f64 / 8.0));
    for _ in 0..corners {
        let [x, y, z] = [(); 3].map(|()| eighths(numbers));
        let [r, g, b] = palette[numbers.below(3)];
        let _ = writeln!(obj, "v {x} {y} {z} {r} {g} {b}");
    }
    for first in 1..corners - 1 {
        let _ = writeln!(obj, "f {first} {} {}", first + 1, first + 2);
    }
    let material = [
        "lambertian: { albedo: [0.9, 0.5, 0.7] }",
        "mirror: { reflectance: [0.5, 0.7, 0.9] }",
        "ggx: { reflectance: [0.9, 0.8, 0.7], alpha: 0.4 }",
        "metal: { reflectance: [0.9, 0.8, 0.1] }",
        "emitter: { radiance: 1, albedo: [0.9, 0.5, 0.7] }",
    ][numbers.below(5)];
    let smooth = ["auto", "0", "180"][numbers.below(3)];
    let text = scene(numbers);
    let text = text.replacen(
        "materials:\n",
        &format!("materials:\n  painted: {{ {material} }}\n"),
        1,
    );
    let mesh = format!(
        "geometry:\n  - mesh: {{ obj: any.obj, colors: vertices, smooth: {smooth}, material: painted }}\n"
    );
    (text.replacen("geometry:\n", &mesh, 1), obj)
}

/// Checks up to `scenes` scenes that `random` makes, skipping invalid ones, on one thread per core. A scene comes with
/// the contents of its mesh `any.obj`.
fn check(scenes: usize, seed: u64, random: impl Fn(&mut Numbers) -> (String, String) + Sync) {
    use std::sync::Mutex;
    use std::sync::atomic::{AtomicUsize, Ordering};
    let next = AtomicUsize::new(0);
    let found = Mutex::new((0, 0_u64, 0.0));
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if found.lock().unwrap().0 >= scenes {
                        break;
                    }
                    let mut numbers = Numbers(seed + number as u64);
                    let (text, obj) = random(&mut numbers);
                    let files: [(&str, &[u8]); 1] = [("any.obj", obj.as_bytes())];
                    // Some scenes have surfaces without area: an error, and no panic.
                    let loaded = parse_with(&text, "random.yaml", &[], Files::held(&files));
                    let Ok(loaded) = loaded else {
                        continue;
                    };
                    let mut options = VerifyOptions {
                        pixels: 2,
                        seed: number as u64,
                        ..VerifyOptions::default()
                    };
                    options.workers.threads = std::num::NonZeroUsize::new(1);
                    let report = verify(&loaded.valid, &options);
                    let report = report.unwrap_or_else(|error| panic!("{error}\n{text}\n{obj}"));
                    assert!(report.holds(), "{report:?}\n{text}\n{obj}");
                    let mut found = found.lock().unwrap();
                    found.0 += 1;
                    found.1 += report.paths;
                    found.2 += report.parted;
                }
            });
        }
    });
    let (checked, paths, parted) = found.into_inner().unwrap();
    println!(
        "{checked} scenes of {} were checked, {paths} paths; {:.3} % met something else",
        next.into_inner(),
        100.0 * parted / checked as f64
    );
    // With 12 to 18 bits, fixed and real numbers differ only at edges.
    assert!(parted / (checked as f64) < 0.02);
}

#[test]
fn of_forty_scenes_all_models_agree() {
    check(40, 0, plain);
}

#[test]
fn of_forty_coloured_meshes_all_models_agree() {
    check(40, 0, coloured);
}

#[test]
#[ignore = "takes five minutes on two cores"]
fn of_ten_thousand_scenes_all_models_agree() {
    check(10_000, 1_000_000, plain);
    check(2_000, 2_000_000, coloured);
}
