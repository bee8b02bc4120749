//! Tests of files for other renderers and viewers: `qrt export --format mitsuba`, layers of an .exr,
//! `qrt diff`.

use crate::common::command::Folder;
use exr::prelude as openexr;
use glam::DVec3;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

const BOX: &str = include_str!("../scenes/box.yaml");

/// Walls across the lower half of the view: on the left a matte one at distance 3, on the right a tilted
/// mirror. The upper half is empty.
const WALLS: &str = "
name: walls & <more>
camera: { orthographic: { eye: [0, 0, 4], target: [0, 0, 0], height: 2 } }
film: { width: 4, height: 2 }
materials:
  unused: { lambertian: { albedo: [0.1, 0.1, 0.1] } }
  \"a/b\": { emitter: { radiance: [1, 0.5, 0.25], albedo: [0.5, 0.5, 0.5] } }
  glass: { dielectric: { ior: 1.5 } }
geometry:
  - quad: { vertices: [[-2, -1, 1], [0, -1, 1], [0, 0, 1], [-2, 0, 1]], material: a/b }
  - quad: { vertices: [[0, -1, 0], [0, 0, 0], [2, 0, 2], [2, -1, 2]], material: glass }
sampling: { path_bits: 4, depths: [{ bits: [4, 4] }, { bits: [4, 4] }], lights: none }
";

type Channels = BTreeMap<String, Vec<f32>>;

fn channels(path: &Path) -> Channels {
    let read = openexr::read_all_flat_layers_from_file(path).unwrap();
    let list = read.layer_data[0].channel_data.list.iter();
    list.map(|channel| {
        let values = channel.sample_data.values_as_f32().collect();
        (channel.name.to_string(), values)
    })
    .collect()
}

#[test]
fn layers_tell_of_first_hits_where_they_are() {
    let folder = Folder::with("walls.yaml", WALLS);
    folder.works(&[
        "render",
        "walls.yaml",
        "--layers",
        "-o",
        "w.exr",
        "--estimator",
        "exact",
    ]);
    let found = channels(&folder.path("w.exr"));
    let names: Vec<&str> = found.keys().map(String::as_str).collect();
    let asked = [
        "B",
        "G",
        "R",
        "depth.Z",
        "interval.B",
        "interval.G",
        "interval.R",
        "material.ID",
        "normal.X",
        "normal.Y",
        "normal.Z",
        "queries.Y",
    ];
    assert_eq!(names, asked);
    // The upper half meets no wall. Pixels' middles are at x = -1.5, -0.5, 0.5, 1.5.
    let half = 0.5f32.sqrt();
    for (name, lower) in [
        ("depth.Z", [3.0, 3.0, 3.5, 2.5]),
        ("normal.X", [0.0, 0.0, -half, -half]),
        ("normal.Y", [0.0; 4]),
        ("normal.Z", [1.0, 1.0, half, half]),
        ("material.ID", [2.0, 2.0, 3.0, 3.0]),
        ("queries.Y", [0.0; 4]),
        ("interval.R", [0.0; 4]),
    ] {
        let (upper, found) = found[name].split_at(4);
        assert_eq!(upper, [0.0; 4], "{name}");
        for (found, asked) in found.iter().zip(lower) {
            assert!((found - asked).abs() < 1e-6, "{name}: {found} {asked}");
        }
    }
    // A crop has the same values, and a file without layers has the same colours.
    folder.works(&[
        "render",
        "walls.yaml",
        "--layers",
        "-o",
        "c.exr",
        "--crop",
        "1,1,2,1",
    ]);
    assert_eq!(
        channels(&folder.path("c.exr"))["depth.Z"],
        found["depth.Z"][5..7]
    );
    folder.works(&[
        "render",
        "walls.yaml",
        "-o",
        "plain.exr",
        "--estimator",
        "exact",
    ]);
    let plain = channels(&folder.path("plain.exr"));
    assert_eq!(plain.len(), 3);
    assert!(plain.iter().all(|(name, values)| found[name] == *values));
}

