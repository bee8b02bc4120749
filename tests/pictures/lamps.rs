//! Tests of sampled lamps: the light is the same by every way to find it, with less noise.

use super::independent::{mean, rms_difference, traced};
use crate::common::scene::{from_file, written};
use qrt::counting::random::Stream;
use qrt::prelude::{Estimator, Model, RenderOptions, render};
use qrt::runtime::path_machines::Real;
use qrt::scene::front::{Files, parse_with};
use qrt::scene::valid::ValidScene;
use qrt::syntax::Problem;
use qrt::tracer::{PixelClass, PixelClasses};
use std::fmt::Write as _;

/// Returns a floor below a camera, the objects above it, and a material of the floor.
fn room(material: &str, lamps: &str, more: &str, sampling: &str) -> ValidScene {
    written(&room_of(material, lamps, more, sampling), &[])
}

fn room_of(material: &str, lamps: &str, more: &str, sampling: &str) -> String {
    format!(
        "name: room
camera: {{ perspective: {{ eye: [0, 1.6, 2.4], target: [0, 0.2, 0], vfov: 50 }} }}
film: {{ width: 4, height: 4 }}
materials:
  floor: {material}
  white: {{ lambertian: {{ albedo: [0.7, 0.6, 0.5] }} }}
  lamp: {{ emitter: {{ radiance: [6, 5, 4] }} }}
  pale: {{ emitter: {{ radiance: [1, 2, 3], albedo: [0.5, 0.6, 0.7] }} }}
geometry:
  - quad: {{ vertices: [[-2, 0, -2], [-2, 0, 2], [2, 0, 2], [2, 0, -2]], material: floor }}
  - quad: {{ vertices: [[-2, 0, -2], [2, 0, -2], [2, 2, -2], [-2, 2, -2]], material: white }}
{lamps}{more}
sampling: {sampling}
"
    )
}

const QUAD: &str = "  - quad: { vertices: [[-0.5, 1.5, -0.5], [0.5, 1.5, -0.5], [0.5, 1.5, 0.3], [-0.5, 1.5, 0.3]], material: lamp }\n";
const TRIANGLE: &str = "  - triangle: { vertices: [[-0.5, 1.4, -0.5], [0.7, 1.5, -0.5], [0.2, 1.6, 0.5]], material: lamp }\n";
const KITE: &str = "  - quad: { vertices: [[-0.6, 1.5, 0], [0, 1.5, -0.8], [0.4, 1.5, 0], [0, 1.5, 0.3]], material: lamp }\n";
const TWISTED: &str = "  - quad: { vertices: [[-0.5, 1.3, -0.5], [0.5, 1.5, -0.5], [0.5, 1.3, 0.3], [-0.5, 1.6, 0.3]], material: lamp }\n";
/// Two lamps, the second of which reflects, and stands on the floor.
const TWO: &str =
    "  - triangle: { vertices: [[0.6, 1.4, -0.5], [1, 1.5, -0.5], [0.8, 1.6, 0]], material: lamp }
  - quad: { vertices: [[-1, 0, 0.2], [-1, 0, -1], [-1, 1, -1], [-1, 1, 0.2]], material: pale }\n";
/// A lamp that stands on the floor and touches the wall.
const CORNER: &str = "  - quad: { vertices: [[-1, 0, 0.2], [-1, 0, -2], [-1, 1, -2], [-1, 1, 0.2]], material: lamp }\n";
/// A card in the lamp's own plane, listed before it, that hides a part of it.
const COVERED: &str = "  - quad: { vertices: [[-0.5, 1.5, -0.5], [0, 1.5, -0.5], [0, 1.5, 0.3], [-0.5, 1.5, 0.3]], material: white }
  - quad: { vertices: [[-0.5, 1.5, -0.5], [0.5, 1.5, -0.5], [0.5, 1.5, 0.3], [-0.5, 1.5, 0.3]], material: lamp }\n";
const BLOCK: &str = "  - quad: { vertices: [[-0.3, 0.7, -0.3], [-0.3, 0.7, 0.3], [0.3, 0.7, 0.3], [0.3, 0.7, -0.3]], material: white }\n";

