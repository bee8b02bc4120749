//! Warnings of black pictures, of lamps in one place, and of materials that nothing uses.

use crate::front::parse;
use qrt_syntax::Report;

/// Returns the warnings of a scene with these `geometry` entries and `rays`, as codes and lines.
#[track_caller]
fn warned(camera: &str, geometry: &[&str], rays: usize) -> Vec<(&'static str, usize)> {
    let entries: Vec<String> = geometry
        .iter()
        .map(|entry| format!("  - {entry}"))
        .collect();
    let entries = entries.join("\n");
    let rays = vec!["{ bits: [4, 4] }"; rays].join(", ");
    let text = format!(
        "name: notes
camera: {camera}
film: {{ width: 4, height: 4 }}
materials: {{ grey: {{ lambertian: {{ albedo: [0.5, 0.5, 0.5] }} }}, black: {{ emitter: {{ radiance: [0, 0, 0] }} }}, \
         lamp: {{ emitter: {{ radiance: [1, 1, 1] }} }} }}
geometry:
{entries}
sampling: {{ path_bits: 4, depths: [{rays}] }}
"
    );
    let loaded = parse(&text, "notes.yaml", &[], "".as_ref()).unwrap();
    let report = loaded.warnings();
    let problems = report.iter().flat_map(Report::problems);
    let told = problems.map(|told| (told.code, told.place.unwrap().line));
    told.filter(|(code, _)| *code != "QRT0220").collect()
}

/// A camera that looks down at the floor.
const ABOVE: &str = "{ perspective: { eye: [0, 0, 5], target: [0, 0, 0], vfov: 40 } }";
const PARALLEL: &str = "{ orthographic: { eye: [0, 0, 5], target: [0, 0, 0], height: 2 } }";
const FLOOR: &str =
    "quad: { vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], material: grey }";

/// A square of `material` at height `z`, whose front looks up or down.
fn square(z: f64, is_up: bool, material: &str) -> String {
    let [a, b] = if is_up {
        ["[2, -2", "[-2, 2"]
    } else {
        ["[-2, 2", "[2, -2"]
    };
    format!(
        "quad: {{ vertices: [[-2, -2, {z}], {a}, {z}], [2, 2, {z}], {b}, {z}]], material: {material} }}"
    )
}

#[test]
fn a_scene_without_a_lamp_is_told_to_be_black() {
    assert_eq!(warned(ABOVE, &[FLOOR], 3), [("QRT0221", 5)]);
    assert_eq!(
        warned(ABOVE, &[FLOOR, &square(9.0, false, "black")], 3),
        [("QRT0221", 5)]
    );
}

#[test]
fn lamps_that_shine_away_from_all_that_is_seen_are_told_of() {
    for camera in [ABOVE, PARALLEL] {
        let away = square(9.0, true, "lamp");
        assert_eq!(warned(camera, &[FLOOR, &away], 3), [("QRT0221", 7)]);
        assert_eq!(warned(camera, &[FLOOR, &square(9.0, false, "lamp")], 3), []);
        // The camera sees it.
        assert_eq!(warned(camera, &[FLOOR, &square(1.0, true, "lamp")], 1), []);
        // Something that it lights may light the floor.
        let sky = square(20.0, false, "grey");
        assert_eq!(warned(camera, &[FLOOR, &away, &sky], 3), []);
        // Two rays do not go that far, and one ray does not reach the lamp that lights the floor.
        assert_eq!(warned(camera, &[FLOOR, &away, &sky], 2), [("QRT0221", 7)]);
        assert_eq!(
            warned(camera, &[FLOOR, &square(9.0, false, "lamp")], 1),
            [("QRT0221", 7)]
        );
        // A ceiling in the lamp's own plane is not before it.
        let ceiling = square(9.0, true, "grey");
        assert_eq!(
            warned(camera, &[FLOOR, &away, &ceiling], 3),
            [("QRT0221", 7)]
        );
        // One lamp that lights something is enough.
        let other = square(8.0, false, "lamp");
        assert_eq!(warned(camera, &[FLOOR, &away, &other], 3), []);
    }
}

#[test]
fn lamps_in_one_place_that_face_opposite_ways_are_told_of() {
    let (up, down) = (square(3.0, true, "lamp"), square(3.0, false, "lamp"));
    assert_eq!(warned(ABOVE, &[&up, &down, FLOOR], 3), [("QRT0222", 7)]);
    assert_eq!(warned(ABOVE, &[FLOOR, &down, &up], 3), [("QRT0222", 8)]);
    let corner = "triangle: { vertices: [[1, 1, 3], [1, 3, 3], [3, 1, 3]], material: lamp }";
    assert_eq!(warned(ABOVE, &[&up, FLOOR, corner], 3), [("QRT0222", 8)]);
    let beside = "triangle: { vertices: [[2, -2, 3], [2, 2, 3], [4, 0, 3]], material: lamp }";
    let diagonal = "triangle: { vertices: [[3, 1.5, 3], [1.5, 3, 3], [3, 3, 3]], material: lamp }";
    for apart in [
        &square(3.01, false, "lamp"),
        &square(3.0, false, "grey"),
        beside,
        diagonal,
        &up,
    ] {
        assert_eq!(warned(ABOVE, &[&up, apart, FLOOR], 3), [], "{apart}");
    }
}