#[test]
fn layers_tell_of_counting_what_stats_and_intervals_do() {
    let folder = Folder::with("box.yaml", BOX);
    let counted = [
        "render",
        "box.yaml",
        "--set",
        "counting.estimator=adaptive-bayes",
        "--layers",
    ];
    folder.works(&[&counted[..], &["-o", "b.exr", "--stats", "b.json"]].concat());
    folder.works(&[
        "render",
        "box.yaml",
        "--estimator",
        "exact",
        "-o",
        "exact.exr",
    ]);
    let (found, exact) = (
        channels(&folder.path("b.exr")),
        channels(&folder.path("exact.exr")),
    );
    let queries: f64 = found["queries.Y"].iter().map(|&n| f64::from(n)).sum();
    let stats: Value = serde_json::from_slice(&folder.read("b.json")).unwrap();
    assert_eq!(queries, stats["oracle_queries"].as_f64().unwrap());
    // An interval that contains the estimate contains the exact value within its width with its confidence,
    // 95 %, and the comparators of the 143 pixels add little to that.
    for [value, width] in [
        ["R", "interval.R"],
        ["G", "interval.G"],
        ["B", "interval.B"],
    ] {
        let all = found[value].iter().zip(&exact[value]).zip(&found[width]);
        let inside =
            all.filter(|((value, exact), width)| (*value - *exact).abs() <= **width + 1e-3);
        let inside = inside.count();
        assert!(inside >= 130, "{value}: {inside} of 143");
        assert!(found[width].iter().any(|&width| width > 0.0), "{width}");
    }
    // One run has the luminance's interval alone.
    folder.works(&[&counted[..], &["-o", "one.exr", "--colour", "one-run"]].concat());
    let one = channels(&folder.path("one.exr"));
    assert!(one.contains_key("interval.Y") && !one.contains_key("interval.R"));
    let errors = folder.fails(2, &["render", "box.yaml", "--layers"]);
    assert!(
        errors.contains("`box.png` cannot keep layers: name an .exr"),
        "{errors}"
    );
}

/// Returns the vertices and triangles of a binary PLY file.
fn ply(bytes: &[u8]) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let end = b"end_header\n";
    let at = bytes
        .windows(end.len())
        .position(|window| window == end)
        .unwrap()
        + end.len();
    let header = std::str::from_utf8(&bytes[..at]).unwrap();
    let count = |of: &str| -> usize {
        let line = header.lines().find_map(|line| line.strip_prefix(of));
        line.unwrap().trim().parse().unwrap()
    };
    let (vertices, faces) = (count("element vertex"), count("element face"));
    let (points, corners) = bytes[at..].split_at(24 * vertices);
    assert_eq!(corners.len(), 13 * faces);
    let number = |bytes: &[u8]| f64::from_le_bytes(bytes.try_into().unwrap());
    let points = points.chunks_exact(24);
    let points = points.map(|p| [number(&p[..8]), number(&p[8..16]), number(&p[16..])]);
    let corners = corners.chunks_exact(13).map(|face| {
        assert_eq!(face[0], 3);
        let corner = |k: usize| u32::from_le_bytes(face[1 + 4 * k..5 + 4 * k].try_into().unwrap());
        [corner(0), corner(1), corner(2)]
    });
    (points.collect(), corners.collect())
}