const MATTE: &str = "{ lambertian: { albedo: [0.8, 0.7, 0.6] } }";

fn sampling(bits: u32, lights: &str, map: &str) -> String {
    let depth = format!("{{ bits: [12, 12], light: [10, 10], map: {map} }}");
    format!(
        "{{ path_bits: {bits}, lights: {lights}, depths: [{{ bits: [12, 12] }}, {depth}, {depth}] }}"
    )
}

/// Returns the picture's mean under several seeds, and its standard error.
fn measured(scene: &ValidScene) -> [f64; 2] {
    const SEEDS: u64 = 6;
    let means: Vec<f64> = (1..=SEEDS).map(|seed| mean(&traced(scene, seed))).collect();
    let middle = means.iter().sum::<f64>() / SEEDS as f64;
    let spread: f64 = means.iter().map(|m| (m - middle).powi(2)).sum();
    [middle, (spread / (SEEDS * (SEEDS - 1)) as f64).sqrt()]
}

/// Checks that all ways find the same light, within their spread and the cells of coordinates.
fn agree(name: &str, material: &str, lamps: &str, map: &str, ways: &[&str]) {
    let of = |bits, way| measured(&room(material, lamps, BLOCK, &sampling(bits, way, map)));
    let [truth, error] = of(14, "none");
    assert!(truth > 0.0, "{name}");
    for way in ways {
        let [found, own] = of(10, way);
        let off = (found - truth).abs();
        assert!(
            off <= 5.0 * error.hypot(own) + 1e-3 * truth,
            "{name}, {way}: {found} +- {own}, {truth} +- {error} without"
        );
    }
}

#[test]
fn lamps_of_all_shapes_give_the_light_that_is_found_by_chance() {
    let ways = ["auto", "mis", "next-event"];
    agree("quad", MATTE, QUAD, "auto", &ways);
    agree("triangle", MATTE, TRIANGLE, "auto", &ways);
    agree("kite", MATTE, KITE, "auto", &ways);
    agree("twisted", MATTE, TWISTED, "auto", &ways);
    agree("covered", MATTE, COVERED, "auto", &ways);
    // A lamp that stands on the floor has no bound of next-event estimation.
    agree("two", MATTE, TWO, "auto", &["auto", "mis"]);
}

/// If next-event estimation has no bound for a lamp, `auto` is multiple importance sampling; otherwise it is
/// next-event estimation.
#[test]
fn auto_is_one_of_both() {
    let picture = |lamps, way| {
        let scene = room(MATTE, lamps, "", &sampling(8, way, "auto"));
        traced(&scene, 1)
    };
    assert_eq!(picture(CORNER, "auto"), picture(CORNER, "mis"));
    assert_eq!(picture(QUAD, "auto"), picture(QUAD, "next-event"));
    assert_ne!(picture(QUAD, "auto"), picture(QUAD, "mis"));
}

/// Each face of a mesh that emits is a lamp, like a triangle of its own.
#[test]
fn a_mesh_that_emits_is_sampled_face_by_face() {
    const CORNERS: [[f64; 3]; 5] = [
        [-0.5, 1.5, -0.5],
        [0.5, 1.4, -0.5],
        [0.6, 1.5, 0.3],
        [0.0, 1.7, 0.4],
        [-0.5, 1.5, 0.3],
    ];
    const FACES: [[usize; 3]; 3] = [[0, 1, 2], [0, 2, 3], [0, 3, 4]];
    let (mut obj, mut triangles) = (String::new(), String::new());
    for [x, y, z] in CORNERS {
        writeln!(obj, "v {x} {y} {z}").unwrap();
    }
    for face in FACES {
        let [a, b, c] = face.map(|corner| corner + 1);
        writeln!(obj, "f {a} {b} {c}").unwrap();
        let corners = face.map(|corner| CORNERS[corner]);
        writeln!(
            triangles,
            "  - triangle: {{ vertices: {corners:?}, material: lamp }}"
        )
        .unwrap();
    }
    let mesh = "  - mesh: { obj: lamp.obj, material: lamp }\n";
    for way in ["auto", "mis"] {
        let sampling = sampling(8, way, "auto");
        let of = |lamps: &str| {
            let text = room_of(MATTE, lamps, BLOCK, &sampling);
            let files = [("lamp.obj", obj.as_bytes())];
            let parsed = parse_with(&text, "room.yaml", &[], Files::held(&files));
            parsed.unwrap_or_else(|report| panic!("{report}")).valid
        };
        let (whole, apart) = (of(mesh), of(&triangles));
        for model in [Model::Real, Model::Fixed] {
            let options = RenderOptions {
                model: Some(model),
                estimator: Some(Estimator::Exact),
                ..RenderOptions::default()
            };
            let [whole, apart] =
                [&whole, &apart].map(|scene| render(scene, &options).unwrap().image);
            assert_eq!(whole, apart, "{way}, {model:?}");
            assert!(whole.pixels.iter().any(|pixel| pixel[0] > 0.05));
        }
    }
}

