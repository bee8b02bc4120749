//! Tests that the hierarchy of boxes finds exactly the hits of a loop over all faces: the same bytes.

use crate::common::scene::{from_file, written};
use qrt::runtime::path_machines::{Real, Simd, SingleRay};
use qrt::scene::valid::ValidScene;
use qrt::tracer::{NO_PLANE, Start};
use std::fmt::Write as _;

const KNOT: &str = "scenes-yaml/knot.yaml";

/// Returns every path's colour, bit for bit.
fn colours(real: &Real) -> Vec<u64> {
    let pixels: Vec<[u32; 2]> = (0..36).map(|i| [i % 6, i / 6]).collect();
    let mut bits = Vec::new();
    real.trace(&pixels, |block| {
        bits.extend(
            block
                .colours
                .iter()
                .flat_map(|c| c.iter().map(|c| c.to_bits())),
        );
    });
    bits
}

fn assert_same(scene: &ValidScene) {
    let machine = || Real::new(scene, 3).unwrap();
    let looped = colours(&machine().with_boxes(false));
    assert!(
        looped.iter().any(|&bits| bits != 0),
        "nothing is lit: the test would see nothing"
    );
    assert_eq!(looped, colours(&machine().with_boxes(true)));
    let scalar = machine().with_simd(Simd::Scalar);
    assert_eq!(
        looped,
        colours(&scalar.clone().with_boxes(true)),
        "one lane, boxes"
    );
    assert_eq!(
        looped,
        colours(&scalar.with_boxes(false)),
        "one lane, all faces"
    );
}

const HEAD: &str = "
name: faces
camera: { perspective: { eye: [0.3, 1.1, -2.4], target: [0, 0.4, 0], vfov: 45 } }
film: { width: 6, height: 6 }
sampling: { path_bits: 8, depths: [{ bits: [6, 6] }, { bits: [6, 6] }, { bits: [6, 6] }, { bits: [6, 6] }], lights: none }
materials:
  grey: { lambertian: { albedo: [0.6, 0.5, 0.4] } }
  glass: { dielectric: { ior: 1.4 } }
  satin: { ggx: { alpha: 0.3, reflectance: [0.9, 0.8, 0.7] } }
  lamp: { emitter: { radiance: [3, 2, 1], albedo: [0.5, 0.5, 0.5] } }
geometry:
  - quad: { vertices: [[-2, 0, -2], [-2, 0, 2], [2, 0, 2], [2, 0, -2]], material: grey }
  - quad: { vertices: [[-1, 2, -1], [1, 2, -1], [1, 2, 1], [-1, 2, 1]], material: lamp }
";

#[test]
fn over_a_mesh() {
    let sets = ["film.width=6", "film.height=6", "sampling.path_bits=9"];
    assert_same(&from_file(KNOT, &sets));
}

/// Rays to points on lamps, one of which covers a part of another, and one of which is in a wall's plane.
#[test]
fn over_shadows() {
    let depth = "{ bits: [6, 6], light: [6, 6] }";
    let depths = format!("sampling.depths=[{{ bits: [6, 6] }}, {depth}, {depth}]");
    let sets = [
        "film.width=6",
        "film.height=6",
        "sampling.path_bits=8",
        &depths,
    ];
    for lights in ["sampling.lights=auto", "sampling.lights=mis"] {
        assert_same(&from_file(KNOT, &[&sets[..], &[lights]].concat()));
        let lamps = "
  - quad: { vertices: [[-0.4, 2, -0.4], [0.2, 2, -0.4], [0.2, 2, 0.2], [-0.4, 2, 0.2]], material: lamp }
  - triangle: { vertices: [[1.5, 0, 0.5], [1.5, 0, 1.5], [1.8, 0, 0.5]], material: lamp }
  - triangle: { vertices: [[-1.5, 0.2, 0.5], [-1.5, 0.2, 1.5], [-1.5, 1, 0.5]], material: satin }
";
        let text = format!("{HEAD}{lamps}");
        assert_same(&written(&text, &[&sets[..], &[lights]].concat()));
    }
}