#[test]
fn a_scene_for_mitsuba_is_xml_that_names_files_which_hold_its_faces() {
    let folder = Folder::with("walls.yaml", WALLS);
    let said = folder.works(&["export", "walls.yaml", "--format", "mitsuba"]);
    assert!(
        said.starts_with(
            "walls.xml: for Mitsuba 3, with 2 faces, those of 1 material in .ply files beside it"
        ),
        "{said}"
    );
    let file = "walls.3.glass.ply";
    assert_eq!(folder.names(), [file, "walls.xml", "walls.yaml"]);
    let text = String::from_utf8(folder.read("walls.xml")).unwrap();
    let xml = roxmltree::Document::parse(&text).unwrap();
    let named = |name: &str| -> Vec<&str> {
        let nodes = xml
            .descendants()
            .filter(|node| node.attribute("name") == Some(name));
        nodes.map(|node| node.attribute("value").unwrap()).collect()
    };
    assert_eq!(named("max_depth"), ["2", "$max_depth"]);
    assert_eq!(named("filename"), [file]);
    assert_eq!(named("face_normals"), ["true"]);
    assert_eq!(named("radiance"), ["1, 0.5, 0.25"]);
    assert_eq!(named("reflectance"), ["0.5, 0.5, 0.5"]);
    assert_eq!([named("int_ior"), named("ext_ior")], [["1.5"], ["1"]]);
    assert_eq!([named("width"), named("height")], [["4"], ["2"]]);
    // The lamp is a parallelogram: from the square of -1 to 1, whose normal is z.
    let matrix = xml.descendants().find(|node| node.has_tag_name("matrix"));
    let matrix = matrix.and_then(|node| node.attribute("value")).unwrap();
    assert_eq!(matrix, "1 0 0 -1 0 0.5 0 -0.5 0 0 1 1 0 0 0 1");
    let scale = xml
        .descendants()
        .find(|node| node.has_tag_name("scale"))
        .unwrap();
    assert_eq!(scale.attribute("x"), Some("2"));
    let (points, triangles) = ply(&folder.read(file));
    assert_eq!(
        points,
        [[0., -1., 0.], [0., 0., 0.], [2., 0., 2.], [2., -1., 2.]]
    );
    assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);

    let told = folder.works(&["export", "walls.yaml", "--format", "mitsuba", "--json"]);
    let told: Value = serde_json::from_str(&told).unwrap();
    assert_eq!(told["meshes"], json!([file]));
    assert_eq!(
        (&told["format"], &told["faces"]),
        (&json!("mitsuba"), &json!(2))
    );
}

/// A disc above a floor that looks down, and one of glass that is moved.
const DISCS: &str = "
name: discs
camera: { orthographic: { eye: [0, 0, 4], target: [0, 0, 0], height: 2 } }
film: { width: 4, height: 2 }
materials:
  lamp: { emitter: { radiance: 3 } }
  glass: { dielectric: { ior: 1.5 } }
geometry:
  - disc: { center: [1, 2, 3], normal: [0, -1, 0], radius: 0.5, material: lamp }
  - disc: { center: [0, 0, 1], normal: [0, 0, 2], radius: 1, scale: 0.25, rotate: [0, 90, 0], material: glass }
sampling: { path_bits: 4, depths: [{ bits: [4, 4] }, { bits: [4, 4] }], lights: none }
";

/// A floor in the sun, seen from the side.
const SUNNY: &str = "
name: sunny
camera: { perspective: { eye: [0, 1, 3], target: [0, 0, 0], vfov: 60 } }
film: { width: 4, height: 2 }
sky: { horizon: [1, 2, 3], zenith: [2, 2, 2] }
sun: { direction: [3, 4, 0], angle: 10, radiance: [50, 40, 30] }
materials: { grey: { lambertian: { albedo: 0.5 } } }
geometry:
  - disc: { center: [0, 0, 0], normal: [0, 1, 0], radius: 2, material: grey }
sampling: { path_bits: 4, depths: [{ bits: [4, 4] }, { bits: [4, 4] }] }
";

/// A ball over tiles under an even sky, through a lens.
const BALL: &str = "
name: ball
camera: { perspective: { eye: [0, 1, 4], target: [0, 0.5, 0], vfov: 40, lens: { aperture: 0.2, focus: 3.5 } } }
film: { width: 4, height: 2 }
sky: { radiance: [1, 2, 3] }
materials:
  red: { lambertian: { albedo: [0.5, 0.25, 0.125] } }
  tiles: { lambertian: { albedo: { checker: { of: [0.75, 0.25], scale: 0.5 } } } }
geometry:
  - sphere: { center: [0, 0.5, -1], radius: 0.5, material: red }
  - quad: { vertices: [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]], material: tiles }
sampling: { path_bits: 4, depths: [{ bits: [4, 4] }, { bits: [4, 4] }] }
";

