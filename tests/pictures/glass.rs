//! Tests of glass in any arrangement: closed, nested, overlapping, its fronts outwards or inwards, the camera within.

use crate::common::cuboid::sides;
use crate::common::numbers::Numbers;
use crate::common::scene::written;
use qrt::prelude::*;
use qrt::runtime::path_machines::Real;
use qrt::scene::front::parse;
use std::fmt::Write as _;

fn exact(model: Model) -> RenderOptions<'static> {
    RenderOptions {
        model: Some(model),
        estimator: Some(Estimator::Exact),
        ..RenderOptions::default()
    }
}

fn red(text: &str, model: Model) -> Vec<f64> {
    let rendered = render(&written(text, &[]), &exact(model));
    let rendered = rendered.unwrap_or_else(|error| panic!("{error}\n{text}"));
    rendered.image.pixels.iter().map(|pixel| pixel[0]).collect()
}

/// Returns the six sides of a box of a material, whose fronts face outwards or inwards.
fn cuboid(low: [f64; 3], high: [f64; 3], inwards: bool, material: &str) -> String {
    let mut text = String::new();
    for corners in sides(low, high, inwards) {
        let _ = writeln!(
            text,
            "  - quad: {{ vertices: {corners:?}, material: {material} }}"
        );
    }
    text
}

/// Returns a lamp in a box of glass: from outside, behind two faces of the box.
fn lamp_in_a_box(ior: f64, inwards: bool, camera: &str) -> String {
    format!(
        "name: box\ncamera: {camera}\nfilm: {{ width: 2, height: 2 }}\nmaterials:\n  lamp: {{ emitter: {{ \
         radiance: [1, 1, 1] }} }}\n  glass: {{ dielectric: {{ ior: {ior} }} }}\ngeometry:\n{}  - quad: {{ \
         vertices: [[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]], material: lamp \
         }}\nsampling: {{ path_bits: 6, depths: [{{ bits: [6, 6] }}, {{ bits: [6, 6] }}], lights: none }}\n",
        cuboid([-1.0; 3], [1.0; 3], inwards, "glass")
    )
}

/// Straight ahead, a path refracts with probability 1 - F into a medium that is `index` as dense, and then
/// sees the lamp, whose radiance grows with the squared index at the eye.
#[test]
fn a_lamp_in_a_bubble_is_as_bright_as_in_the_block_that_is_the_same() {
    let camera = "{ perspective: { eye: [0.1, 0.2, 3], target: [0, 0, 0], vfov: 6 } }";
    for ior in [1.5_f64, 0.75] {
        let bubble = lamp_in_a_box(ior, true, camera);
        let block = lamp_in_a_box(1.0 / ior, false, camera);
        let straight: f64 = ((ior - 1.0) / (ior + 1.0)).powi(2);
        for model in [Model::Real, Model::Fixed, Model::Gates] {
            let (bubble, block) = (red(&bubble, model), red(&block, model));
            for (bubble, block) in bubble.into_iter().zip(block) {
                assert!(
                    (bubble / block - 1.0).abs() < 1e-3,
                    "{model:?} {bubble} {block}"
                );
                let expected = (1.0 - straight) * ior * ior;
                // Among 64 cells, one more or less is reflected; and the direction is a little oblique.
                assert!(
                    (bubble / expected - 1.0).abs() < 0.03,
                    "{model:?} {bubble} {expected}"
                );
            }
        }
    }
}

/// The eye is within a block, or the film cuts through one: no refraction on the way out cancels the gain.
#[test]
fn from_within_glass_light_is_denser() {
    for (inwards, ior) in [(false, 1.5_f64), (true, 1.0 / 1.5)] {
        let eyes = [
            "{ perspective: { eye: [0.1, 0.2, 0.5], target: [0.1, 0.2, 5], vfov: 6 } }",
            "{ orthographic: { eye: [0.1, 0.2, 0.5], target: [0.1, 0.2, 5], height: 1 } }",
            // Corners of the film are outside.
            "{ orthographic: { eye: [0, 0, 0.5], target: [0, 0, 5], height: 6 } }",
        ];
        for camera in eyes {
            let text = lamp_in_a_box(ior, inwards, camera).replace(
                "[[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]]",
                "[[-9, 9, 4], [9, 9, 4], [9, -9, 4], [-9, -9, 4]]",
            );
            let [real, fixed, gates] =
                [Model::Real, Model::Fixed, Model::Gates].map(|m| red(&text, m));
            let most = real.iter().copied().fold(0.0, f64::max);
            let whole = if camera.contains("height: 6") {
                1.1
            } else {
                2.1
            };
            assert!((whole..2.26).contains(&most), "{camera} {most}");
            assert_eq!(fixed, gates);
            for (real, fixed) in real.iter().zip(fixed) {
                assert!((real - fixed).abs() < 0.01, "{camera} {real} {fixed}");
            }
        }
    }
}

