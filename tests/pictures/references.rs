//! Compares the real model's pictures with those of an independent renderer.
//!
//! The possible difference is known: a randomly shifted digital net is unbiased, and two seeds show the
//! distance of a picture from its limit. With pictures A and B of two seeds, the error of their mean has
//! the mean square `|A - B|^2 / 4`; the reference has its own standard error. The distance of a right
//! picture from the reference is about the root of the sum of both, and that of a wrong one is not.
//!
//! `cargo bench --bench references` compares pictures of more paths.

use super::independent::{self, Picture, Reference, SIDE, mean, rms_difference, traced};
use qrt_scene::valid::ValidScene;

/// Factor by which the distance may exceed its expectation. It is a root mean square over 256 pixels with
/// heavy tails, of which about a tenth varies by chance; 1.5 times the expectation is beyond chance.
const CHANCE: f64 = 1.5;

/// Allowance for 10 bits per direction's coordinate, instead of all, as a fraction of the mean.
const CELLS: f64 = 2e-3;

/// Allowed error of a mean in standard deviations: the tests look at some 190 means, and one in 370 exceeds 3.
const SIGMAS: f64 = 4.0;

/// The mean of two pictures of one scene, and its error.
struct Measured {
    picture: Picture,
    /// Root mean square error of the picture, from the two seeds' difference.
    error: f64,
}

fn measure(scene: &ValidScene) -> Measured {
    let (a, b) = (traced(scene, 1), traced(scene, 2));
    let pairs = a.iter().zip(&b);
    Measured {
        picture: pairs
            .map(|(a, b)| std::array::from_fn(|c| 0.5 * (a[c] + b[c])))
            .collect(),
        error: 0.5 * rms_difference(&a, &b),
    }
}

/// Checks that a picture equals the reference, within the errors of both.
fn compare(ours: &Measured, theirs: &Reference) -> Result<(), String> {
    let level = mean(&theirs.picture);
    let noise = rms_difference(
        &theirs.standard_error,
        &vec![[0.0; 3]; theirs.standard_error.len()],
    );
    let expected = ours.error.hypot(noise);
    let rmse = rms_difference(&ours.picture, &theirs.picture);
    let bound = CHANCE * expected + CELLS * level;
    let shift = mean(&ours.picture) - level;
    // Pixels are independent of each other; a pixel's channels are not.
    let mean_bound = SIGMAS * expected / f64::from(SIDE) + CELLS * level;
    let figures = format!(
        "RMSE {:.5} of {:.5}, mean {:+.5} of {:.5} (all over the mean {level:.5})",
        rmse / level,
        bound / level,
        shift / level,
        mean_bound / level
    );
    if rmse <= bound && shift.abs() <= mean_bound {
        Ok(())
    } else {
        Err(figures)
    }
}

/// Checks the scene at every depth, under each of two seeds with `2^path_bits` paths, and four times that number at
/// D = 1. `promise` is the promised RMSE over the mean with 2^18 paths.
fn agrees(name: &str, path_bits: u32, promise: f64) {
    for depth in 1..=4 {
        // At D = 1 only edges make noise. Two seeds with few paths do not show how much. Paths of one ray are cheap.
        let path_bits = path_bits + if depth == 1 { 2 } else { 0 };
        let asking = independent::asking(10, depth, path_bits, "none");
        agrees_at(name, depth, path_bits, promise, &asking);
    }
}

/// Checks the same with lamps sampled, in both ways; `promise` is the promised RMSE with 2^12 paths. A path of one
/// ray samples no lamp, so D begins at 2.
fn agrees_by_lamps(name: &str, path_bits: u32, promise: f64) {
    for lights in ["auto", "mis"] {
        for depth in 2..=4 {
            let asking = independent::asking(10, depth, path_bits, lights);
            // `agrees_at` states it for 2^18 paths, with an error that falls like that of random ones.
            agrees_at(name, depth, path_bits, promise / 8.0, &asking);
        }
    }
}

/// Checks the scene at one depth.
fn agrees_at(name: &str, depth: usize, path_bits: u32, promise: f64, asking: &[String]) {
    let scene = independent::scene(name, asking);
    let reference = independent::reference(name, depth);
    let level = mean(&reference.picture);
    let ours = measure(&scene);
    if level == 0.0 {
        assert!(
            ours.picture.iter().all(|p| *p == [0.0; 3]),
            "{name} D={depth}"
        );
        return;
    }
    if let Err(figures) = compare(&ours, &reference) {
        panic!("{name} D={depth}: {figures}");
    }
    // A net is never worse than random paths, whose error grows by sqrt(2) per bit less.
    let fewer = f64::from(18 - (path_bits + 1));
    let most = promise * (0.5 * fewer).exp2() * level;
    assert!(
        ours.error <= most,
        "{name} D={depth}: own error {} exceeds {}",
        ours.error / level,
        most / level
    );
}