/// A device that loses its state and misreads it counts the paths to sampled lamps like other paths: the
/// same on integers as through gates.
#[test]
fn noise_is_that_of_any_picture() {
    let scene = room(MATTE, QUAD, BLOCK, &sampling(6, "auto", "auto"));
    let of = |model, noise: &str| {
        let options = RenderOptions {
            model: Some(model),
            estimator: Some(Estimator::Sine),
            noise: noise.parse().unwrap(),
            ..RenderOptions::default()
        };
        render(&scene, &options).unwrap()
    };
    let noise = "depolarising=1e-6,readout=0.005";
    let [fixed, gates] = [Model::Fixed, Model::Gates].map(|model| of(model, noise));
    assert_eq!(fixed.image, gates.image);
    let quiet = of(Model::Fixed, "depolarising=0,readout=0");
    let differ = |a: &[[f64; 3]], b: &[[f64; 3]]| a.iter().zip(b).filter(|(a, b)| a != b).count();
    assert_eq!(fixed.good(), quiet.good());
    assert!(differ(&fixed.image.pixels, &quiet.image.pixels) > 0);
    // Misreading a bit that is worth half of the range is rare.
    let [mean, expected] = [&fixed, &quiet].map(|picture| picture.mean()[0]);
    assert!((mean / expected - 1.0).abs() < 0.5, "{mean} {expected}");
}

#[test]
fn every_material_reflects_as_much_of_a_lamp() {
    let ways = ["auto", "mis", "next-event"];
    let ggx = "{ ggx: { alpha: 0.25, reflectance: [0.9, 0.8, 0.7] } }";
    let phong = "{ phong: { diffuse: [0.3, 0.4, 0.2], specular: [0.5, 0.4, 0.3], exponent: 12 } }";
    let cloth = r#"{ bsdf: { map: ["sqrt(u)*cos(2*pi*v)", "sqrt(u)*sin(2*pi*v)", "sqrt(1-u)"],
        value: "0.6/pi*(1+0.3*cos_i)*(0.5+0.5*cos_o)", pdf: "cos_i/pi" } }"#;
    let mute = r#"{ bsdf: { map: ["sqrt(u)*cos(2*pi*v)", "sqrt(u)*sin(2*pi*v)", "sqrt(1-u)"],
        value: "0.6/pi*(1+0.3*cos_i)*(0.5+0.5*cos_o)" } }"#;
    let mirror = "{ mirror: { reflectance: [0.9, 0.8, 0.7] } }";
    let gold = "{ metal: { alpha: 0.25, reflectance: [0.9, 0.6, 0.2] } }";
    let chrome = "{ metal: { reflectance: [0.5, 0.5, 0.6] } }";
    for map in ["auto", "uniform-hemisphere"] {
        agree(&format!("matte, {map}"), MATTE, TWO, map, &["auto", "mis"]);
        agree(&format!("ggx, {map}"), ggx, QUAD, map, &ways);
        agree(&format!("metal, {map}"), gold, QUAD, map, &ways);
        agree(&format!("phong, {map}"), phong, QUAD, map, &ways);
        agree(&format!("cloth, {map}"), cloth, QUAD, map, &ways);
    }
    agree("without a density", mute, QUAD, "auto", &ways);
    agree("mirror", mirror, QUAD, "auto", &ways);
    agree("smooth metal", chrome, QUAD, "auto", &ways);
}