/// Checks that coordinates have rounding errors in proportion to their size, and no larger.
#[test]
fn far_from_the_origin_nothing_is_told_that_is_not_so() {
    let corner = |far: f64, [x, y]: [f64; 2], z: f64| format!("[{}, {y}, {z}]", far + x);
    let quad = |far: f64, z: f64, is_up: bool, material: &str| {
        let mut corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        if !is_up {
            corners.reverse();
        }
        let corners = corners.map(|at| corner(far, at, z)).join(", ");
        format!("quad: {{ vertices: [{corners}], material: {material} }}")
    };
    for far in [1e6, 1e9] {
        let (eye, target) = (corner(far, [0.0; 2], 5.0), corner(far, [0.0; 2], 0.0));
        let camera = format!("{{ perspective: {{ eye: {eye}, target: {target}, vfov: 40 }} }}");
        let floor = quad(far, 0.0, true, "grey");
        let lamp = quad(far, 0.9, false, "lamp");
        assert_eq!(warned(&camera, &[&floor, &lamp], 2), [], "{far}");
        let back = quad(far, 0.9005, true, "lamp");
        assert_eq!(warned(&camera, &[&floor, &lamp, &back], 2), [], "{far}");
    }
}

#[test]
fn a_material_that_nothing_is_made_of_is_told_of() {
    let text = "name: notes
camera: { perspective: { eye: [0, 0, 5], target: [0, 0, 0], vfov: 40 } }
film: { width: 4, height: 4 }
materials:
  lamp: { emitter: { radiance: [1, 1, 1] } }
  spare: { lambertian: { albedo: [0.5, 0.5, 0.5] } }
geometry:
  - triangle: { vertices: [[1, 1, 3], [3, 1, 3], [1, 3, 3]], material: lamp }
";
    let loaded = parse(text, "notes.yaml", &[], "".as_ref()).unwrap();
    let shown = loaded.warnings().unwrap().render(false);
    let expected = "warning[QRT0220]: nothing is made of the material `spare`\n --> notes.yaml:6:3";
    assert!(shown.starts_with(expected), "{shown}");
    let used = text.replace("material: lamp", "material: spare");
    let loaded = parse(&used, "notes.yaml", &[], "".as_ref()).unwrap();
    let codes = loaded.warnings().unwrap().codes();
    assert_eq!(codes, ["QRT0220", "QRT0221"]);
}

/// Discs are compared by their circles, not by the squares around them.
#[test]
fn lamps_that_are_discs_are_told_of_as_others_are() {
    let disc = |x: f64, normal: f64, material: &str| {
        format!(
            "disc: {{ center: [{x}, {x}, 2], normal: [0, 0, {normal}], radius: 1, material: {material} }}"
        )
    };
    let (away, towards) = (disc(0.0, 1.0, "lamp"), disc(0.0, -1.0, "lamp"));
    assert_eq!(warned(ABOVE, &[FLOOR, &towards], 3), []);
    assert_eq!(warned(ABOVE, &[&away, FLOOR], 1), []);
    let below = "{ perspective: { eye: [0, 0, 1], target: [0, 0, 0], vfov: 40 } }";
    assert_eq!(warned(below, &[FLOOR, &away], 2), [("QRT0221", 7)]);
    // Squares of half side 1 overlap up to 2 units apart along both axes, circles up to 1.42.
    for (x, expected) in [(1.3, &[("QRT0222", 8)][..]), (1.5, &[]), (1.99, &[])] {
        let list = [FLOOR, &away, &disc(x, -1.0, "lamp")];
        assert_eq!(warned(ABOVE, &list, 3), expected, "{x}");
    }
}

#[test]
fn a_disc_that_shines_away_is_to_be_turned_by_its_normal() {
    let text = "name: notes
camera: { perspective: { eye: [0, 0, 1], target: [0, 0, 0], vfov: 40 } }
film: { width: 4, height: 4 }
materials: { grey: { lambertian: { albedo: 0.5 } }, lamp: { emitter: { radiance: 1 } } }
geometry:
  - quad: { vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], material: grey }
  - disc: { center: [0, 0, 2], normal: [0, 0, 1], radius: 1, material: lamp }
sampling: { path_bits: 4, depths: 2 }
";
    let loaded = parse(text, "notes.yaml", &[], "".as_ref()).unwrap();
    let report = loaded.warnings().unwrap().render(false);
    assert!(report.contains("write the opposite `normal`"), "{report}");
}

/// Glass discs on one plane touch if their circles do.
#[test]
fn discs_of_glass_touch_where_their_circles_do() {
    let codes = |x: f64| {
        let text = format!(
            "name: glass
camera: {{ perspective: {{ eye: [0, 0, 5], target: [0, 0, 0], vfov: 40 }} }}
film: {{ width: 4, height: 4 }}
sky: {{ radiance: 1 }}
materials: {{ glass: {{ dielectric: {{ ior: 1.5 }} }} }}
geometry:
  - disc: {{ center: [0, 0, 0], normal: [0, 0, 1], radius: 1, material: glass }}
  - disc: {{ center: [{x}, {x}, 0], normal: [0, 0, 1], radius: 1, material: glass }}
sampling: {{ path_bits: 4, depths: 4 }}
"
        );
        match parse(&text, "glass.yaml", &[], "".as_ref()) {
            Ok(_) => Vec::new(),
            Err(report) => report.codes(),
        }
    };
    assert_eq!(codes(1.3), ["QRT0309"]);
    assert!(codes(1.5).is_empty());
}
