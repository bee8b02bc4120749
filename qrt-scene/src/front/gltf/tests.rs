//! Tests of the glTF reader: the same mesh in each container, transforms, materials, faults.

use super::*;
use crate::front::meshes::Faces;
use crate::scene::meshes::{FileError, FileMesh, Wanted};
use crate::scene::{Dielectric, Emitter, Ggx, Lambertian, Material, Mirror};
use glam::DVec3;
use proptest::prelude::*;
use qrt_syntax::MeshFile;
use std::path::Path;

/// A tetrahedron: 4 points, then the indices of 4 triangles as bytes.
fn binary() -> Vec<u8> {
    let points: [[f32; 3]; 4] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ];
    let points = points.as_flattened().iter().flat_map(|x| x.to_le_bytes());
    points.chain([0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2]).collect()
}

/// The JSON text of the tetrahedron, with `old` parts replaced by `new` ones.
fn json(edits: &[(&str, &str)]) -> String {
    let mut text = r#"{
  "asset": { "version": "2.0" },
  "scene": 0,
  "scenes": [{ "nodes": [0] }],
  "nodes": [{ "mesh": 0 }],
  "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1, "material": 0 }] }],
  "materials": [{ "name": "red", "pbrMetallicRoughness": { "metallicFactor": 0 } }],
  "accessors": [
    { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
      "min": [0, 0, 0], "max": [1, 1, 1] },
    { "bufferView": 1, "componentType": 5121, "count": 12, "type": "SCALAR" }
  ],
  "bufferViews": [
    { "buffer": 0, "byteLength": 48 },
    { "buffer": 0, "byteOffset": 48, "byteLength": 12 }
  ],
  "buffers": [{ "uri": "my%20mesh.bin", "byteLength": 60 }]
}"#
    .to_owned();
    for (old, new) in edits {
        assert!(text.contains(old), "{old}");
        text = text.replace(old, new);
    }
    text
}

fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut out = b"glTF\x02\0\0\0".to_vec();
    out.extend((20 + json.len() + 8 + binary.len()).to_le_bytes()[..4].iter());
    for (kind, chunk) in [(b"JSON", &json[..]), (b"BIN\0", binary)] {
        out.extend((chunk.len() as u32).to_le_bytes());
        out.extend(kind);
        out.extend(chunk);
    }
    out
}

fn read_with(bytes: &[u8], wants_materials: bool) -> Result<FileMesh, FileError> {
    let mut library = |path: &Path| {
        if path == Path::new("dir/my mesh.bin") {
            return Ok(binary().into());
        }
        let (file, is_library) = (path.to_owned(), true);
        Err(MeshFile::Missing { file, is_library })
    };
    let path = Path::new("dir/m.gltf");
    parse(
        path,
        bytes,
        Wanted {
            materials: wants_materials,
            normals: true,
            colours: false,
        },
        Faces::default(),
        &mut library,
    )
}

/// Reads a file of which at most `most` triangles are allowed.
fn read_at_most(most: usize, json: &str) -> Result<FileMesh, FileError> {
    let mut library = |_: &Path| Ok(binary().into());
    let path = Path::new("dir/m.gltf");
    parse(
        path,
        json.as_bytes(),
        Wanted::USUAL,
        Faces::new(most),
        &mut library,
    )
}

fn read(json: &str) -> Result<FileMesh, FileError> {
    read_with(json.as_bytes(), true)
}

/// The volume within a closed mesh: positive if its faces look outward.
fn volume(mesh: &FileMesh) -> f64 {
    let six_times = |[a, b, c]: [DVec3; 3]| a.dot(b.cross(c));
    let faces = mesh.faces.iter();
    faces.map(|face| six_times(face.vertices)).sum::<f64>() / 6.0
}

const FILE: &str = r#""uri": "my%20mesh.bin", "#;