/// A floor whose lamp shines only on a mirror, or only through glass: no point of it is ever connected, and
/// the noise of its paths is no larger than without sampled lamps.
#[test]
fn light_by_mirror_or_glass_alone_is_no_worse() {
    const MIRROR: &str = "  - quad: { vertices: [[-3, 1.2, -3], [3, 1.2, -3], [3, 1.2, 3], [-3, 1.2, 3]], material: mirror }
  - quad: { vertices: [[-0.8, 0.9, -0.8], [-0.8, 0.9, 0.8], [0.8, 0.9, 0.8], [0.8, 0.9, -0.8]], material: lamp }\n";
    const GLASS: &str = "  - quad: { vertices: [[-3, 1.2, -3], [3, 1.2, -3], [3, 1.2, 3], [-3, 1.2, 3]], material: glass }
  - quad: { vertices: [[-0.8, 1.6, -0.8], [0.8, 1.6, -0.8], [0.8, 1.6, 0.8], [-0.8, 1.6, 0.8]], material: lamp }\n";
    let seen = |between: &str, lights: &str, bits: u32, seed: u64| -> Vec<[f64; 3]> {
        let text = format!(
            "name: between
camera: {{ perspective: {{ eye: [0, 0.7, 2.5], target: [0, 0, 1.4], vfov: 30 }} }}
film: {{ width: 8, height: 8 }}
materials:
  floor: {{ lambertian: {{ albedo: [0.8, 0.8, 0.8] }} }}
  mirror: {{ mirror: {{ reflectance: [0.9, 0.9, 0.9] }} }}
  glass: {{ dielectric: {{ ior: 1.5 }} }}
  lamp: {{ emitter: {{ radiance: [5, 5, 5] }} }}
geometry:
  - quad: {{ vertices: [[-3, 0, -3], [-3, 0, 3], [3, 0, 3], [3, 0, -3]], material: floor }}
{between}sampling: {}
",
            sampling(bits, lights, "auto")
        );
        let real = Real::new(&written(&text, &[]), seed).unwrap();
        let pixels: Vec<[u32; 2]> = (0..64).map(|k| [k % 8, k / 8]).collect();
        let paths = real.paths() as f64;
        let sums = real.sums(&pixels);
        sums.iter()
            .map(|sum| sum.colour.map(|c| c / paths))
            .collect()
    };
    for between in [MIRROR, GLASS] {
        let truth = seen(between, "none", 15, 99);
        assert!(mean(&truth) > 0.01, "{}", mean(&truth));
        let error = |lights| {
            let of = |seed| rms_difference(&seen(between, lights, 8, seed), &truth).powi(2);
            ((1..=32).map(of).sum::<f64>() / 32.0).sqrt() / mean(&truth)
        };
        let [with, without] = ["auto", "none"].map(error);
        assert!(with < 1.02 * without, "{with} with, {without} without");
    }
}