#[test]
fn spheres_lenses_skies_and_tiles_are_mitsubas_own() {
    let folder = Folder::with("ball.yaml", BALL);
    folder.works(&["export", "ball.yaml", "--format", "mitsuba"]);
    let text = String::from_utf8(folder.read("ball.xml")).unwrap();
    let xml = roxmltree::Document::parse(&text).unwrap();
    let typed = |tag: &str, kind: &str| {
        let mut nodes = xml.descendants();
        nodes
            .find(|node| node.has_tag_name(tag) && node.attribute("type") == Some(kind))
            .unwrap()
    };
    let value = |node: roxmltree::Node<'_, '_>, name: &str| {
        let mut parts = node.descendants();
        let part = parts.find(|part| part.attribute("name") == Some(name));
        part.and_then(|part| part.attribute("value").map(str::to_owned))
    };
    let read = |tag, kind, name| value(typed(tag, kind), name).unwrap();
    // qrt names the diameter of a lens, Mitsuba its radius.
    assert_eq!(read("sensor", "thinlens", "aperture_radius"), "0.1");
    assert_eq!(read("sensor", "thinlens", "focus_distance"), "3.5");
    assert_eq!(read("shape", "sphere", "center"), "0, 0.5, -1");
    assert_eq!(read("shape", "sphere", "radius"), "0.5");
    assert_eq!(read("shape", "sphere", "reflectance"), "0.5, 0.25, 0.125");
    assert_eq!(read("emitter", "constant", "radiance"), "1, 2, 3");
    let mut colours = ["color0", "color1"].map(|name| read("texture", "checkerboard", name));
    colours.sort();
    assert_eq!(colours, ["0.25, 0.25, 0.25", "0.75, 0.75, 0.75"]);
}

/// The first and the last row of Mitsuba's picture of a sky are the poles.
#[test]
fn a_gradient_reaches_its_zenith_in_mitsubas_sky() {
    let sky = "sky: { horizon: [1, 2, 3], zenith: [4, 5, 6] }";
    let scene = BALL.replace("sky: { radiance: [1, 2, 3] }", sky);
    assert!(scene.contains(sky));
    let folder = Folder::with("ball.yaml", &scene);
    folder.works(&["export", "ball.yaml", "--format", "mitsuba"]);
    let bytes = folder.read("ball.sky.pfm");
    let (_, last) = bytes.split_at(bytes.len() - 12);
    let part = |k: usize| f32::from_le_bytes(last[k..k + 4].try_into().unwrap());
    assert_eq!([part(0), part(4), part(8)], [4.0, 5.0, 6.0]);
}

/// A sun is a far disc that faces the scene. It has the sun's angle, the radiance of the sun and of the sky behind it,
/// and is within the far end of the camera's view.
#[test]
fn a_sun_is_a_far_disc_for_mitsuba() {
    let folder = Folder::with("sunny.yaml", SUNNY);
    folder.works(&["export", "sunny.yaml", "--format", "mitsuba"]);
    let text = String::from_utf8(folder.read("sunny.xml")).unwrap();
    let xml = roxmltree::Document::parse(&text).unwrap();
    let value = |name: &str| {
        let mut nodes = xml.descendants();
        let node = nodes.find(|node| node.attribute("name") == Some(name));
        node.and_then(|node| node.attribute("value")).unwrap()
    };
    assert_eq!(value("radiance"), "51.8, 42, 32.2");
    let shape = xml.descendants().find(|node| {
        let mut parts = node.descendants();
        node.has_tag_name("shape") && parts.any(|part| part.has_tag_name("emitter"))
    });
    let shape = shape.unwrap();
    assert_eq!(shape.attribute("type"), Some("disk"));
    let mut parts = shape.descendants();
    let matrix = parts.find(|node| node.has_tag_name("matrix")).unwrap();
    let matrix = matrix.attribute("value").unwrap().split(' ');
    let matrix: Vec<f64> = matrix.map(|number| number.parse().unwrap()).collect();
    let [x, y, normal, centre] =
        [0, 1, 2, 3].map(|k| DVec3::from_array([0, 1, 2].map(|row| matrix[4 * row + k])));
    let axis = DVec3::new(0.6, 0.8, 0.0);
    assert!((normal + axis).length() < 1e-12, "{normal}");
    let distance = (centre - DVec3::new(0.0, 1.0, 3.0)).dot(axis);
    assert!(distance > 1e5 && (centre / distance - axis).length() < 2e-5);
    let radius = distance * 5.0_f64.to_radians().tan();
    for edge in [x, y] {
        assert!((edge.length() / radius - 1.0).abs() < 1e-9 && edge.dot(axis).abs() < 1e-6);
    }
    assert!((x.cross(y).normalize() - normal).length() < 1e-9);
    let far: f64 = value("far_clip").parse().unwrap();
    assert!(far > distance.hypot(radius), "{far}, {distance}");
}

