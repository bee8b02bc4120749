//! Checkers against the cells that the hits lie in, in floating point and as circuits.
//!
//! Under a sky of radiance 1 that no other face covers, a convex thing shows its own albedo: each path
//! that meets it leaves it towards the sky.

use crate::common::scene::written;
use qrt::prelude::*;

const FIRST: [f64; 3] = [0.75, 0.5, 0.25];
const SECOND: [f64; 3] = [0.125, 0.25, 0.5];

/// The picture of `geometry`, seen along `forward` by parallel rays through the square of edge 2 around
/// the origin, under a white sky.
fn picture(
    geometry: &str,
    scale: f64,
    (eye, up): ([f64; 3], [f64; 3]),
    size: u32,
    model: Model,
) -> Vec<[f64; 3]> {
    let text = format!(
        "name: checker
camera: {{ orthographic: {{ eye: {eye:?}, target: [0, 0, 0], up: {up:?}, height: 2 }} }}
film: {{ width: {size}, height: {size} }}
sky: {{ radiance: 1 }}
materials:
  matte: {{ lambertian: {{ albedo: {{ checker: {{ of: [{FIRST:?}, {SECOND:?}], scale: {scale} }} }} }} }}
  mirror: {{ mirror: {{ reflectance: {{ checker: {{ of: [{FIRST:?}, {SECOND:?}], scale: {scale} }} }} }} }}
  plain: {{ lambertian: {{ albedo: 1 }} }}
geometry:
{geometry}
sampling: {{ path_bits: 4, depths: [{{ bits: [1, 1] }}, {{ bits: [2, 2] }}], lights: none }}"
    );
    let options = RenderOptions {
        model: Some(model),
        estimator: Some(Estimator::Exact),
        quiet: true,
        ..RenderOptions::default()
    };
    let rendered = render(&written(&text, &[]), &options).unwrap();
    rendered.image.pixels
}

fn colour_of(cell: [i64; 3]) -> [f64; 3] {
    match cell.iter().sum::<i64>().rem_euclid(2) {
        0 => FIRST,
        _ => SECOND,
    }
}

fn agrees(seen: &[f64; 3], expected: [f64; 3], allowed: f64) -> bool {
    seen.iter()
        .zip(expected)
        .all(|(c, e)| (c - e).abs() < allowed)
}

const FROM_ABOVE: ([f64; 3], [f64; 3]) = ([0.0, 9.0, 0.0], [0.0, 0.0, -1.0]);

/// The models, and the difference that their numbers allow.
const MODELS: [(Model, f64); 3] = [
    (Model::Real, 1e-12),
    (Model::Fixed, 0.01),
    (Model::Gates, 0.01),
];

/// Floors at the boundary of two layers, a rounding error below it, and between boundaries, in plain and
/// in turned order of their corners.
#[test]
fn a_floor_shows_the_cells_of_its_layer() {
    for (height, layer) in [
        (0.0, 0),
        (-1e-12, 0),
        (0.5, 1),
        (0.25, 0),
        (-0.25, -1),
        (-0.5, -1),
    ] {
        let geometry = format!(
            "  - quad: {{ vertices: [[-2, {height:?}, 2], [2, {height:?}, 2], [2, {height:?}, -2], \
             [-2, {height:?}, -2]], material: matte }}"
        );
        for (model, allowed) in MODELS {
            // Four pixels of half a unit, each of them in one cell.
            let seen = picture(&geometry, 0.5, FROM_ABOVE, 4, model);
            for (pixel, colour) in seen.iter().enumerate() {
                let (column, row) = ((pixel % 4) as i64, (pixel / 4) as i64);
                let cell = [column - 2, layer, row - 2];
                assert!(
                    agrees(colour, colour_of(cell), allowed),
                    "{model:?}, height {height}, pixel {column}, {row}: {colour:?}"
                );
            }
        }
    }
}