/// Another transmitting material lies on a side of a block, earlier in the list: rays enter through it and
/// leave through glass, refracted once, so that light gains a factor that it does not lose again.
#[test]
fn beside_glass_that_is_covered_the_bound_holds() {
    for (ior, inwards) in [(1.5, false), (0.75, false), (1.5, true)] {
        let text = format!(
            "name: cover\ncamera: {{ perspective: {{ eye: [0.1, 0.2, 3], target: [0, 0, 0], vfov: 40 }} }}\nfilm: {{ \
             width: 2, height: 2 }}\nmaterials:\n  lamp: {{ emitter: {{ radiance: [1, 1, 1] }} }}\n  glass: {{ \
             dielectric: {{ ior: {ior} }} }}\n  veil: {{ bsdf: {{ map: [\"2*sqrt(u-u^2)*cos(2*pi*v)\", \
             \"2*sqrt(u-u^2)*sin(2*pi*v)\", \"1-2*u\"], value: \"0.1\" }} }}\ngeometry:\n  - quad: {{ vertices: \
             [[-2, -2, 1], [2, -2, 1], [2, 2, 1], [-2, 2, 1]], material: veil }}\n{}{}sampling: {{ path_bits: 10, \
             depths: [{{ bits: [4, 4] }}, {{ bits: [4, 4] }}, {{ bits: [4, 4] }}], lights: none }}\n",
            cuboid([-1.0; 3], [1.0; 3], inwards, "glass"),
            cuboid([-8.0; 3], [8.0; 3], true, "lamp"),
        );
        let (real, fixed) = (red(&text, Model::Real), red(&text, Model::Fixed));
        for (real, fixed) in real.iter().zip(fixed) {
            assert!(
                *real > 0.0 && (real / fixed - 1.0).abs() < 0.02,
                "{real} {fixed}\n{text}"
            );
        }
    }
}

/// Returns a light of radiance 1 from everywhere, around boxes of glass.
fn furnace(numbers: &mut Numbers) -> String {
    let mut geometry = cuboid([-16.0; 3], [16.0; 3], true, "light");
    let grid = |numbers: &mut Numbers| (numbers.below(13) as f64 - 6.0) / 2.0;
    for _ in 0..=numbers.below(4) {
        let low = [(); 3].map(|()| grid(numbers));
        let high = low.map(|low| low + 0.5 + numbers.below(6) as f64 / 2.0);
        let inwards = numbers.below(3) == 0;
        let material = ["glass", "water", "air"][numbers.below(3)];
        geometry += &cuboid(low, high, inwards, material);
    }
    let eye = [(); 3].map(|()| grid(numbers) + 0.25);
    let eye = [
        eye[0],
        eye[1],
        if numbers.below(2) == 0 { 12.0 } else { eye[2] },
    ];
    format!(
        "name: furnace\ncamera: {{ perspective: {{ eye: {eye:?}, target: [0.1, 0, 0.2], up: [7, 9, 2], vfov: 40 \
         }} }}\nfilm: {{ width: 4, height: 4 }}\nmaterials:\n  light: {{ emitter: {{ radiance: [1, 1, 1] }} }}\n  \
         glass: {{ dielectric: {{ ior: 1.5 }} }}\n  water: {{ dielectric: {{ ior: 1.33 }} }}\n  air: {{ \
         dielectric: {{ ior: 0.8 }} }}\ngeometry:\n{geometry}sampling: {{ path_bits: 8, depths: [{{ bits: [8, 8] \
         }}{}], lights: none }}\n",
        ", { bits: [8, 8] }".repeat(11)
    )
}

/// The radiance is the squared index at the eye, over that where the path ends, outside: 1, or the value
/// that the pieces around the eye give.
#[test]
fn in_a_furnace_all_paths_around_any_glass_see_one_radiance_or_are_cut_off() {
    let (mut seen, mut cut, mut refused) = (0_u64, 0_u64, 0);
    for seed in 0..200 {
        let text = furnace(&mut Numbers(seed));
        let Ok(loaded) = parse(&text, "furnace.yaml", &[], "".as_ref()) else {
            // Pieces that touch are refused.
            refused += 1;
            continue;
        };
        let real = Real::new(&loaded.valid, seed).unwrap();
        let pixels: Vec<[u32; 2]> = (0..16).map(|n| [n % 4, n / 4]).collect();
        let mut radiance: Option<f64> = None;
        real.trace(&pixels, |block| {
            for &colour in block.colours[0] {
                if colour == 0.0 {
                    cut += 1;
                    continue;
                }
                seen += 1;
                let first = *radiance.get_or_insert(colour);
                assert!(
                    (colour / first - 1.0).abs() < 1e-9,
                    "seed {seed}: {colour} {first}\n{text}"
                );
            }
        });
        let rendered = render(&loaded.valid, &exact(Model::Real));
        assert!(rendered.is_ok(), "{:?}\n{text}", rendered.err());
    }
    assert!(refused < 150, "{refused}");
    // Twelve rays: most paths have left by then.
    assert!(cut * 2 < seen, "{cut} of {seen}");
}
