//! Tests of the PLY reader: the same mesh in each encoding, faults at their place, and any bytes.

use super::*;
use crate::scene::meshes::FileFace;
use proptest::prelude::*;
use std::fmt::Write as _;

/// A cube: 8 vertices and 6 quads.
const VERTICES: [[f32; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [0.0, 1.0, 1.0],
];
const FACES: [[u8; 4]; 6] = [
    [0, 3, 2, 1],
    [4, 5, 6, 7],
    [0, 1, 5, 4],
    [1, 2, 6, 5],
    [2, 3, 7, 6],
    [3, 0, 4, 7],
];

/// The cube's header: vertices with a colour and a weight, an element of no use, and faces with a
/// flag before and a list after their corners.
fn header(encoding: &str, end: &str) -> Vec<u8> {
    let lines = [
        "ply",
        &format!("format {encoding} 1.0"),
        "comment a cube",
        "element vertex 8",
        "property uchar red",
        "property float y",
        "property float32 x",
        "property double z",
        "element camera 2",
        "property short id",
        "property list ushort int8 words",
        "obj_info none",
        "element face 6",
        "property int flag",
        "property list uint8 int vertex_indices",
        "property list uchar float texcoord",
        "end_header",
        "",
    ];
    lines.join(end).into_bytes()
}

fn ascii(end: &str) -> Vec<u8> {
    let mut lines = Vec::new();
    for [x, y, z] in VERTICES {
        lines.push(format!("255 {y} {x} {z}"));
    }
    lines.push("7 2 -1 4".to_owned());
    lines.push("-7 0".to_owned());
    for [a, b, c, d] in FACES {
        lines.push(format!("1 4 {a} {b}\t{c} {d} 2 0.5 nan"));
    }
    [header("ascii", end), lines.join(end).into_bytes()].concat()
}

fn binary(is_big: bool, end: &str) -> Vec<u8> {
    let name = if is_big {
        "binary_big_endian"
    } else {
        "binary_little_endian"
    };
    let mut out = header(name, end);
    let mut put = |bytes: &[u8]| {
        let bytes = bytes.iter().copied();
        if is_big {
            out.extend(bytes.rev());
        } else {
            out.extend(bytes);
        }
    };
    for [x, y, z] in VERTICES {
        put(&[255]);
        put(&y.to_le_bytes());
        put(&x.to_le_bytes());
        put(&f64::from(z).to_le_bytes());
    }
    for (id, words) in [(7_i16, &[-1_i8, 4][..]), (-7, &[])] {
        put(&id.to_le_bytes());
        put(&(words.len() as u16).to_le_bytes());
        for word in words {
            put(&word.to_le_bytes());
        }
    }
    for face in FACES {
        put(&1_i32.to_le_bytes());
        put(&[4]);
        for corner in face {
            put(&i32::from(corner).to_le_bytes());
        }
        put(&[1]);
        put(&f32::NAN.to_le_bytes());
    }
    out
}

fn read(bytes: &[u8]) -> Result<FileMesh, FileError> {
    parse(
        "m.ply".as_ref(),
        bytes,
        Wanted {
            materials: false,
            normals: true,
            colours: false,
        },
        Faces::default(),
    )
}

fn volume(faces: &[FileFace]) -> f64 {
    let six_times = |[a, b, c]: [DVec3; 3]| a.dot(b.cross(c));
    faces
        .iter()
        .map(|face| six_times(face.vertices))
        .sum::<f64>()
        / 6.0
}

#[test]
fn a_cube_is_the_same_in_every_encoding() {
    let expected = read(&ascii("\n")).unwrap();
    assert_eq!(expected.faces.len(), 12);
    assert_eq!(volume(&expected.faces), 1.0);
    assert_eq!((expected.notes, expected.materials), (vec![], vec![]));
    for end in ["\n", "\r\n", "\r"] {
        for bytes in [ascii(end), binary(false, end), binary(true, end)] {
            assert_eq!(read(&bytes).unwrap().faces, expected.faces, "{end:?}");
        }
    }
}

#[test]
fn integers_of_each_width_are_read() {
    let mesh = |types: &str, list: &[u8], index: &[u8]| {
        let head = format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex 200\nproperty float x\n\
             property float y\nproperty float z\nelement face 1\nproperty list {types} vertex_index\n\
             end_header\n"
        );
        let mut bytes = head.into_bytes();
        for number in 0..200_u8 {
            let x = f32::from(number);
            for x in [x, x * x, 0.0] {
                bytes.extend(x.to_le_bytes());
            }
        }
        bytes.extend(list);
        for number in [0_u8, 100, 199] {
            bytes.push(number);
            bytes.extend(index);
        }
        read(&bytes).unwrap().faces[0].vertices.map(|v| v.x)
    };
    for (types, list, index) in [
        ("uchar uchar", &[3][..], &[][..]),
        ("char ushort", &[3], &[0]),
        ("short short", &[3, 0], &[0]),
        ("ushort uint", &[3, 0], &[0, 0, 0]),
        ("int int32", &[3, 0, 0, 0], &[0, 0, 0]),
        ("uint32 uint16", &[3, 0, 0, 0], &[0]),
    ] {
        assert_eq!(mesh(types, list, index), [0.0, 100.0, 199.0], "{types}");
    }
}