/// Mitsuba's disc is the unit disc of z = 0 with the normal z: a lamp's and any other's matrix takes it to
/// the disc.
#[test]
fn discs_are_discs_for_mitsuba() {
    let folder = Folder::with("discs.yaml", DISCS);
    folder.works(&["export", "discs.yaml", "--format", "mitsuba"]);
    assert_eq!(folder.names(), ["discs.xml", "discs.yaml"]);
    let text = String::from_utf8(folder.read("discs.xml")).unwrap();
    let xml = roxmltree::Document::parse(&text).unwrap();
    let shapes = xml.descendants().filter(|node| node.has_tag_name("shape"));
    let kinds: Vec<_> = shapes.map(|node| node.attribute("type")).collect();
    assert_eq!(kinds, [Some("disk"); 2]);
    let matrices = xml.descendants().filter(|node| node.has_tag_name("matrix"));
    let matrices = matrices.map(|node| node.attribute("value").unwrap());
    let numbers = matrices.map(|text| text.split(' ').map(|n| n.parse().unwrap()).collect());
    let numbers: Vec<Vec<f64>> = numbers.collect();
    for (matrix, centre, normal, radius) in [
        (&numbers[0], [1.0, 2.0, 3.0], [0.0, -1.0, 0.0], 0.5),
        (&numbers[1], [0.25, 0.0, 0.0], [1.0, 0.0, 0.0], 0.25),
    ] {
        let column = |k: usize| [0, 1, 2].map(|row| matrix[4 * row + k]);
        assert_eq!([column(2), column(3)], [normal, centre]);
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let [x, y] = [column(0), column(1)];
        let square = radius * radius;
        for (product, expected) in [
            (dot(x, x), square),
            (dot(y, y), square),
            (dot(x, y), 0.0),
            (dot(x, normal), 0.0),
            (dot(y, normal), 0.0),
        ] {
            assert!((product - expected).abs() < 1e-12, "{matrix:?}");
        }
    }
    let checker = "lambertian: { albedo: { checker: { of: [0.9, 0.1], scale: 1 } } }";
    let text = DISCS.replace("dielectric: { ior: 1.5 }", checker);
    fs::write(folder.path("discs.yaml"), text).unwrap();
    let errors = folder.fails(2, &["export", "discs.yaml", "--format", "mitsuba"]);
    let refusal = "no counterpart of the `checker` of `glass`";
    assert!(errors.contains(refusal), "{errors}");
}

/// The vertices of a coloured mesh have the albedo times their colours. Other faces of the material have its albedo,
/// in the same file, and other materials have no colours.
#[test]
fn colours_of_vertices_are_an_attribute_for_mitsuba() {
    let text = "
name: painted
camera: { orthographic: { eye: [0, 0, 4], target: [0, 0, 0], height: 2 } }
film: { width: 4, height: 2 }
materials:
  wall: { lambertian: { albedo: [0.5, 1, 0.25] } }
  lamp: { emitter: { radiance: 1 } }
geometry:
  - mesh: { obj: painted.obj, colors: vertices, material: wall }
  - triangle: { vertices: [[0, 0, 1], [1, 0, 1], [0, 1, 1]], material: wall }
  - triangle: { vertices: [[0, 0, 3], [0, 1, 3], [1, 0, 3]], material: lamp }
";
    let folder = Folder::with("painted.yaml", text);
    let obj = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0.5\nv 0 1 0 0.25 0.75 1\nf 1 2 3\n";
    fs::write(folder.path("painted.obj"), obj).unwrap();
    folder.works(&["export", "painted.yaml", "--format", "mitsuba"]);
    let text = String::from_utf8(folder.read("painted.xml")).unwrap();
    let xml = roxmltree::Document::parse(&text).unwrap();
    let textures = xml
        .descendants()
        .filter(|node| node.has_tag_name("texture"));
    let textures: Vec<_> = textures.collect();
    let [texture] = &textures[..] else {
        panic!("{text}");
    };
    assert_eq!(texture.attribute("type"), Some("mesh_attribute"));
    assert_eq!(texture.attribute("name"), Some("reflectance"));
    let name = texture
        .descendants()
        .find(|node| node.has_tag_name("string"));
    assert_eq!(name.unwrap().attribute("value"), Some("vertex_color"));
    let bytes = folder.read("painted.1.wall.ply");
    let head = b"property double z\nproperty double r\nproperty double g\nproperty double b\n";
    assert!(bytes.windows(head.len()).any(|part| part == head));
    let end = b"end_header\n";
    let start = bytes
        .windows(end.len())
        .position(|part| part == end)
        .unwrap()
        + end.len();
    let numbers = bytes[start..]
        .chunks_exact(8)
        .map(|b| f64::from_le_bytes(b.try_into().unwrap()));
    let numbers: Vec<f64> = numbers.take(6 * 6).collect();
    let colours: Vec<&[f64]> = numbers.chunks(6).map(|vertex| &vertex[3..]).collect();
    let expected = [
        [0.5, 0.0, 0.0],
        [0.0, 1.0, 0.125],
        [0.125, 0.75, 0.25],
        [0.5, 1.0, 0.25],
        [0.5, 1.0, 0.25],
        [0.5, 1.0, 0.25],
    ];
    assert_eq!(colours, expected);
    let lamp = folder.read("painted.2.lamp.ply");
    assert!(!lamp.windows(9).any(|part| part == b"double r\n"));
}