/// For pixels of the box that see no lamp: RMSE over the mean against many more paths.
#[test]
fn the_box_needs_few_paths() {
    let lit = |bits: u32, seed: u64| -> Vec<[f64; 3]> {
        let depth = "{ bits: [10, 10], light: [8, 8] }";
        let depths = format!("sampling.depths=[{{ bits: [10, 10] }}, {depth}, {depth}]");
        let bits = format!("sampling.path_bits={bits}");
        let sets = ["sampling.lights=auto", &*depths, &*bits];
        let scene = from_file("scenes-yaml/cornell-box.yaml", &sets);
        let classes = PixelClasses::new(&scene);
        let spread = (0..64 * 64).step_by(29).map(|k| [k % 64, k / 64]);
        // Also leave out the lamp's rim, whose light is not sampled.
        let away = |&[x, y]: &[u32; 2]| {
            let near = |x, y| classes.class([x, y]) == PixelClass::MayMeetLamp;
            let (left, above) = (x.saturating_sub(1), y.saturating_sub(1));
            !(left..=x + 1).any(|x| (above..=y + 1).any(|y| near(x, y)))
        };
        let pixels: Vec<[u32; 2]> = spread.filter(away).collect();
        assert!(pixels.len() > 100);
        let real = Real::new(&scene, seed).unwrap();
        let sums = real.sums(&pixels);
        let paths = real.paths() as f64;
        sums.iter()
            .map(|sum| sum.colour.map(|c| c / paths))
            .collect()
    };
    let truths = [lit(14, 101), lit(14, 102), lit(14, 103)];
    let truth: Vec<[f64; 3]> = (0..truths[0].len())
        .map(|k| [0, 1, 2].map(|c| truths.iter().map(|t| t[k][c]).sum::<f64>() / 3.0))
        .collect();
    for (bits, promise) in [(6, 0.08), (8, 0.04), (10, 0.013), (12, 0.007)] {
        let of = |seed| rms_difference(&lit(bits, seed), &truth) / mean(&truth);
        let error = (of(1).powi(2) + of(2).powi(2)).sqrt() * std::f64::consts::FRAC_1_SQRT_2;
        assert!(error <= promise, "2^{bits} paths: {error}");
    }
}

/// The scale of a pixel that meets no lamp is the light that a lamp gives, and no path exceeds it.
#[test]
fn scales_are_proven_by_class_of_pixel() {
    let depth = "{ bits: [8, 8], light: [8, 8] }";
    let depths = format!("sampling.depths=[{{ bits: [8, 8] }}, {depth}, {depth}]");
    let scene = from_file(
        "scenes-yaml/cornell-box.yaml",
        &[&depths, "sampling.path_bits=8", "sampling.lights=auto"],
    );
    let of = |class| Real::of_class(&scene, 0, class).unwrap();
    let all = of(PixelClass::MayMeetLamp).stage().bound();
    assert_eq!(all, [17.0, 12.0, 4.0]);
    let dim = of(PixelClass::MeetsNoLamp).stage().bound();
    assert!(dim[0] < 1.24 && dim[1] < 0.85 && dim[2] < 0.27, "{dim:?}");
    let classes = PixelClasses::new(&scene);
    let pixels: Vec<[u32; 2]> = (0..64 * 64).map(|k| [k % 64, k / 64]).collect();
    let (lit, unlit): (Vec<_>, Vec<_>) = pixels
        .into_iter()
        .partition(|&pixel| classes.class(pixel) == PixelClass::MayMeetLamp);
    assert!(lit.len() < 60, "{}", lit.len());
    let greatest = |real: &Real, pixels: &[[u32; 2]]| {
        let mut most = [0.0; 3];
        real.trace(pixels, |block| {
            for (most, colours) in most.iter_mut().zip(block.colours) {
                *most = colours.iter().copied().fold(*most, f64::max);
            }
        });
        most
    };
    let seen = greatest(&of(PixelClass::MeetsNoLamp), &unlit);
    for c in 0..3 {
        assert!(
            seen[c] <= dim[c] && seen[c] > 0.6 * dim[c],
            "{seen:?} {dim:?}"
        );
    }
    // Those pixels meet no lamp: with all emission their paths carry no more.
    assert_eq!(seen, greatest(&of(PixelClass::MayMeetLamp), &unlit));
}