/// A plane that is parallel to no axis has cells along all three.
#[test]
fn a_slanted_face_shows_cells_along_three_axes() {
    // x + y + z = 0, seen from (1, 1, 1).
    let geometry =
        "  - triangle: { vertices: [[6, -3, -3], [-3, 6, -3], [-3, -3, 6]], material: matte }";
    let view = ([3.0, 3.0, 3.0], [0.0, 1.0, 0.0]);
    let third = 1.0 / 3.0_f64.sqrt();
    let (right, up) = ([0.5_f64.sqrt(), 0.0, -(0.5_f64.sqrt())], {
        let down = third * third;
        let length = (1.0 - down).sqrt();
        [
            -third * third / length,
            (1.0 - down) / length,
            -third * third / length,
        ]
    });
    for (model, allowed) in MODELS {
        let size = 8;
        let seen = picture(geometry, 1.25, view, size, model);
        let mut inside = 0;
        for (pixel, colour) in seen.iter().enumerate() {
            let at = |column: f64, row: f64| {
                let (x, y) = (
                    2.0 * column / f64::from(size) - 1.0,
                    1.0 - 2.0 * row / f64::from(size),
                );
                [0, 1, 2].map(|axis| ((right[axis] * x + up[axis] * y) / 1.25).floor() as i64)
            };
            let (column, row) = (
                f64::from(pixel as u32 % size),
                f64::from(pixel as u32 / size),
            );
            let corners = [(0.02, 0.02), (0.98, 0.02), (0.02, 0.98), (0.98, 0.98)];
            let cells = corners.map(|(x, y)| at(column + x, row + y));
            if cells.iter().all(|cell| *cell == cells[0]) {
                inside += 1;
                assert!(
                    agrees(colour, colour_of(cells[0]), allowed),
                    "{model:?}, pixel {pixel}: {colour:?}"
                );
            }
        }
        assert!(inside > 10, "{inside} pixels are in one cell");
    }
}

/// A sphere, matte and as a mirror, beside a plain floor and a cell of another size.
#[test]
fn a_sphere_shows_the_cells_that_it_passes_through() {
    for material in ["matte", "mirror"] {
        let geometry =
            format!("  - sphere: {{ center: [0, 0, 0], radius: 1, material: {material} }}");
        for (model, allowed) in MODELS {
            let size = 16;
            let seen = picture(&geometry, 0.4, FROM_ABOVE, size, model);
            let mut inside = 0;
            for (pixel, colour) in seen.iter().enumerate() {
                let at = |column: f64, row: f64| {
                    let (x, z) = (
                        2.0 * column / f64::from(size) - 1.0,
                        2.0 * row / f64::from(size) - 1.0,
                    );
                    let y = (1.0 - x * x - z * z).sqrt();
                    [x, y, z].map(|along| {
                        if y > 0.1 {
                            (along / 0.4).floor() as i64
                        } else {
                            i64::MIN
                        }
                    })
                };
                let (column, row) = (
                    f64::from(pixel as u32 % size),
                    f64::from(pixel as u32 / size),
                );
                let corners = [
                    (0.01, 0.01),
                    (0.99, 0.01),
                    (0.01, 0.99),
                    (0.99, 0.99),
                    (0.5, 0.5),
                ];
                let cells = corners.map(|(x, y)| at(column + x, row + y));
                if cells[0][0] > i64::MIN && cells.iter().all(|cell| *cell == cells[0]) {
                    inside += 1;
                    assert!(
                        agrees(colour, colour_of(cells[0]), allowed),
                        "{material}, {model:?}, pixel {pixel}: {colour:?}, not {:?}",
                        cells[0]
                    );
                }
            }
            assert!(inside > 30, "{inside} pixels are in one cell");
        }
    }
}

/// Two checkers of two scales and a plain face in one picture.
#[test]
fn checkers_of_several_scales_stand_beside_each_other() {
    let text = |scale: f64| {
        format!(
            "{{ lambertian: {{ albedo: {{ checker: {{ of: [0.5, 0.25], scale: {scale} }} }} }} }}"
        )
    };
    let scene = format!(
        "name: checkers
camera: {{ orthographic: {{ eye: [0, 9, 0], target: [0, 0, 0], up: [0, 0, -1], height: 2 }} }}
film: {{ width: 6, height: 2 }}
sky: {{ radiance: 1 }}
materials:
  fine: {}
  wide: {}
  plain: {{ lambertian: {{ albedo: 0.75 }} }}
geometry:
  - quad: {{ vertices: [[-3, 0, 1], [-1, 0, 1], [-1, 0, -1], [-3, 0, -1]], material: fine }}
  - quad: {{ vertices: [[-1, 0.1, 1], [1, 0.1, 1], [1, 0.1, -1], [-1, 0.1, -1]], material: plain }}
  - quad: {{ vertices: [[1, 0, 1], [3, 0, 1], [3, 0, -1], [1, 0, -1]], material: wide }}
sampling: {{ path_bits: 4, depths: [{{ bits: [1, 1] }}, {{ bits: [2, 2] }}], lights: none }}",
        text(1.0),
        text(3.0)
    );
    let scene = written(&scene, &[]);
    for model in [Model::Real, Model::Fixed, Model::Gates] {
        let options = RenderOptions {
            model: Some(model),
            estimator: Some(Estimator::Exact),
            quiet: true,
            ..RenderOptions::default()
        };
        let seen = render(&scene, &options).unwrap().image.pixels;
        let expected = [
            // Cells of one unit: the column of x = -3 is odd, as is the row of z = -1.
            [0.5, 0.25, 0.75, 0.75, 0.25, 0.25],
            [0.25, 0.5, 0.75, 0.75, 0.5, 0.5],
        ];
        for (pixel, colour) in seen.iter().enumerate() {
            let expected = expected[pixel / 6][pixel % 6];
            assert!(
                agrees(colour, [expected; 3], 0.01),
                "{model:?}, pixel {pixel}: {colour:?}, not {expected}"
            );
        }
    }
}