#[test]
fn the_cornell_box_agrees() {
    agrees("cornell", 10, 0.015);
}

#[test]
fn the_cornell_box_of_the_classic_colours_agrees() {
    agrees("cornell_mg", 10, 0.015);
}

#[test]
fn the_mirror_wall_agrees() {
    agrees("cornell_mirrorwall", 10, 0.03);
}

#[test]
fn the_glass_block_agrees() {
    agrees("cornell_glass", 10, 0.03);
}

#[test]
fn the_ggx_block_agrees() {
    agrees("cornell_ggx", 10, 0.03);
}

#[test]
fn the_floor_and_light_agree() {
    agrees("floorlight", 10, 0.015);
}

#[test]
fn the_furnace_agrees() {
    agrees("furnace", 4, 0.015);
}

#[test]
fn the_mesh_agrees() {
    agrees("torusknot8k", 10, 0.015);
}

#[test]
fn the_cornell_boxes_agree_by_lamps() {
    agrees_by_lamps("cornell", 10, 0.012);
    agrees_by_lamps("cornell_mg", 10, 0.012);
}

#[test]
fn boxes_with_other_materials_agree_by_lamps() {
    agrees_by_lamps("cornell_ggx", 10, 0.03);
    // Light of a lamp by way of glass or mirrors is still found by chance.
    agrees_by_lamps("cornell_glass", 10, 0.25);
    agrees_by_lamps("cornell_mirrorwall", 10, 0.25);
}

#[test]
fn floor_furnace_and_mesh_agree_by_lamps() {
    agrees_by_lamps("floorlight", 10, 0.006);
    agrees_by_lamps("furnace", 10, 0.02);
    agrees_by_lamps("torusknot8k", 10, 0.012);
}

#[test]
fn spheres_under_a_sky_agree() {
    agrees("marbles", 10, 0.01);
    agrees("cut_spheres", 10, 0.01);
    agrees("in_glass", 10, 0.01);
}

#[test]
fn boxes_and_coloured_glass_agree() {
    agrees("bottles", 10, 0.01);
}

#[test]
fn checkers_agree() {
    agrees("tiles", 10, 0.01);
}

#[test]
fn colours_of_vertices_agree() {
    agrees("painted", 10, 0.02);
    agrees_by_lamps("painted", 10, 0.05);
}

#[test]
fn spheres_through_a_lens_agree() {
    agrees("lensed", 10, 0.01);
}

#[test]
fn lamps_that_are_spheres_agree() {
    agrees("bulbs", 12, 0.1);
    agrees_by_lamps("bulbs", 10, 0.1);
}

/// Discs that are lamps, sampled and not, and discs that shade.
#[test]
fn discs_agree() {
    agrees("discs", 12, 0.1);
    agrees_by_lamps("discs", 11, 0.1);
}

/// A sun and a sky, beside a lamp, with shadows on matte and glossy things. By chance the sun is met rarely.
#[test]
fn a_sun_agrees() {
    agrees("sun", 11, 0.2);
    agrees_by_lamps("sun", 10, 0.1);
}

/// All parts of scenes at once: a sky, a sun, a lens, tiles, a disc, boxes, spheres of coloured glass, satin, clay and
/// chrome, and up to six rays on a path.
#[test]
fn a_terrace_agrees() {
    agrees_at(
        "terrace",
        1,
        11,
        0.1,
        &independent::asking(10, 1, 11, "none"),
    );
    for depth in 2..=6 {
        for lights in ["auto", "mis"] {
            let asking = independent::asking(10, depth, 9, lights);
            agrees_at("terrace", depth, 9, 0.1, &asking);
        }
    }
}

/// Smooth and rough metal on spheres, discs, boxes and tiles, by a sky and a sun, and by lamps in a room.
#[test]
fn metal_agrees() {
    for name in ["metals", "workshop"] {
        for depth in 1..=6 {
            for lights in ["none", "mis"] {
                let asking = independent::asking(10, depth, 9, lights);
                agrees_at(name, depth, 9, 0.02, &asking);
            }
        }
    }
}

/// Smooth meshes of glass, metal and clay in a room. Its file and materials have the form that Blender's
/// exporter writes.
#[test]
fn a_room_in_blenders_form_agrees() {
    agrees("blender_room", 10, 0.15);
    agrees_by_lamps("blender_room", 10, 0.1);
}

#[test]
fn the_furnace_is_exact_at_every_depth() {
    let (radiance, albedo) = ([1.0, 0.5, 0.25], [0.25, 0.5, 0.8]);
    for depth in 1..=16 {
        let scene = independent::scene("furnace", &independent::asking(10, depth, 5, "none"));
        let exact: [f64; 3] = std::array::from_fn(|c| {
            radiance[c] * (1.0 - f64::powi(albedo[c], depth as i32)) / (1.0 - albedo[c])
        });
        for pixel in traced(&scene, 3) {
            for c in 0..3 {
                let error = (pixel[c] / exact[c] - 1.0).abs();
                assert!(error < 1e-9, "D={depth}: {pixel:?}, not {exact:?}");
            }
        }
    }
}