#[test]
fn a_mesh_is_the_same_in_every_container() {
    const DIGITS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let beside = read(&json(&[])).unwrap();
    assert_eq!((beside.faces.len(), beside.notes.len()), (4, 0));
    assert!((volume(&beside) - 1.0 / 6.0).abs() < 1e-15);
    assert_eq!(beside.files.len(), 2);
    assert_eq!(beside.materials[0].label, "m.gltf:red");
    let one_file = glb(&json(&[(FILE, "")]), &binary());
    let one_file = read_with(&one_file, true).unwrap();
    // Base64 of the same bytes.
    let mut text = String::new();
    for group in binary().chunks(3) {
        let bits = group
            .iter()
            .fold(0, |bits, byte| bits << 8 | usize::from(*byte));
        for digit in [18, 12, 6, 0] {
            text.push(char::from(DIGITS[bits >> digit & 63]));
        }
    }
    let uri = format!("\"uri\": \"data:application/octet-stream;base64,{text}\", ");
    let in_text = read(&json(&[(FILE, &uri)])).unwrap();
    for mesh in [one_file, in_text] {
        assert_eq!(mesh.faces, beside.faces);
        assert_eq!(mesh.files.len(), 1);
    }
    let without = read_with(json(&[]).as_bytes(), false).unwrap();
    assert!(without.materials.is_empty());
    assert!(without.faces.iter().all(|face| face.material.is_none()));
}