/// Rays from so far away that they arrive with an error far above a near ray's.
#[test]
fn over_a_mesh_seen_from_afar() {
    let sets = [
        "film.width=6",
        "film.height=6",
        "sampling.path_bits=9",
        "camera.perspective.eye=[4.0e6, 1.7e7, -2.0e7]",
        "camera.perspective.vfov=5.0e-6",
    ];
    assert_same(&from_file(KNOT, &sets));
}

/// Returns a generator of numbers from -1 to 1, the same in each run.
fn random() -> impl FnMut() -> f64 {
    let mut state = 7_u64;
    move || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Spheres apart, overlapping and nested, some of them lamps, with a triangle between.
#[test]
fn over_spheres() {
    let mut random = random();
    let mut text = format!("{HEAD}\n");
    for number in 0..90 {
        let center = [random(), 0.6 + 0.6 * random(), random()];
        let radius = 0.02 + 0.1 * random().abs();
        let material = ["grey", "glass", "satin", "grey", "lamp"][number % 5];
        writeln!(
            text,
            "  - sphere: {{ center: {center:?}, radius: {radius}, material: {material} }}"
        )
        .unwrap();
    }
    text.push_str(
        "  - triangle: { vertices: [[-1, 0.2, 0.5], [1, 0.3, 1.5], [0, 1, 0.5]], material: satin }\n",
    );
    assert_same(&written(&text, &[]));
    let depth = "{ bits: [6, 6], light: [6, 6] }";
    let lit = format!("sampling.depths=[{{ bits: [6, 6] }}, {depth}, {depth}]");
    assert_same(&written(&text, &[&lit, "sampling.lights=auto"]));
    assert_same(&written(&text, &["sky={ horizon: 1, zenith: 2 }"]));
}

/// Discs of all sizes and directions among triangles, some of them lamps, some on the planes of others.
#[test]
fn over_discs() {
    let mut random = random();
    let mut text = format!("{HEAD}\n");
    for number in 0..90 {
        let mut center = [random(), 0.6 + 0.6 * random(), random()];
        let mut normal = [random(), random(), random()];
        if number % 3 == 0 {
            normal = [0.0, 1.0 - 2.0 * f64::from(number % 2), 0.0];
            center[1] = 0.25 * f64::from(number % 5);
        }
        let radius = 0.02 + 0.2 * random().abs();
        let material = ["grey", "glass", "satin", "grey", "lamp"][number as usize % 5];
        let material = if normal[0] == 0.0 && material == "glass" {
            "grey"
        } else {
            material
        };
        writeln!(
            text,
            "  - disc: {{ center: {center:?}, normal: {normal:?}, radius: {radius}, material: {material} }}"
        )
        .unwrap();
        let [x, y, z] = center;
        writeln!(
            text,
            "  - triangle: {{ vertices: [[{x}, {y}, {z}], [{}, {y}, {z}], [{x}, {}, {}]], material: satin }}",
            x + 0.1,
            y + 0.05,
            z + 0.1
        )
        .unwrap();
    }
    assert_same(&written(&text, &[]));
    let depth = "{ bits: [6, 6], light: [6, 6] }";
    let lit = format!("sampling.depths=[{{ bits: [6, 6] }}, {depth}, {depth}]");
    assert_same(&written(&text, &[&lit, "sampling.lights=auto"]));
}

/// Directions of any length, almost or exactly along an axis, from near and from afar, alone or many: the
/// boxes are of single precision, which holds few of these numbers.
#[test]
fn over_rays_of_extreme_lengths_and_places() {
    let scene = from_file(KNOT, &[]);
    let machine = || Real::new(&scene, 3).unwrap();
    let (looped, boxed) = (machine().with_boxes(false), machine().with_boxes(true));
    let mut random = random();
    for length in [1e-40, 1e-18, 1e-9, 1.0, 1e9, 1e18, 1e40] {
        for far in [0.2, 1.0, 3.0, 1e4, 1e8] {
            for thin in [0.0, 1e-300, 1e-30, 1e-13, 1e-9, 1e-4, 1.0] {
                // A film may lie on a plane.
                let starts = [
                    (NO_PLANE, Start::Camera),
                    (0, Start::Camera),
                    (0, Start::Surface),
                ];
                for (from, start) in starts {
                    let rays: Vec<SingleRay> = (0..24)
                        .map(|ray| {
                            let place = [0; 3].map(|_| random());
                            let mut direction = [0; 3].map(|_| thin * random());
                            let axis = ray % 3;
                            direction[axis] = random();
                            let mut origin = place.map(|p| 0.3 * p);
                            origin[axis] -= far * direction[axis].signum();
                            SingleRay {
                                origin,
                                direction: direction.map(|d| length * d),
                                from,
                                start,
                            }
                        })
                        .collect();
                    let what =
                        format!("length {length}, from {far}, thin {thin}, {from}, {start:?}");
                    assert_eq!(looped.nearest(&rays), boxed.nearest(&rays), "{what}");
                }
            }
        }
    }
}

/// Camera rays are traced together if they go the same way: bundles of all widths, from one point or
/// from many, along an axis or across, a few of them too small for all lanes of a vector.
#[test]
fn over_bundles_of_rays() {
    let scene = from_file(KNOT, &[]);
    let machine = || Real::new(&scene, 3).unwrap();
    let scalar = machine().with_simd(Simd::Scalar);
    let (looped, boxed) = (machine().with_boxes(false), machine().with_boxes(true));
    let mut random = random();
    let mut met = 0;
    for bundle in 0..240 {
        let spread = [0.0, 1e-3, 0.1][bundle % 3];
        let width = [1e-4, 1e-2, 0.3, 1.0][bundle % 4];
        let eye = [0; 3].map(|_| 1.5 * random());
        let ahead = eye.map(|e| 0.4 * random() - e);
        let rays: Vec<SingleRay> = (0..16 - bundle % 5)
            .map(|_| {
                let mut direction = ahead.map(|d| d + width * random());
                if bundle % 7 == 0 {
                    direction[bundle % 3] = 0.0_f64.copysign(random());
                }
                SingleRay {
                    origin: eye.map(|e| e + spread * random()),
                    direction,
                    from: [NO_PLANE, 0][bundle / 4 % 2],
                    start: Start::Camera,
                }
            })
            .collect();
        let expected = looped.nearest(&rays);
        assert_eq!(expected, boxed.nearest(&rays), "bundle {bundle}");
        if bundle % 16 == 0 {
            assert_eq!(expected, scalar.nearest(&rays), "bundle {bundle}, one lane");
        }
        met += expected.iter().flatten().count();
    }
    assert!(
        met > 1000,
        "{met} rays met anything: the test would see nothing"
    );
}

/// Cubes of every material, some of them in the same place: ties, shared edges, coplanar overlaps
/// of lamps and walls.
#[test]
fn over_cubes_that_touch_and_coincide() {
    let mut text = HEAD.to_owned();
    let corner = |x: f64, y: f64, z: f64| format!("[{x}, {y}, {z}]");
    for (number, material) in ["grey", "glass", "satin", "lamp"]
        .iter()
        .cycle()
        .take(24)
        .enumerate()
    {
        let (column, row) = ((number % 5) as f64, (number / 5) as f64);
        let (x, y, z, s) = (
            -1.0 + 0.4 * column,
            0.4 * (number % 3) as f64,
            -1.0 + 0.4 * row,
            0.4,
        );
        let p = |i: u32| {
            let on = |bit: u32| f64::from(i >> bit & 1) * s;
            corner(x + on(0), y + on(1), z + on(2))
        };
        for [a, b, c, d] in [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
        ] {
            let (a, b, c, d) = (p(a), p(b), p(c), p(d));
            writeln!(
                text,
                "  - quad: {{ vertices: [{a}, {b}, {c}, {d}], material: {material} }}"
            )
            .unwrap();
        }
    }
    assert_same(&written(&text, &[]));
}

/// More emitting faces than a last ray tests one by one.
#[test]
fn over_many_lamps() {
    let mut text = HEAD.to_owned();
    for number in 0..40 {
        let (x, z) = (
            -1.0 + 0.25 * f64::from(number % 8),
            -0.6 + 0.3 * f64::from(number / 8),
        );
        let y = 0.2 + 0.05 * f64::from(number % 3);
        let material = if number % 2 == 0 { "lamp" } else { "grey" };
        writeln!(
            text,
            "  - triangle: {{ vertices: [[{x}, {y}, {z}], [{}, {y}, {z}], [{x}, {y}, {}]], material: {material} }}",
            x + 0.3,
            z + 0.3
        )
        .unwrap();
    }
    assert_same(&written(&text, &[]));
}