/// For scenes of random faces, materials and lamps, some within each other: no path of any pixel
/// carries more than the scale of the pixel's class.
#[test]
fn no_path_of_random_scenes_exceeds_the_proven_scale() {
    const MATERIALS: [&str; 6] = ["lamp", "pale", "white", "mirror", "glass", "gloss"];
    let (mut near, mut sampled) = (0, 0);
    for seed in 0..40_u64 {
        let mut stream = Stream::new(seed, 0, 0, 0);
        let mut number = |low: f64, high: f64| low + (high - low) * stream.uniform();
        let mut faces = String::new();
        for face in 0..4 + seed % 5 {
            let centre = [number(-1.0, 1.0), number(0.0, 2.0), number(-1.0, 1.0)];
            let [a, b] = [(); 2].map(|()| [(); 3].map(|()| number(-0.8, 0.8)));
            // Every other face is vertical or horizontal, so that planes and edges meet.
            let flat = |v: [f64; 3]| if face % 2 == 0 { v } else { [v[0], 0.0, v[2]] };
            let (a, b) = (flat(a), flat(b));
            let at = |s: f64, t: f64| {
                let along = [0, 1, 2].map(|k| centre[k] + s * a[k] + t * b[k]);
                format!("[{:.3}, {:.3}, {:.3}]", along[0], along[1], along[2])
            };
            let corners = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];
            let triangle = number(0.0, 1.0) < 0.5;
            let (shape, corners) = if triangle {
                ("triangle", corners[..3].join(", "))
            } else {
                ("quad", corners.join(", "))
            };
            let material = match face {
                0 => "lamp",
                _ => MATERIALS[number(0.0, 6.0) as usize],
            };
            writeln!(
                faces,
                "  - {shape}: {{ vertices: [{corners}], material: {material} }}"
            )
            .unwrap();
        }
        let lights = ["auto", "mis"][(seed % 2) as usize];
        let depth = "{ bits: [6, 6], light: [6, 6] }";
        let text = format!(
            "name: random
camera: {{ perspective: {{ eye: [0.3, 1.4, 3.1], target: [0, 1, 0], vfov: 45 }} }}
film: {{ width: 6, height: 6 }}
materials:
  floor: {{ lambertian: {{ albedo: [0.8, 0.7, 0.9] }} }}
  white: {{ lambertian: {{ albedo: [0.9, 0.8, 0.7] }} }}
  mirror: {{ mirror: {{ reflectance: [0.9, 0.8, 0.7] }} }}
  glass: {{ dielectric: {{ ior: 1.5 }} }}
  gloss: {{ ggx: {{ alpha: 0.3, reflectance: [0.9, 0.8, 0.7] }} }}
  lamp: {{ emitter: {{ radiance: [6, 5, 4] }} }}
  pale: {{ emitter: {{ radiance: [1, 2, 3], albedo: [0.5, 0.6, 0.7] }} }}
geometry:
  - quad: {{ vertices: [[-2, 0, -2], [-2, 0, 2], [2, 0, 2], [2, 0, -2]], material: floor }}
{faces}
sampling: {{ path_bits: 8, lights: {lights}, depths: [{{ bits: [6, 6] }}, {depth}, {depth}] }}
"
        );
        let scene = written(&text, &[]);
        let classes = PixelClasses::new(&scene);
        for class in PixelClass::ALL {
            let real = Real::of_class(&scene, seed, class).unwrap();
            let scale = real.stage().bound();
            let pixels = (0..36).map(|k| [k % 6, k / 6]);
            let pixels: Vec<[u32; 2]> = pixels.filter(|&p| classes.class(p) == class).collect();
            sampled += pixels.len();
            let mut most = [0.0; 3];
            real.trace(&pixels, |block| {
                for (most, colours) in most.iter_mut().zip(block.colours) {
                    *most = colours.iter().copied().fold(*most, f64::max);
                }
            });
            for c in 0..3 {
                assert!(
                    most[c] <= scale[c] * (1.0 + 1e-9),
                    "{seed}: {most:?} {scale:?}\n{text}"
                );
                near += usize::from(most[c] > 0.3 * scale[c]);
            }
        }
    }
    // The test would be void if paths carried no light, or if scales were far above them.
    assert!(sampled > 1000 && near > 30, "{sampled} {near}");
}

