//! Colours at the vertices of meshes against the affine functions that they stand for, in floating point and as
//! circuits.
//!
//! Under a sky of radiance 1 that no other face covers, a flat face shows its own albedo: each path that
//! meets it leaves it towards the sky. The mean of an affine function over a pixel is its value at the centre.

use qrt::prelude::*;
use qrt::scene::front::{Files, parse_with};
use qrt::tracer::{PixelClass, Stage};
use std::fmt::Write as _;

type Rgb = [f64; 3];

/// The corners of a square that covers the view, counterclockwise: x and z.
const CORNERS: [[f64; 2]; 4] = [[-2.0, 2.0], [2.0, 2.0], [2.0, -2.0], [-2.0, -2.0]];
/// Their colours, of which no four lie on one affine function.
const COLOURS: [Rgb; 4] = [
    [1.0, 0.0, 0.25],
    [0.5, 0.75, 0.0],
    [0.0, 1.0, 1.0],
    [0.25, 0.5, 0.125],
];
const ALBEDO: Rgb = [0.75, 0.5, 1.0];

/// Four vertices of a square at `height` with these colours, as an OBJ file of one face.
fn square(height: f64, colours: [Rgb; 4]) -> String {
    let vertex = |([x, z], [r, g, b]): ([f64; 2], Rgb)| format!("v {x} {height} {z} {r} {g} {b}\n");
    let vertices = CORNERS.into_iter().zip(colours).map(vertex);
    vertices.collect::<String>() + "f 1 2 3 4\n"
}

/// A scene of `geometry`, seen from above by parallel rays through the square of edge 2 around the
/// origin, with the meshes `files`.
fn scene(geometry: &str, sampling: &str, files: &[(&str, &str)]) -> ValidScene {
    let text = format!(
        "name: painted
camera: {{ orthographic: {{ eye: [0, 9, 0], target: [0, 0, 0], up: [0, 0, -1], height: 2 }} }}
film: {{ width: 8, height: 8 }}
materials:
  matte: {{ lambertian: {{ albedo: {ALBEDO:?} }} }}
  mirror: {{ mirror: {{ reflectance: {ALBEDO:?} }} }}
  metal: {{ metal: {{ reflectance: {ALBEDO:?} }} }}
  shade: {{ emitter: {{ radiance: 0.125, albedo: {ALBEDO:?} }} }}
  plain: {{ lambertian: {{ albedo: 0.625 }} }}
  tiles: {{ lambertian: {{ albedo: {{ checker: {{ of: [0.875, 0.125], scale: 0.5 }} }} }} }}
  lamp: {{ emitter: {{ radiance: 3 }} }}
geometry:
{geometry}
{sampling}"
    );
    let files: Vec<(&str, &[u8])> = files
        .iter()
        .map(|(n, text)| (*n, text.as_bytes()))
        .collect();
    let parsed = parse_with(&text, "painted.yaml", &[], Files::held(&files));
    parsed.unwrap_or_else(|report| panic!("{report}")).valid
}

/// Two rays a path under a white sky.
const SKY: &str = "sky: { radiance: 1 }
sampling: { path_bits: 4, depths: [{ bits: [1, 1] }, { bits: [2, 2] }], lights: none }";

fn seen(scene: &ValidScene, model: Model) -> Vec<Rgb> {
    let options = RenderOptions {
        model: Some(model),
        estimator: Some(Estimator::Exact),
        quiet: true,
        ..RenderOptions::default()
    };
    render(scene, &options).unwrap().image.pixels
}

/// The models, and the difference that their numbers allow. In floating point a path leaves a face 2^-32 of the
/// way to its centre beside the hit.
const MODELS: [(Model, f64); 3] = [
    (Model::Real, 1e-9),
    (Model::Fixed, 0.01),
    (Model::Gates, 0.01),
];