/// Sampled lamps and rays that find them by chance agree, and so do a checker of equal colours and one
/// colour.
#[test]
fn light_that_is_sampled_has_the_colours_of_cells() {
    let text = |albedo: &str, lights: &str| {
        format!(
            "name: lit
camera: {{ perspective: {{ eye: [0, 1.5, 3], target: [0, 0, 0], vfov: 40 }} }}
film: {{ width: 8, height: 6 }}
materials:
  floor: {{ lambertian: {{ albedo: {albedo} }} }}
  lamp: {{ emitter: {{ radiance: 3 }} }}
geometry:
  - quad: {{ vertices: [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]], material: floor }}
  - quad: {{ vertices: [[-1, 2, -1], [1, 2, -1], [1, 2, 1], [-1, 2, 1]], material: lamp }}
sampling: {{ path_bits: 16, lights: {lights}, depths: [{{ bits: [8, 8] }}, {{ bits: [8, 8], light: [8, 8] }}] }}"
        )
    };
    let seen = |albedo: &str, lights: &str, model| {
        let options = RenderOptions {
            model: Some(model),
            estimator: Some(Estimator::Exact),
            quiet: true,
            ..RenderOptions::default()
        };
        let scene = written(&text(albedo, lights), &[]);
        render(&scene, &options).unwrap().image.pixels
    };
    let checker = "{ checker: { of: [0.75, 0.25], scale: 0.5 } }";
    let sampled = seen(checker, "auto", Model::Real);
    for (lights, model) in [
        ("none", Model::Real),
        ("mis", Model::Real),
        ("auto", Model::Fixed),
    ] {
        for (a, b) in sampled.iter().zip(seen(checker, lights, model)) {
            assert!(agrees(a, b, 0.02), "{lights}, {model:?}: {a:?} and {b:?}");
        }
    }
    let same = "{ checker: { of: [0.5, 0.5], scale: 0.5 } }";
    assert_eq!(
        seen(same, "auto", Model::Real),
        seen("0.5", "auto", Model::Real)
    );
}

/// Cells too small for the circuit's numbers are refused at their place, with the bits that they need.
#[test]
fn cells_too_small_for_numbers_are_refused_at_their_place() {
    let scene = |scale: f64| {
        let text = format!(
            "name: fine
camera: {{ orthographic: {{ eye: [0, 9, 0], target: [0, 0, 0], up: [0, 0, -1], height: 2 }} }}
film: {{ width: 1, height: 1 }}
sky: {{ radiance: 1 }}
materials:
  fine: {{ mirror: {{ reflectance: {{ checker: {{ of: [0.5, 0.25], scale: {scale:?} }} }} }} }}
geometry:
  - quad: {{ vertices: [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], material: fine }}
precision: {{ fraction: 12 }}
sampling: {{ path_bits: 4, depths: [{{ bits: [1, 1] }}, {{ bits: [2, 2] }}], lights: none }}"
        );
        written(&text, &[])
    };
    let fixed = |scale| {
        let options = RenderOptions {
            model: Some(Model::Fixed),
            quiet: true,
            ..RenderOptions::default()
        };
        render(&scene(scale), &options)
    };
    fixed(1.0 / 128.0).unwrap();
    let error = fixed(1.0 / 129.0).unwrap_err().to_string();
    assert!(
        error.contains("these cells have too few of 12 fraction bits"),
        "{error}"
    );
    // In floating point every size has a picture.
    for scale in [1e-30, 1e-9, 1e9, 1e30] {
        let options = RenderOptions {
            model: Some(Model::Real),
            estimator: Some(Estimator::Exact),
            quiet: true,
            ..RenderOptions::default()
        };
        let seen = render(&scene(scale), &options).unwrap().image.pixels[0];
        assert!(
            seen.iter().all(|c| (0.25..=0.5).contains(c)),
            "{scale}: {seen:?}"
        );
    }
}