/// The alpha of Mitsuba's metal is the square of its roughness.
#[test]
fn metal_is_mitsubas_principled_metal() {
    let metal = "glass: { metal: { reflectance: [0.9, 0.7, 0.2], alpha: 0.25 } }";
    let scene = WALLS.replace("glass: { dielectric: { ior: 1.5 } }", metal);
    let folder = Folder::with("s.yaml", &scene);
    folder.works(&["export", "s.yaml", "--format", "mitsuba"]);
    let text = fs::read_to_string(folder.path("s.xml")).unwrap();
    let expected = r#"<bsdf type="principled"><rgb name="base_color" value="0.9, 0.7, 0.2"/><float name="metallic" value="1"/><float name="roughness" value="0.5"/></bsdf>"#;
    assert!(text.contains(expected), "{text}");
}

#[test]
fn what_mitsuba_cannot_show_is_refused_where_it_is_written() {
    let scene = |material: &str| {
        WALLS.replace(
            "glass: { dielectric: { ior: 1.5 } }",
            &format!("glass: {material}"),
        )
    };
    let shiny = "{ phong: { diffuse: [0.1, 0.1, 0.1], specular: [0.5, 0.5, 0.5], exponent: 9 } }";
    let folder = Folder::with("s.yaml", &scene(shiny));
    let errors = folder.fails(2, &["export", "s.yaml", "--format", "mitsuba"]);
    for part in [
        "error[QRT0903]",
        "s.yaml:8:19",
        "no counterpart of the `phong` of `glass`",
    ] {
        assert!(errors.contains(part), "{errors}");
    }
    assert_eq!(folder.names(), ["s.yaml"]);
    let matte = shiny.replace("[0.5, 0.5, 0.5]", "[0, 0, 0]");
    fs::write(folder.path("s.yaml"), scene(&matte)).unwrap();
    folder.works(&["export", "s.yaml", "--format", "mitsuba"]);
    let own = r#"{ bsdf: { map: ["sqrt(u)*cos(2*pi*v)", "sqrt(u)*sin(2*pi*v)", "sqrt(1-u)"], value: ["0.3"] } }"#;
    fs::write(folder.path("s.yaml"), scene(own)).unwrap();
    let errors = folder.fails(2, &["export", "s.yaml", "--format", "mitsuba"]);
    assert!(
        errors.contains("no counterpart of the `bsdf` of `glass`"),
        "{errors}"
    );
    // This face is parallel to one axis alone.
    let checker = "{ lambertian: { albedo: { checker: { of: [0.9, 0.1], scale: 1 } } } }";
    fs::write(folder.path("s.yaml"), scene(checker)).unwrap();
    let errors = folder.fails(2, &["export", "s.yaml", "--format", "mitsuba"]);
    for part in ["s.yaml:8:", "no counterpart of the `checker` of `glass`"] {
        assert!(errors.contains(part), "{errors}");
    }

    for (more, says) in [
        (&["--pixel", "1,1"][..], "--pixel is of a pixel's circuit"),
        (&["--seed", "1"], "--seed is of a pixel's circuit"),
        (&["-o", "-"], "several files: name the first"),
        (&["-o", "s.yaml"], "used for two different things"),
    ] {
        let command = [&["export", "s.yaml", "--format", "mitsuba"], more].concat();
        let errors = folder.fails(2, &command);
        assert!(errors.contains(says), "{errors}");
    }
}