/// The colour at x and z in the fan of the square: by the areas of the triangles between the point and the edges.
fn colour_at(point: [f64; 2]) -> Rgb {
    let fan = [[0, 1, 2], [0, 2, 3]];
    let area = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let shares = |face: [usize; 3]| {
        let [a, b, c] = face.map(|corner| CORNERS[corner]);
        let whole = area(a, b, c);
        [area(point, b, c), area(a, point, c), area(a, b, point)].map(|part| part / whole)
    };
    let is_within = |face: &[usize; 3]| shares(*face).iter().all(|share| *share >= 0.0);
    let face = fan.into_iter().find(is_within).unwrap();
    let corners = face.map(|corner| COLOURS[corner]);
    std::array::from_fn(|c| (0..3).map(|k| shares(face)[k] * corners[k][c]).sum())
}

/// Checks each pixel of the 8 x 8 that lies in one triangle of the square.
fn agrees(pixels: &[Rgb], expected: impl Fn(Rgb) -> Rgb, allowed: f64, what: &str) {
    for (number, pixel) in pixels.iter().enumerate() {
        let [column, row] = [number % 8, number / 8];
        if column + row == 7 {
            continue;
        }
        let at = [column, row].map(|k| (k as f64 + 0.5) / 4.0 - 1.0);
        let expected = expected(colour_at(at));
        for (found, expected) in pixel.iter().zip(expected) {
            let error = (found - expected).abs();
            assert!(
                error < allowed,
                "{what}, pixel {column}, {row}: {found}, not {expected}"
            );
        }
    }
}

fn times(a: Rgb, b: Rgb) -> Rgb {
    std::array::from_fn(|c| a[c] * b[c])
}

#[test]
fn a_face_shows_its_albedo_times_the_interpolated_colour() {
    let obj = square(0.0, COLOURS);
    for material in ["matte", "mirror", "metal", "shade"] {
        let geometry =
            format!("  - mesh: {{ obj: a.obj, colors: vertices, material: {material} }}");
        let scene = scene(&geometry, SKY, &[("a.obj", &obj)]);
        let radiance = if material == "shade" { 0.125 } else { 0.0 };
        for (model, allowed) in MODELS {
            let pixels = seen(&scene, model);
            let expected = |colour| times(ALBEDO, colour).map(|c| c + radiance);
            agrees(
                &pixels,
                expected,
                allowed,
                &format!("{material}, {model:?}"),
            );
        }
    }
}

/// A transform moves colours with their vertices; a PLY file has the same picture.
#[test]
fn moved_meshes_and_other_files_have_the_same_colours() {
    let obj = square(0.0, COLOURS);
    let mut ply = "ply\nformat ascii 1.0\nelement vertex 4\n".to_owned();
    for name in ["x", "y", "z", "red", "green", "blue"] {
        let _ = writeln!(ply, "property double {name}");
    }
    ply += "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    for ([x, z], [r, g, b]) in CORNERS.into_iter().zip(COLOURS) {
        let _ = writeln!(ply, "{} 0 {} {r} {g} {b}", -x / 4.0, 1.0 - z / 4.0);
    }
    ply += "4 0 1 2 3\n";
    let files = [("a.obj", &*obj), ("a.ply", &*ply)];
    let plain = scene(
        "  - mesh: { obj: a.obj, colors: vertices, material: matte }",
        SKY,
        &files,
    );
    let moved = scene(
        "  - mesh: { ply: a.ply, colors: vertices, material: matte, scale: 4, rotate: [0, 180, 0], \
         translate: [0, 0, 4] }",
        SKY,
        &files,
    );
    let [plain, moved] = [plain, moved].map(|scene| seen(&scene, Model::Real));
    for (a, b) in plain.iter().flatten().zip(moved.iter().flatten()) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
}