#[track_caller]
fn refused(bytes: &[u8], code: &str, place: &str, words: &str) {
    let error = read(bytes).expect_err(words);
    let told = error.what.description();
    assert_eq!(
        (told.code, &*error.place.to_string()),
        (code, place),
        "{error}"
    );
    let text = format!("{error} | {}", told.help.unwrap_or_default());
    assert!(text.contains(words), "{text}");
}

#[test]
fn faulty_headers_are_refused_at_their_line() {
    let vertex = "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
    for (text, place, words) in [
        ("", ":1", "first line is not `ply`"),
        ("plywood\n", ":1", "first line is not `ply`"),
        ("ply\nformat ascii 1.0\n", ":3", "no `end_header`"),
        ("ply\nend_header\n", ":1", "no `format`"),
        ("ply\nformat ascii 2.0\n", ":2", "`format ascii 2.0` cannot"),
        ("ply\nformat text 1.0\n", ":2", "`format text 1.0` cannot"),
        (
            "ply\nformat ascii 1.0\nformat ascii 1.0\n",
            ":3",
            "cannot be read",
        ),
        (
            "ply\nelement vertex -1\n",
            ":2",
            "`element vertex -1` cannot",
        ),
        ("ply\nelement vertex 1e3\n", ":2", "cannot be read"),
        ("ply\nproperty float x\n", ":2", "cannot be read"),
        (
            "ply\nelement vertex 1\nproperty half x\n",
            ":3",
            "`half` is no type",
        ),
        (
            "ply\nelement vertex 1\nproperty list uchar x\n",
            ":3",
            "`property list uchar x` cannot be read",
        ),
        ("ply\n\nvertices 4\n", ":3", "`vertices 4` cannot be read"),
    ] {
        refused(text.as_bytes(), "QRT0347", place, words);
        let ended = text.replace('\n', "\r");
        refused(ended.as_bytes(), "QRT0347", place, words);
    }
    let many = format!(
        "ply\nformat ascii 1.0\n{}",
        "element a 0\n".repeat(MOST_DECLARED)
    );
    refused(many.as_bytes(), "QRT0347", ":1026", "more than 1024");
    let file = |rest: &str| format!("ply\nformat ascii 1.0\n{rest}end_header\n").into_bytes();
    let bare = vertex.replace("property float z\n", "property list uchar float z\n");
    refused(&file(&bare), "QRT0347", ":7", "no property `z`");
    let faces = format!("{vertex}element face 0\nproperty int corners\n");
    let told = [&file(&faces)[..], b"0 0 0\n"].concat();
    refused(&told, "QRT0347", ":9", "no list `vertex_indices`");
    let none = [&file(vertex)[..], b"0 0 0\n"].concat();
    refused(&none, "QRT0331", "", "no faces");
    let strips = file("element tristrips 0\nproperty list int int vertex_indices\n");
    refused(&strips, "QRT0324", "", "triangle strips");
}