/// A camera that nearly touches a lit wall sees the wall's light, at a scale that holds it.
#[test]
fn a_camera_close_to_a_wall_sees_what_lights_it() {
    let seen = |distance: f64| {
        let text = format!(
            "name: close
camera: {{ perspective: {{ eye: [0, 0, {distance:e}], target: [0, 0, -1], vfov: 40 }} }}
film: {{ width: 1, height: 1 }}
materials:
  lamp: {{ emitter: {{ radiance: [1, 1, 1] }} }}
  wall: {{ lambertian: {{ albedo: [0.7, 0.6, 0.5] }} }}
geometry:
  - quad: {{ vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], material: wall }}
  - quad: {{ vertices: [[-1, 1, 4], [1, 1, 4], [1, -1, 4], [-1, -1, 4]], material: lamp }}
sampling: {{ path_bits: 10, depths: [{{ bits: [6, 6] }}, {{ bits: [6, 6], light: [6, 6] }}] }}
"
        );
        let exact = RenderOptions {
            estimator: Some(Estimator::Exact),
            ..RenderOptions::default()
        };
        render(&written(&text, &[]), &exact).unwrap().image.pixels[0]
    };
    let far = seen(1e-3);
    assert!(far[0] > 0.01, "{far:?}");
    for distance in [1e-12, 1e-10, 1e-9, 1e-6] {
        for (close, far) in seen(distance).into_iter().zip(far) {
            assert!(
                (close / far - 1.0).abs() < 1e-3,
                "{distance}: {close} and {far}"
            );
        }
    }
}

/// A closed block of glass multiplies no light, for any number of refractions.
#[test]
fn closed_glass_does_not_multiply_the_scale() {
    let scene = |depths: usize| {
        let depths = vec!["{ bits: [8, 8] }"; depths].join(", ");
        from_file(
            "scenes-yaml/cornell-glass.yaml",
            &[
                &format!("sampling.depths=[{depths}]"),
                "sampling.path_bits=8",
            ],
        )
    };
    let bound = |depths| Real::new(&scene(depths), 0).unwrap().stage().bound()[0];
    let lamp = bound(1);
    for depths in [2, 4, 6] {
        assert!(bound(depths) <= lamp, "{depths}: {} {lamp}", bound(depths));
        // No path carries more, either.
        let scene = scene(depths);
        let real = Real::new(&scene, 1).unwrap();
        let pixels: Vec<[u32; 2]> = (0..64 * 64).map(|k| [k % 64, k / 64]).collect();
        let mut most = 0.0;
        real.trace(&pixels, |block| {
            most = block.colours[0].iter().copied().fold(most, f64::max);
        });
        assert!(
            most <= bound(depths) * (1.0 + 1e-12) && most > 0.0,
            "{most}"
        );
    }
}

#[test]
fn sampling_what_is_not_there_is_told_and_changes_nothing() {
    let dark = |light: &str| {
        room(
            MATTE,
            "",
            "",
            &format!("{{ path_bits: 6, depths: [{{ bits: [4, 4] }}, {{ bits: [4, 4]{light} }}] }}"),
        )
    };
    let warned = dark(", light: [4, 4]");
    // Other warnings: some materials of the room are not used.
    let codes = |scene: &ValidScene| -> Vec<&str> {
        let codes = scene.warnings().iter().map(Problem::code);
        codes.filter(|code| *code != "QRT0220").collect()
    };
    assert_eq!(codes(&warned), ["QRT0221"]);
    assert_eq!(warned.scene().sampling, dark("").scene().sampling);
    assert_eq!(codes(&dark("")), ["QRT0221"]);
}