/// A coloured floor on the left, and on the right a plain one, a checker and a sphere.
#[test]
fn coloured_faces_stand_beside_others() {
    let geometry =
        "  - mesh: { obj: a.obj, colors: vertices, material: matte, translate: [-2, 0, 0] }
  - quad: { vertices: [[0, 0, 2], [2, 0, 2], [2, 0, 0.5], [0, 0, 0.5]], material: plain }
  - quad: { vertices: [[0, 0, 0.5], [2, 0, 0.5], [2, 0, 0], [0, 0, 0]], material: tiles }
  - quad: { vertices: [[0, 0, 0], [2, 0, 0], [2, 0, -2], [0, 0, -2]], material: matte }
  - sphere: { center: [3, 0, 0], radius: 0.5, material: plain }";
    let scene = scene(geometry, SKY, &[("a.obj", &square(0.0, COLOURS))]);
    for (model, allowed) in MODELS {
        let pixels = seen(&scene, model);
        for row in 0..8 {
            let z = (row as f64 + 0.5) / 4.0 - 1.0;
            for column in 0..8 {
                let x = (column as f64 + 0.5) / 4.0 - 1.0;
                let expected = match (x, z) {
                    // The diagonal of the moved square is z = -x - 2.
                    _ if x < 0.0 => times(ALBEDO, colour_at([x + 2.0, z])),
                    _ if z > 0.5 => [0.625; 3],
                    _ if z > 0.0 && x < 0.5 => [0.875; 3],
                    _ if z > 0.0 => [0.125; 3],
                    _ => ALBEDO,
                };
                for (found, expected) in pixels[8 * row + column].iter().zip(expected) {
                    let error = (found - expected).abs();
                    assert!(
                        error < allowed,
                        "{model:?}, pixel {column}, {row}: {found}, not {expected}"
                    );
                }
            }
        }
    }
}

/// The paths of a lamp's light, and the rays that find it by chance, have one mean.
#[test]
fn light_that_is_sampled_has_the_colours_of_the_point() {
    let picture = |lights: &str, model| {
        let sampling = format!(
            "sampling: {{ path_bits: 16, lights: {lights}, depths: [{{ bits: [8, 8] }}, \
             {{ bits: [8, 8], light: [8, 8] }}] }}"
        );
        let geometry = "  - mesh: { obj: a.obj, colors: vertices, material: matte }
  - quad: { vertices: [[2, 0, -1], [2, 0, 1], [2, 2, 1], [2, 2, -1]], material: lamp }";
        seen(
            &scene(geometry, &sampling, &[("a.obj", &square(0.0, COLOURS))]),
            model,
        )
    };
    let sampled = picture("auto", Model::Real);
    for (lights, model) in [
        ("none", Model::Real),
        ("mis", Model::Real),
        ("auto", Model::Fixed),
    ] {
        let found = picture(lights, model);
        for (a, b) in sampled.iter().flatten().zip(found.iter().flatten()) {
            assert!((a - b).abs() < 0.02, "{lights}, {model:?}: {a} and {b}");
        }
    }
}

/// One colour at all vertices is the same as that albedo, in every bit; white is no colour at all.
#[test]
fn equal_colours_are_an_albedo() {
    let grey = square(0.0, [[0.5; 3]; 4]);
    let white = square(0.0, [[1.0; 3]; 4]);
    let files = [("grey.obj", &*grey), ("white.obj", &*white)];
    let with = |mesh: &str| scene(&format!("  - mesh: {{ {mesh} }}"), SKY, &files);
    let painted = with("obj: grey.obj, colors: vertices, material: mirror");
    let white = with("obj: white.obj, colors: vertices, material: mirror");
    let unpainted = with("obj: white.obj, colors: none, material: mirror");
    assert!(white.coloured_faces().is_empty() && unpainted.coloured_faces().is_empty());
    assert_eq!(painted.coloured_faces().len(), 2);
    for model in [Model::Real, Model::Fixed] {
        assert_eq!(seen(&white, model), seen(&unpainted, model));
        let halves: Vec<Rgb> = seen(&unpainted, model)
            .iter()
            .map(|p| p.map(|c| c / 2.0))
            .collect();
        for (a, b) in seen(&painted, model)
            .iter()
            .flatten()
            .zip(halves.iter().flatten())
        {
            assert!((a - b).abs() < 2e-3, "{a} {b}");
        }
    }
}