#[test]
fn transforms_are_those_of_all_nodes_above() {
    for (nodes, scale, far) in [
        (r#"{ "mesh": 0, "scale": [2, 2, 2] }"#, 8.0, 2.0),
        (r#"{ "mesh": 0, "scale": [-1, 1, 1] }"#, 1.0, 1.0),
        (
            r#"{ "children": [1], "scale": [1, 1, -3] },
               { "mesh": 0, "translation": [0, 0, 1], "rotation": [0.5, 0.5, 0.5, 0.5] }"#,
            3.0,
            6.0,
        ),
        (
            r#"{ "mesh": 0, "matrix": [2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1] }"#,
            2.0,
            6.0,
        ),
    ] {
        let nodes = format!("\"nodes\": [{nodes}]");
        let mesh = read(&json(&[(r#""nodes": [{ "mesh": 0 }]"#, &nodes)])).unwrap();
        // Faces that a mirror turns around still look outward.
        assert!((volume(&mesh) - scale / 6.0).abs() < 1e-6, "{nodes}");
        let corners = mesh.faces.iter().flat_map(|face| face.vertices);
        let farthest = corners.map(|v| v.abs().max_element()).fold(0.0, f64::max);
        assert!((farthest - far).abs() < 1e-6, "{nodes}: {farthest}");
    }
}

#[test]
fn strips_and_fans_have_the_winding_of_the_format() {
    let indices = r#""indices": 1, "#;
    for (mode, expected) in [(5, [[0, 1, 2], [1, 3, 2]]), (6, [[1, 2, 0], [2, 3, 0]])] {
        let new = format!("\"mode\": {mode}, ");
        let mesh = read(&json(&[(indices, &new)])).unwrap();
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let expected = expected.map(|face| face.map(|corner: usize| points[corner]));
        let found: Vec<_> = mesh.faces.iter().map(|face| face.vertices).collect();
        assert_eq!(found, expected, "{mode}");
    }
    let lines = format!(
        "{}]",
        r#"{ "attributes": { "POSITION": 0 }, "mode": 1 }, { "attributes""#
    );
    let lines = lines.trim_end_matches(']');
    let mesh = read(&json(&[(r#"{ "attributes""#, lines)])).unwrap();
    assert_eq!(mesh.notes.len(), 1);
    assert_eq!(mesh.notes[0].place.to_string(), ": meshes[0].primitives[0]");
}

#[test]
fn materials_are_those_of_the_scene_language() {
    let grey = |grey: f64| [grey; 3];
    let quarter = r#""baseColorFactor": [0.25, 0.25, 0.25, 1]"#;
    for (material, expected, left_out) in [
        (
            format!("\"pbrMetallicRoughness\": {{ {quarter}, \"metallicFactor\": 0 }}"),
            Material::from(Lambertian {
                albedo: grey(0.25).into(),
            }),
            "",
        ),
        (
            format!("\"pbrMetallicRoughness\": {{ {quarter}, \"roughnessFactor\": 0.5 }}"),
            Ggx {
                alpha: 0.25,
                reflectance: grey(0.25).into(),
            }
            .into(),
            "",
        ),
        (
            format!("\"pbrMetallicRoughness\": {{ {quarter}, \"roughnessFactor\": 0 }}"),
            Mirror {
                reflectance: grey(0.25).into(),
            }
            .into(),
            "",
        ),
        (
            r#""emissiveFactor": [1, 0.5, 0], "pbrMetallicRoughness": { "metallicFactor": 0 },
               "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 8 } }"#
                .to_owned(),
            Emitter {
                radiance: [8.0, 4.0, 0.0],
                albedo: grey(1.0).into(),
            }
            .into(),
            "",
        ),
        (
            r#""pbrMetallicRoughness": { "metallicFactor": 0, "roughnessFactor": 0 },
               "extensions": {
               "KHR_materials_transmission": { "transmissionFactor": 1 },
               "KHR_materials_ior": { "ior": 1.25 } }"#
                .to_owned(),
            Dielectric::clear(1.25).into(),
            "",
        ),
        (
            r#""alphaMode": "BLEND", "pbrMetallicRoughness":
               { "metallicFactor": 0.25, "baseColorFactor": [1, 1, 1, 0.75] }"#
                .to_owned(),
            Lambertian {
                albedo: grey(1.0).into(),
            }
            .into(),
            "alpha metallicFactor",
        ),
    ] {
        let old = r#""pbrMetallicRoughness": { "metallicFactor": 0 }"#;
        let mesh = read(&json(&[(old, &material)])).unwrap();
        let [found] = &mesh.materials[..] else {
            panic!("{:?}", mesh.materials);
        };
        assert_eq!((&*found.name, &found.material), ("red", &Ok(expected)));
        let keywords: Vec<&str> = found.left_out.iter().map(String::as_str).collect();
        assert_eq!(keywords.join(" "), left_out, "{material}");
    }
}

#[test]
fn faults_are_refused_at_their_part() {
    for (old, new, code, place, words) in [
        (
            "\"2.0\" }",
            "\"2.0\"",
            "QRT0350",
            ":",
            "cannot be read as glTF 2",
        ),
        (
            "\"mesh\": 0",
            "\"mesh\": 7",
            "QRT0350",
            ": nodes[0].mesh",
            "out of bounds",
        ),
        (
            "\"mesh\": 0",
            "\"children\": [0]",
            "QRT0350",
            ": nodes[0]",
            "reached twice",
        ),
        (
            "\"scene\": 0",
            "\"extensionsRequired\": [\"KHR_draco_mesh_compression\"]",
            "QRT0350",
            "",
            "KHR_draco",
        ),
        ("\"POSITION\": 0", "\"NORMAL\": 0", "QRT0350", "", ""),
        ("\"POSITION\": 0", "\"POSITION\": 9", "QRT0350", "", ""),
        (
            "5121, \"count\": 12",
            "5126, \"count\": 3",
            "QRT0351",
            ": meshes[0].primitives[0]",
            "`indices`",
        ),
        (
            "\"count\": 12",
            "\"count\": 13",
            "QRT0351",
            ": meshes[0].primitives[0], accessors[1]",
            "end early",
        ),
        (
            "48, \"byteLength\": 12",
            "52, \"byteLength\": 12",
            "QRT0351",
            ": meshes[0].primitives[0], accessors[1]",
            "end early",
        ),
        (
            "\"count\": 4",
            "\"count\": 1",
            "QRT0329",
            ": meshes[0].primitives[0]",
            "no vertex 2: the file has 1",
        ),
        (
            "my%20mesh",
            "other",
            "QRT0334",
            ": buffers[0]",
            "no such file",
        ),
        (FILE, "", "QRT0351", ": buffers[0]", "no binary data"),
        (
            "my%20mesh.bin",
            "data:;base64,???",
            "QRT0351",
            ": buffers[0]",
            "base64",
        ),
        (
            ", \"material\": 0",
            "",
            "QRT0336",
            ": meshes[0].primitives[0]",
            "no material",
        ),
        ("\"nodes\": [0]", "\"nodes\": []", "QRT0331", "", "no faces"),
    ] {
        let result = read(&json(&[(old, new)]));
        let error = result.expect_err(words);
        let told = error.what.description();
        assert_eq!(told.code, code, "{error}");
        let found = error.place.to_string();
        let is_place = if place == ":" || words.is_empty() {
            found.starts_with(place)
        } else {
            found == place
        };
        assert!(is_place, "{error}");
        let text = format!("{error} | {}", told.help.unwrap_or_default());
        assert!(text.contains(words), "{text}");
    }
    for (bytes, code) in [
        (&b"glTF"[..], "QRT0351"),
        (b"glTF\x02\0\0\0\0\0\0\0", "QRT0351"),
        (b"glTF\x01\0\0\0\0\0\0\0", "QRT0350"),
        (b"glTF\x02\0\0\0\x14\0\0\0\xff\xff\xff\xffJSON", "QRT0351"),
        (b"glTF\x02\0\0\0\x14\0\0\0\0\0\0\0JSON", "QRT0350"),
        (b"", "QRT0350"),
        (b"[1, 2", "QRT0350"),
    ] {
        let error = read_with(bytes, true).unwrap_err();
        assert_eq!(error.what.description().code, code, "{error}");
    }
}

/// Short texts that take much memory are refused before they are parsed.
#[test]
fn the_memory_of_a_text_is_bounded() {
    for (count, value) in [(1 << 18, "{}"), (1 << 19, "[]"), (1 << 21, "0")] {
        let minimum = |count: usize| {
            let new = format!("\"min\": [{}0], \"max\"", format!("{value},").repeat(count));
            json(&[("\"min\": [0, 0, 0], \"max\"", &new)])
        };
        let error = read(&minimum(count + 1)).unwrap_err();
        assert_eq!(error.what.description().code, "QRT0321", "{value}: {error}");
        let fewer = read(&minimum(count / 2)).map_err(|error| error.what.description().code);
        assert_ne!(fewer.err(), Some("QRT0321"), "{value}");
    }
}

/// Each node places all primitives of its mesh.
#[test]
fn what_nodes_place_is_bounded() {
    let nodes = [r#"{ "mesh": 0 }"#; 8].join(", ");
    let nodes = format!("\"nodes\": [{nodes}], \"scenes\": []");
    let edits = [
        (r#""nodes": [{ "mesh": 0 }]"#, &*nodes),
        (r#""scene": 0,"#, ""),
        (r#""scenes": [{ "nodes": [0] }],"#, ""),
    ];
    for (indices, mode) in [("", r#""mode": 1"#), (r#""indices": 1, "#, r#""mode": 4"#)] {
        // Lines, and a list of no triangles.
        let empty = format!(r#"{{ "attributes": {{ "POSITION": 0 }}, {indices}{mode} }}"#);
        let primitives = [&*empty; 4].join(", ");
        let primitives = format!("\"primitives\": [{primitives}]");
        let mut edits = edits.to_vec();
        let old =
            r#""primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1, "material": 0 }]"#;
        edits.push((old, &primitives));
        edits.push((r#""count": 12"#, r#""count": 2"#));
        let text = json(&edits);
        let error = read_at_most(31, &text).unwrap_err();
        assert_eq!(error.what.description().code, "QRT0321", "{error}");
        assert_eq!(error.place.to_string(), ": meshes[0].primitives[3]");
        let error = read_at_most(32, &text).unwrap_err();
        assert_eq!(error.what.description().code, "QRT0331", "{error}");
    }
}

#[test]
fn the_binary_data_of_a_file_are_its_first_buffer() {
    let second =
        r#""buffers": [{ "uri": "my%20mesh.bin", "byteLength": 60 }, { "byteLength": 60 }]"#;
    let text = json(&[
        (
            r#""buffers": [{ "uri": "my%20mesh.bin", "byteLength": 60 }]"#,
            second,
        ),
        (
            r#""buffer": 0, "byteLength": 48"#,
            r#""buffer": 1, "byteLength": 48"#,
        ),
    ]);
    let error = read_with(&glb(&text, &binary()), true).unwrap_err();
    assert_eq!(error.what.description().code, "QRT0351", "{error}");
    assert_eq!(error.place.to_string(), ": buffers[1]");
}

#[test]
fn a_binary_file_ends_where_its_header_says() {
    let file = glb(&json(&[(FILE, "")]), &binary());
    let mesh = read_with(&file, true).unwrap();
    for more in [&b"\n"[..], b"another file behind it"] {
        let longer = read_with(&[&file, more].concat(), true).unwrap();
        assert_eq!(longer.faces, mesh.faces);
        // A file without binary data.
        let chunk = file.len() - 8 - 60;
        let mut text_alone = file[..chunk].to_vec();
        text_alone[8..12].copy_from_slice(&(chunk as u32).to_le_bytes());
        let error = read_with(&[&text_alone, more].concat(), true).unwrap_err();
        assert!(error.to_string().contains("no binary data"), "{error}");
    }
    // The header's length is that of a whole file, and some data are missing.
    let error = read_with(&file[..file.len() - 1], true).unwrap_err();
    assert!(error.to_string().contains("end early"), "{error}");
    // The end of a longer file is not read.
    let mut shorter = file;
    shorter[8] -= 4;
    let error = read_with(&shorter, true).unwrap_err();
    assert!(error.to_string().contains("end early"), "{error}");
}

/// The tetrahedron with an attribute `COLOR_0` of the accessor that `accessor` gives without its view, after the
/// bytes of the tetrahedron.
fn coloured(accessor: &str, colours: &[u8], wanted: bool) -> Result<FileMesh, FileError> {
    let mut bytes = binary();
    bytes.extend(colours);
    let text = json(&[
        (r#""POSITION": 0 "#, r#""POSITION": 0, "COLOR_0": 2 "#),
        (
            r#""type": "SCALAR" }"#,
            &format!(r#""type": "SCALAR" }}, {{ "bufferView": 2, {accessor} }}"#),
        ),
        (
            r#""byteOffset": 48, "byteLength": 12 }"#,
            &format!(
                r#""byteOffset": 48, "byteLength": 12 }},
                {{ "buffer": 0, "byteOffset": 60, "byteLength": {} }}"#,
                colours.len()
            ),
        ),
        (
            r#""byteLength": 60 }"#,
            &format!(r#""byteLength": {} }}"#, bytes.len()),
        ),
        (FILE, ""),
    ]);
    let mut library = |path: &Path| unreachable!("{}", path.display());
    parse(
        Path::new("dir/m.glb"),
        &glb(&text, &bytes),
        Wanted {
            colours: wanted,
            ..Wanted::default()
        },
        Faces::default(),
        &mut library,
    )
}

/// Four colours, by channel in 255ths.
const COLOURS: [[u8; 3]; 4] = [[255, 0, 51], [0, 102, 153], [204, 255, 0], [51, 51, 255]];

#[test]
fn colours_of_vertices_are_read_in_every_type() {
    let floats = |alpha: Option<f32>| -> Vec<u8> {
        let colour = |c: &[u8; 3]| c.map(|c| f32::from(c) / 255.0).into_iter().chain(alpha);
        let numbers = COLOURS.iter().flat_map(|c| colour(c).collect::<Vec<_>>());
        numbers.flat_map(f32::to_le_bytes).collect()
    };
    // Rows are aligned to four bytes.
    let bytes: Vec<u8> = COLOURS.iter().flat_map(|&[r, g, b]| [r, g, b, 7]).collect();
    let shorts = |c: &[u8; 3]| c.map(|c| u16::from(c) * 257);
    let shorts = COLOURS.iter().flat_map(|c| [&shorts(c)[..], &[9]].concat());
    let shorts: Vec<u8> = shorts.flat_map(u16::to_le_bytes).collect();
    let whole = |kind: u32| {
        format!(r#""componentType": {kind}, "normalized": true, "count": 4, "type": "VEC4""#)
    };
    let [three, four] = ["VEC3", "VEC4"]
        .map(|kind| format!(r#""componentType": 5126, "count": 4, "type": "{kind}""#));
    // The faces are 0 2 1, 0 1 3, 1 2 3 and 0 3 2.
    let corners = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let expected = corners.map(|face| face.map(|c| COLOURS[c].map(|c| f64::from(c) / 255.0)));
    for (accessor, data) in [
        (&three, floats(None)),
        (&four, floats(Some(0.5))),
        (&whole(5121), bytes),
        (&whole(5123), shorts),
    ] {
        let found = coloured(accessor, &data, true).unwrap().colours;
        let pairs = found.as_flattened().iter().zip(expected.as_flattened());
        for (found, expected) in pairs {
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-7, "{accessor}: {found}");
            }
        }
        assert_eq!(found.len(), 4);
    }
}

#[test]
fn colours_that_are_none_are_refused_at_their_primitive() {
    let data = [0; 64];
    for (accessor, code) in [
        (
            r#""componentType": 5121, "count": 4, "type": "VEC4""#,
            "QRT0351",
        ),
        (
            r#""componentType": 5126, "count": 4, "type": "VEC2""#,
            "QRT0351",
        ),
        (
            r#""componentType": 5126, "count": 3, "type": "VEC3""#,
            "QRT0329",
        ),
        (
            r#""componentType": 5126, "count": 9, "type": "VEC3""#,
            "QRT0351",
        ),
    ] {
        let error = coloured(accessor, &data, true).unwrap_err().to_string();
        assert!(error.contains(code), "{error}");
        assert!(error.contains("meshes[0].primitives[0]"), "{error}");
    }
    let accessor = r#""componentType": 5126, "count": 4, "type": "VEC3""#;
    let bright: Vec<u8> = [1.5_f32; 12]
        .into_iter()
        .flat_map(f32::to_le_bytes)
        .collect();
    let error = coloured(accessor, &bright, true).unwrap_err().to_string();
    assert!(
        error.contains("1.5") && error.contains("QRT0338"),
        "{error}"
    );
}

#[test]
fn colours_that_are_not_used_are_named_once() {
    let attributes = r#""attributes": { "POSITION": 0, "COLOR_0": 0 }"#;
    let plain = r#""attributes": { "POSITION": 0 }"#;
    let primitive = format!(r#"{{ {attributes}, "indices": 1, "material": 0 }}"#);
    let meshes = format!(r#""meshes": [ {{ "primitives": [{primitive}, {primitive}] }},"#);
    let text = json(&[(r#""meshes": ["#, &meshes)]);
    for wants_materials in [true, false] {
        let mesh = read_with(text.as_bytes(), wants_materials).unwrap();
        assert!(mesh.colours.is_empty());
        let notes = mesh.notes.iter().map(ToString::to_string);
        let notes: Vec<String> = notes.filter(|note| note.contains("QRT0354")).collect();
        let [note] = &notes[..] else {
            panic!("{notes:?}");
        };
        assert!(note.contains("meshes[0].primitives[0]"), "{note}");
    }
    let notes = read(&text.replace(attributes, plain)).unwrap().notes;
    assert!(
        notes
            .iter()
            .all(|note| !note.to_string().contains("QRT0354"))
    );
}

#[test]
fn textures_are_judged_where_they_are_used() {
    let textured = r#""pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } }"#;
    let old = r#""pbrMetallicRoughness": { "metallicFactor": 0 }"#;
    let images = r#""textures": [{ "source": 0 }], "images": [{ "uri": "a.png" }], "scene": 0"#;
    let text = json(&[(old, textured), ("\"scene\": 0", images)]);
    let mesh = read(&text).unwrap();
    let error = mesh.materials[0].material.clone().unwrap_err();
    assert_eq!(error.what.description().code, "QRT0342");
    assert_eq!(error.place.to_string(), ": materials[0]");
    assert_eq!(read_with(text.as_bytes(), false).unwrap().faces.len(), 4);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(3000) })]

    #[test]
    fn no_bytes_make_it_panic(
        is_binary in any::<bool>(),
        edits in prop::collection::vec((0.0..1.0_f64, any::<u8>(), 0..5_u8), 0..5),
    ) {
        let mut bytes = if is_binary {
            glb(&json(&[(FILE, "")]), &binary())
        } else {
            json(&[]).into_bytes()
        };
        for (place, byte, edit) in edits {
            let at = (place * bytes.len() as f64) as usize;
            match edit {
                0 => bytes.insert(at, byte),
                1 if at < bytes.len() => bytes[at] = byte,
                2 if at < bytes.len() => bytes[at] = b"0123456789-[]{},\"e"[usize::from(byte) % 18],
                3 => bytes.truncate(bytes.len().max(40) - usize::from(byte % 32)),
                _ => drop(bytes.drain(at..(at + 1 + usize::from(byte % 8)).min(bytes.len()))),
            }
        }
        if let Ok(mesh) = read_with(&bytes, true) {
            prop_assert!(!mesh.faces.is_empty());
            let finite = mesh.faces.iter().all(|face| face.vertices.iter().all(|v| v.is_finite()));
            prop_assert!(finite);
            prop_assert!(mesh.faces.iter().all(|face| face.material < Some(mesh.materials.len())));
        }
    }
}

#[test]
fn normals_turn_with_their_node() {
    let normals = r#""POSITION": 0, "NORMAL": 0"#;
    assert!(read(&json(&[])).unwrap().normals.is_empty());
    // The positions as normals: the first is 0, which stands for the face's own.
    let mesh = read(&json(&[(r#""POSITION": 0"#, normals)])).unwrap();
    let own = crate::polygons::unit_normal(&mesh.faces[0].vertices);
    assert_eq!(mesh.normals[0], [own, DVec3::Y, DVec3::X]);
    // Scaled along x, a normal across both axes turns away from it; a mirror turns the face around.
    let scaled = [
        (r#""POSITION": 0"#, normals),
        (r#""mesh": 0 }"#, r#""mesh": 0, "scale": [-4, 1, 1] }"#),
    ];
    let mesh = read(&json(&scaled)).unwrap();
    assert_eq!(mesh.normals[0][1..], [-DVec3::X, DVec3::Y]);
    let wrong = [(r#""POSITION": 0"#, r#""POSITION": 0, "NORMAL": 1"#)];
    let mesh = read(&json(&wrong)).unwrap();
    assert!(mesh.normals.is_empty());
    assert_eq!(*mesh.notes[0].what, MeshFile::GltfNormals);
}