/// Returns the radiance of the floor by the closed form, for a floor of `scale` times the scene's albedo.
fn floor(scale: f64) -> Reference {
    let full = [0.8 * 10.0, 0.5 * 8.0, 0.2 * 6.0];
    let form_factors = independent::array("floorlight_exact_F_16.npy");
    let pixel = |f: &f64| full.map(|c| scale * c * f);
    Reference {
        picture: form_factors.iter().map(pixel).collect(),
        standard_error: vec![[0.0; 3]; form_factors.len()],
    }
}

#[test]
fn the_floor_is_its_closed_form_at_every_depth_and_by_every_map() {
    let exact = floor(1.0);
    for map in ["auto", "cosine-hemisphere", "uniform-hemisphere"] {
        for depth in 2..=4 {
            let mut sets = independent::asking(10, depth, 13, "none");
            sets.push(format!("sampling.depths[1].map={map}"));
            let ours = measure(&independent::scene("floorlight", &sets));
            assert_eq!(compare(&ours, &exact), Ok(()), "{map} D={depth}");
        }
    }
}

const COSINE: &str = "['sqrt(u)*cos(2*pi*v)', 'sqrt(u)*sin(2*pi*v)', 'sqrt(1-u)']";
const UNIFORM: &str = "['sqrt(1-u^2)*cos(2*pi*v)', 'sqrt(1-u^2)*sin(2*pi*v)', 'u']";

/// Renders the floor with a user-defined BSDF, whose values hold half of the scene's albedo.
fn floor_of(map: &str, value: &str) -> Measured {
    let values = [0.4, 0.25, 0.1].map(|half| format!("\"{half}*({value})\""));
    let mut sets = independent::asking(10, 2, 13, "none");
    sets.push(format!(
        "materials.floor={{ bsdf: {{ map: {map}, value: [{}] }} }}",
        values.join(", ")
    ));
    measure(&independent::scene("floorlight", &sets))
}

#[test]
fn a_wrong_cosine_or_jacobian_would_be_noticed() {
    let exact = floor(0.5);
    for map in [COSINE, UNIFORM] {
        // Right: albedo / pi, in any form.
        assert_eq!(compare(&floor_of(map, "1/pi"), &exact), Ok(()));
        assert_eq!(compare(&floor_of(map, "cos_i/(pi*cos_i)"), &exact), Ok(()));
        // A Jacobian with an error of one part in fifty.
        assert!(compare(&floor_of(map, "1.02/pi"), &exact).is_err());
        // One cosine too many.
        assert!(compare(&floor_of(map, "cos_i/pi"), &exact).is_err());
    }
    // The weight without its cosine is that of f / cos_i.
    assert!(compare(&floor_of(UNIFORM, "1/(pi*cos_i)"), &exact).is_err());
    // A division by the Jacobian, instead of the product, is f / J^2: J is pi / cos_i, or 2 pi.
    assert!(compare(&floor_of(COSINE, "cos_i^2/pi^3"), &exact).is_err());
    assert!(compare(&floor_of(UNIFORM, "1/(4*pi^3)"), &exact).is_err());
}

#[test]
fn a_flipped_picture_or_swapped_channels_would_be_noticed() {
    let side = SIDE as usize;
    let scene = independent::scene("cornell", &independent::asking(10, 3, 10, "none"));
    let reference = independent::reference("cornell", 3);
    let right = measure(&scene);
    assert_eq!(compare(&right, &reference), Ok(()));
    let changed = |pixel: &dyn Fn(usize, usize) -> [f64; 3]| Measured {
        picture: (0..side * side)
            .map(|i| pixel(i % side, i / side))
            .collect(),
        error: right.error,
    };
    let at = |x: usize, y: usize| right.picture[y * side + x];
    let last = side - 1;
    let wrong = [
        ("left for right", changed(&|x, y| at(last - x, y))),
        ("upside down", changed(&|x, y| at(x, last - y))),
        ("rows for columns", changed(&|x, y| at(y, x))),
        ("one column off", changed(&|x, y| at((x + 1).min(last), y))),
        ("one row off", changed(&|x, y| at(x, (y + 1).min(last)))),
        (
            "blue for red",
            changed(&|x, y| {
                let [r, g, b] = at(x, y);
                [b, g, r]
            }),
        ),
        (
            "3 % too bright",
            changed(&|x, y| at(x, y).map(|c| 1.03 * c)),
        ),
    ];
    for (what, picture) in wrong {
        assert!(compare(&picture, &reference).is_err(), "{what} passes");
    }
    // One ray more or less gives another picture.
    assert!(compare(&right, &independent::reference("cornell", 2)).is_err());
    assert!(compare(&right, &independent::reference("cornell", 4)).is_err());
}