/// The listed classes are those of which the film has a pixel.
#[test]
fn a_lamp_beside_the_film_makes_no_class_of_pixels() {
    const QUAD: &str =
        "quad: { vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], material: lamp }";
    // These triangles fill the film only together.
    const TRIANGLES: &str = "\
triangle: { vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0]], material: lamp }
  - triangle: { vertices: [[-1, -1, 0], [1, 1, 0], [-1, 1, 0]], material: lamp }";
    let scene = |lamp: &str, target: &str, vfov: u32, sets: &[&str]| {
        let text = format!(
            "\
name: lamp
camera: {{ perspective: {{ eye: [0, 0, 4], target: {target}, vfov: {vfov} }} }}
film: {{ width: 5, height: 4 }}
materials:
  grey: {{ lambertian: {{ albedo: [0.5, 0.5, 0.5] }} }}
  lamp: {{ emitter: {{ radiance: [4, 4, 4] }} }}
geometry:
  - {lamp}
  - quad: {{ vertices: [[-9, -9, -1], [9, -9, -1], [9, 9, -1], [-9, 9, -1]], material: grey }}
sampling: {{ path_bits: 4, depths: [{{ bits: [4, 4] }}, {{ bits: [4, 4], light: [4, 4] }}] }}
"
        );
        written(&text, sets)
    };
    let classes = |lamp: &str, target: &str, vfov: u32| {
        let classes = PixelClasses::new(&scene(lamp, target, vfov, &[]));
        let had = |class| {
            let pixels = (0..20).map(|k| [k % 5, k / 5]);
            pixels
                .map(|pixel| classes.class(pixel))
                .any(|of| of == class)
        };
        let had: Vec<PixelClass> = PixelClass::ALL.into_iter().filter(|&c| had(c)).collect();
        assert_eq!(classes.present(), had, "{lamp} {target} {vfov}");
        had.len()
    };
    // The lamp in the middle of the film; filling it; beside it; above it.
    let seen = [
        ("[0, 0, 0]", 60),
        ("[0, 0, 0]", 5),
        ("[3, 0, 0]", 20),
        ("[0, -3, 0]", 20),
    ];
    for lamp in [QUAD, TRIANGLES] {
        assert_eq!(
            seen.map(|(target, vfov)| classes(lamp, target, vfov)),
            [2, 1, 1, 1]
        );
    }
    // The classes of all of a large film's pixels are decided, too.
    let large = scene(
        TRIANGLES,
        "[0, 0, 0]",
        5,
        &["film={ width: 16384, height: 16384 }"],
    );
    let classes = PixelClasses::new(&large);
    assert_eq!(classes.present(), [PixelClass::MayMeetLamp]);
}

/// Lamps whose factor is far below the last bit of the circuit's numbers: the circuit's picture is that of
/// real numbers, and no path exceeds its bound.
#[test]
fn small_lamps_light_the_circuit_as_they_light_real_numbers() {
    for radius in [0.001, 0.01, 0.05] {
        let (low, high) = (-radius, radius);
        let sphere = format!("sphere: {{ center: [0, 3, 0], radius: {radius}, material: lamp }}");
        let quad = format!(
            "quad: {{ vertices: [[{low}, 3, {low}], [{high}, 3, {low}], [{high}, 3, {high}], [{low}, 3, {high}]], \
             material: lamp }}"
        );
        for (lamp, lights) in [
            (&sphere, "next-event"),
            (&sphere, "mis"),
            (&quad, "next-event"),
            (&quad, "mis"),
        ] {
            let text = format!(
                "name: small
camera: {{ perspective: {{ eye: [0, 1, 4], target: [0, 0, 0], vfov: 20 }} }}
film: {{ width: 4, height: 4 }}
materials:
  white: {{ lambertian: {{ albedo: 0.75 }} }}
  lamp: {{ emitter: {{ radiance: [9, 8, 7] }} }}
geometry:
  - quad: {{ vertices: [[-3, 0, 3], [3, 0, 3], [3, 0, -2], [-3, 0, -2]], material: white }}
  - {lamp}
sampling: {{ path_bits: 6, depths: 2, lights: {lights} }}
"
            );
            let scene = written(&text, &[]);
            let [real, fixed] = [Model::Real, Model::Fixed].map(|model| {
                let options = RenderOptions {
                    model: Some(model),
                    estimator: Some(Estimator::Exact),
                    ..RenderOptions::default()
                };
                let rendered = render(&scene, &options);
                let rendered =
                    rendered.unwrap_or_else(|error| panic!("{lamp} {lights} {model:?}: {error}"));
                mean(&rendered.image.pixels)
            });
            assert!(real > 0.0, "{lamp} {lights}");
            let off = (fixed / real - 1.0).abs();
            assert!(off < 0.005, "{lamp} {lights}: {fixed} for {real}");
        }
    }
}