/// Colours that are not used change nothing, and say so unless that is written.
#[test]
fn without_the_key_colours_are_named_and_change_nothing() {
    let coloured = square(0.0, COLOURS);
    let plain: String = coloured
        .lines()
        .map(|line| match line.split(' ').collect::<Vec<_>>()[..] {
            ["v", x, y, z, ..] => format!("v {x} {y} {z}\n"),
            _ => format!("{line}\n"),
        })
        .collect();
    let files = [("coloured.obj", &*coloured), ("plain.obj", &*plain)];
    let with = |mesh: &str| {
        scene(
            &format!("  - mesh: {{ {mesh}, material: matte }}"),
            SKY,
            &files,
        )
    };
    let expected = seen(&with("obj: plain.obj"), Model::Real);
    for (mesh, notes) in [
        ("obj: coloured.obj", 1),
        ("obj: coloured.obj, colors: none", 0),
    ] {
        let scene = with(mesh);
        let found = scene
            .warnings()
            .iter()
            .filter(|note| note.code() == "QRT0354");
        assert_eq!(found.count(), notes, "{mesh}");
        assert_eq!(seen(&scene, Model::Real), expected);
    }
}

/// A path's colour is bounded by the brightest vertex, and by faces of the material without colours.
#[test]
fn the_colour_scale_is_that_of_the_brightest_vertex() {
    let dark = square(
        0.0,
        [[0.125, 0.25, 0.5], [0.0; 3], [0.25, 0.0, 0.0], [0.0; 3]],
    );
    let files = [("dark.obj", &*dark)];
    let mesh = "  - mesh: { obj: dark.obj, colors: vertices, material: matte }\n";
    let quad = "  - quad: { vertices: [[0, -1, 0], [2, -1, 0], [2, -1, -2], [0, -1, -2]], material: matte }\n";
    let lit = SKY.replace("sky: { radiance: 1 }", "");
    let bound = |geometry: &str| {
        let lamp = "  - quad: { vertices: [[2, 1, -1], [2, 1, 1], [2, 2, 1], [2, 2, -1]], material: lamp }";
        let scene = scene(&[geometry, lamp].concat(), &lit, &files);
        Stage::<3>::rgb(&scene, PixelClass::MeetsNoLamp).bound()
    };
    let reflected = times(ALBEDO, [0.25, 0.25, 0.5]).map(|tint| 3.0 * tint);
    assert_eq!(bound(mesh), reflected);
    assert_eq!(bound(&[mesh, quad].concat()), ALBEDO.map(|tint| 3.0 * tint));
}

/// A strip of 1e-5 of the scene whose colour changes across it: its circuit would have the wrong colours.
#[test]
fn colours_of_too_thin_faces_are_refused() {
    let strip = "v 0 0 0 1 1 1\nv 1 0 0 1 1 1\nv 0 0 -1e-5 0 0 0\nf 1 2 3\n";
    let with = |colors: &str| {
        let geometry = format!(
            "  - quad: {{ vertices: [[-1, -1, 1], [1, -1, 1], [1, -1, -1], [-1, -1, -1]], material: plain }}\n  \
             - mesh: {{ obj: strip.obj, colors: {colors}, material: matte }}"
        );
        scene(&geometry, SKY, &[("strip.obj", strip)])
    };
    let fixed = RenderOptions {
        model: Some(Model::Fixed),
        estimator: Some(Estimator::Exact),
        quiet: true,
        ..RenderOptions::default()
    };
    let error = render(&with("vertices"), &fixed).err().unwrap().to_string();
    let expected =
        "the colours of this mesh change over widths that have too few of 16 fraction bits";
    assert!(error.contains(expected), "{error}");
    assert!(render(&with("none"), &fixed).is_ok());
    seen(&with("vertices"), Model::Real);
}