#[test]
fn faulty_data_are_refused_at_their_element() {
    let text = String::from_utf8(ascii("\n")).unwrap();
    let with = |old: &str, new: &str| text.replacen(old, new, 1).into_bytes();
    refused(&with("255 0 1 0", "255 0 inf 0"), "QRT0326", ":19", "`inf`");
    refused(&with("255 0 1 0", "255 0 one 0"), "QRT0325", ":19", "`one`");
    refused(&with("1 4 0 3", "1 2 0 3"), "QRT0327", ":28", "2 corners");
    refused(
        &with("1 4 0 3", "1 -4 0 3"),
        "QRT0325",
        ":28",
        "-4 is not a whole",
    );
    refused(
        &with("4 4 5", "4 4 8"),
        "QRT0329",
        ":29",
        "no vertex 8: the file has 8",
    );
    refused(
        &with("4 4 5", "4 4 0.5"),
        "QRT0325",
        ":29",
        "0.5 is not a whole",
    );
    let short = text.trim_end_matches("nan");
    refused(short.as_bytes(), "QRT0348", ":33", "ends before");

    let whole = binary(true, "\n");
    let head = header("binary_big_endian", "\n").len();
    // A vertex has 17 bytes, the element between has 10, a face 26.
    for (length, place) in [
        (head, ": vertex 0, byte 337"),
        (head + 17 * 3 + 5, ": vertex 3, byte 393"),
        (head + 17 * 8 + 5, ": camera 0, byte 477"),
        (head + 17 * 8 + 10 + 26 + 4, ": face 1, byte 513"),
        (whole.len() - 1, ": face 5, byte 635"),
    ] {
        refused(&whole[..length], "QRT0348", place, "ends before");
    }
    let mut nan = whole.clone();
    nan[head + 17 + 1] = 0x7f;
    nan[head + 17 + 2] = 0xff;
    refused(&nan, "QRT0326", ": vertex 1, byte 371", "`NaN`");
    let mut index = whole;
    index[head + 17 * 8 + 10 + 26 + 5] = 1;
    refused(
        &index,
        "QRT0329",
        ": face 1, byte 513",
        "no vertex 16777220",
    );
}

#[test]
fn claims_of_a_header_take_neither_memory_nor_time() {
    let huge = u64::MAX;
    let faces = "element face 4000000\nproperty list uint uchar vertex_indices\n";
    let vertices = "element vertex 9\nproperty char x\nproperty char y\nproperty char z\n";
    for (elements, data, code) in [
        (
            format!("element vertex {huge}\nproperty char x\n"),
            &b""[..],
            "QRT0321",
        ),
        (
            format!("element face {huge}\nproperty char x\n"),
            b"",
            "QRT0321",
        ),
        (
            format!("element none {huge}\nelement face 0\n"),
            b"",
            "QRT0347",
        ),
        (format!("element none {huge}\n"), b"", "QRT0331"),
        (
            format!("element none {huge}\nproperty char a\n"),
            b"0000",
            "QRT0348",
        ),
        (
            format!("{vertices}{faces}"),
            b"000000000000000000000000000\xff\xff\xff\xff0",
            "QRT0321",
        ),
        (
            format!("{vertices}{faces}"),
            b"000000000000000000000000000\x00\x00\xff\xff0",
            "QRT0348",
        ),
        (
            format!("element none 1\nproperty list uint double a\n{faces}"),
            b"\xff\xff\xff\xff0",
            "QRT0348",
        ),
    ] {
        let head = format!("ply\nformat binary_big_endian 1.0\n{elements}end_header\n");
        let error = read(&[head.as_bytes(), data].concat()).unwrap_err();
        assert_eq!(error.what.description().code, code, "{head}: {error}");
    }
    let few = Faces { most: 9, left: 9 };
    let error = parse("m".as_ref(), &ascii("\n"), Wanted::default(), few).unwrap_err();
    assert_eq!(*error.what, MeshFile::ManyTriangles { most: 9 });
}