#[test]
fn pictures_are_compared_and_their_errors_shown() {
    let folder = Folder::with("box.yaml", BOX);
    let render = |name: &str, more: &[&str]| {
        folder.works(&[&["render", "box.yaml", "-o", name], more].concat());
    };
    render("exact.exr", &["--estimator", "exact"]);
    render("counted.exr", &["--seed", "3"]);
    render("exact.png", &["--estimator", "exact"]);
    render("counted.png", &["--seed", "3"]);
    let diff = |more: &[&str]| -> Value {
        let told = folder.works(&[&["diff"], more, &["--json"]].concat());
        serde_json::from_str(&told).unwrap()
    };
    let same = diff(&["exact.exr", "exact.exr"]);
    assert_eq!(
        [&same["rmse"], &same["relative_mse"], &same["flip"]],
        [0.0, 0.0, 0.0]
    );
    let found = diff(&["exact.exr", "counted.exr", "-o", "error.png"]);
    // Compute the expected values from the pixels.
    let [exact, counted] = ["exact.exr", "counted.exr"].map(|name| channels(&folder.path(name)));
    let mut squares = [0.0f64; 2];
    for (name, reference) in &exact {
        for (a, b) in reference.iter().zip(&counted[name]) {
            let (a, b) = (f64::from(*a), f64::from(*b));
            squares[0] += (b - a).powi(2);
            squares[1] += (b - a).powi(2) / (a * a + 0.01);
        }
    }
    let [rmse, relative] = squares.map(|sum| sum / (3.0 * 143.0));
    assert!((found["rmse"].as_f64().unwrap() - rmse.sqrt()).abs() < 1e-12);
    assert!((found["relative_mse"].as_f64().unwrap() - relative).abs() < 1e-12);
    let flip = found["flip"].as_f64().unwrap();
    assert!(flip > 0.0 && flip < 1.0, "{flip}");
    let decoder = png::Decoder::new(std::io::Cursor::new(folder.read("error.png")));
    assert_eq!(decoder.read_info().unwrap().info().size(), (13, 11));
    let shown = diff(&["exact.png", "counted.png"]);
    assert_eq!(shown["of"], "display");
    assert!(shown["flip"].as_f64().unwrap() > 0.0);
    for names in [["exact.png", "counted.png"], ["exact.exr", "counted.exr"]] {
        let errors = folder.fails(2, &[&["diff", "--max-memory", "10k"], &names[..]].concat());
        assert!(
            errors.contains("comparing pictures of 13 x 11 pixels would take"),
            "{errors}"
        );
    }
    let text = folder.works(&["diff", "exact.png", "counted.png"]);
    for part in [
        "counted.png against exact.png: 13 x 11 pixels",
        "RMSE",
        "relative MSE",
        "FLIP",
    ] {
        assert!(text.contains(part), "{text}");
    }

    render("crop.exr", &["--crop", "0,0,3,3"]);
    fs::write(folder.path("not.png"), "no picture").unwrap();
    fs::write(folder.path("not.exr"), &folder.read("exact.exr")[..500]).unwrap();
    for (code, arguments, says) in [
        (
            2,
            &["exact.exr", "crop.exr"][..],
            "13 x 11 and 3 x 3 pixels",
        ),
        (2, &["exact.exr", "exact.png"], "compare two of a kind"),
        (
            2,
            &["exact.exr", "box.yaml"],
            "does not say which kind of picture",
        ),
        (
            2,
            &["exact.exr", "counted.exr", "-o", "error.exr"],
            "end its name in `.png`",
        ),
        (
            2,
            &["exact.png", "counted.png", "-o", "exact.png"],
            "two different things",
        ),
        (1, &["missing.png", "counted.png"], "`missing.png`"),
        (1, &["not.png", "counted.png"], "`not.png`"),
        (1, &["not.exr", "counted.exr"], "`not.exr`"),
    ] {
        let errors = folder.fails(code, &[&["diff"], arguments].concat());
        assert!(errors.contains(says), "{errors}");
    }
}