#[test]
fn a_mesh_without_a_material_of_the_scene_is_refused() {
    let error = parse("m".as_ref(), &ascii("\n"), Wanted::USUAL, Faces::default()).unwrap_err();
    assert_eq!(*error.what, MeshFile::NoMaterials);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(3000) })]

    #[test]
    fn no_bytes_make_it_panic(
        kind in 0..3_usize,
        edits in prop::collection::vec((0.0..1.0_f64, any::<u8>(), 0..4_u8), 0..6),
    ) {
        let mut bytes = [ascii("\n"), binary(true, "\r\n"), binary(false, "\n")][kind].clone();
        for (place, byte, edit) in edits {
            let at = (place * bytes.len() as f64) as usize;
            match edit {
                0 => bytes.insert(at, byte),
                1 if at < bytes.len() => bytes[at] = byte,
                2 => bytes.truncate(bytes.len().max(40) - usize::from(byte % 32)),
                _ => drop(bytes.drain(at..(at + 1 + usize::from(byte % 8)).min(bytes.len()))),
            }
        }
        if let Ok(mesh) = read(&bytes) {
            prop_assert!(!mesh.faces.is_empty());
            let finite = |face: &FileFace| face.vertices.iter().all(|v| v.is_finite());
            prop_assert!(mesh.faces.iter().all(finite));
        }
    }
}

#[test]
fn vertices_may_have_normals() {
    let text = |properties: &str, [a, b, c]: [&str; 3]| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
             property float z\n{properties}element face 1\n\
             property list uchar int vertex_index\nend_header\n\
             0 0 0 {a}\n1 0 0 {b}\n0 1 0 {c}\n3 0 1 2\n"
        )
    };
    let three = "property float nz\nproperty float nx\nproperty float ny\n";
    let mesh = read(text(three, ["2 0 0", "0 1 0", "nan 0 0"]).as_bytes()).unwrap();
    assert_eq!(mesh.normals, [[DVec3::Z, DVec3::X, DVec3::Z]]);
    // Two of the three are no normal.
    let two = text("property float nx\nproperty float ny\n", ["1 0"; 3]);
    assert!(read(two.as_bytes()).unwrap().normals.is_empty());
}

/// A triangle with properties of this type and colours of these words, with or without wanting them.
fn coloured(types: [&str; 3], colours: [&str; 3], wanted: bool) -> Result<FileMesh, FileError> {
    let mut text = "ply\nformat ascii 1.0\nelement vertex 3\n".to_owned();
    for (name, of) in ["red", "green", "blue"].into_iter().zip(types) {
        let _ = writeln!(text, "property {of} {name}");
    }
    text += "property float x\nproperty float y\nproperty float z\nelement face 1\n\
             property list uchar int vertex_indices\nend_header\n";
    for (colour, place) in colours.into_iter().zip(["0 0 0", "1 0 0", "0 1 0"]) {
        let _ = writeln!(text, "{colour} {place}");
    }
    text += "3 2 0 1\n";
    let wanted = Wanted {
        colours: wanted,
        ..Wanted::default()
    };
    parse("m.ply".as_ref(), text.as_bytes(), wanted, Faces::default())
}

#[test]
fn colours_are_in_units_of_their_type() {
    let words = ["255 65535 1", "51 0 0.25", "0 13107 0.5"];
    let mesh = coloured(["uchar", "ushort", "double"], words, true).unwrap();
    let expected = [[0.0, 0.2, 0.5], [1.0, 1.0, 1.0], [0.2, 0.0, 0.25]];
    assert_eq!(mesh.colours, [expected]);
    assert!(mesh.notes.is_empty());
    let plain = coloured(["uchar", "ushort", "double"], words, false).unwrap();
    assert!(plain.colours.is_empty());
    let [note] = &plain.notes[..] else {
        panic!("{:?}", plain.notes);
    };
    assert_eq!(*note.what, MeshFile::ColoursUnused);
}

#[test]
fn colours_of_other_types_or_values_are_refused() {
    let black = ["0 0 0"; 3];
    for of in ["char", "short", "int", "uint32"] {
        let error = coloured(["uchar", of, "uchar"], black, true).unwrap_err();
        let error = error.to_string();
        assert!(
            error.contains("m.ply:12: ") && error.contains("`green`"),
            "{error}"
        );
        assert!(error.contains("QRT0353"), "{error}");
    }
    for (colour, words) in [
        ("0 256 0", "1.0039"),
        ("0 0 -0.5", "-0.5"),
        ("0 0 nan", "NaN"),
    ] {
        let types = ["uchar", "uchar", "float"];
        let error = coloured(types, ["0 0 0", colour, "0 0 0"], true).unwrap_err();
        let error = error.to_string();
        assert!(
            error.contains("m.ply:14: ") && error.contains(words),
            "{error}"
        );
        assert!(error.contains("QRT0338"), "{error}");
    }
}
