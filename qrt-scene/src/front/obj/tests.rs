//! Tests of the reader: valid meshes are read as they are, wrong ones are refused at their line.

mod colours;
mod lines;
mod materials;
mod normals;

use super::*;
use crate::front::load_all;
use crate::scene::meshes::{FileFace, Meshes};
use crate::scene::shape::Part as _;
use crate::scene::{Emitter, Geometry, Lambertian, Material, Scene};
use proptest::prelude::*;
use qrt_syntax::{Place, Problems, codes};
use std::path::PathBuf;

/// The mesh of a text whose libraries are `files`.
fn read_with(text: &str, files: &[(&str, &str)]) -> Result<FileMesh, FileError> {
    let mut library = |path: &Path| {
        let found = files
            .iter()
            .find(|(name, _)| Path::new("dir").join(name) == path);
        let (file, is_library) = (path.to_owned(), true);
        let missing = MeshFile::Missing { file, is_library };
        found.map(|(_, text)| text.as_bytes().into()).ok_or(missing)
    };
    parse(
        Path::new("dir/mesh.obj"),
        text.as_bytes(),
        Wanted {
            materials: !files.is_empty(),
            normals: true,
            colours: false,
        },
        Faces::default(),
        &mut library,
    )
}

fn read(text: &str) -> Result<FileMesh, FileError> {
    read_with(text, &[])
}

/// The mesh, or the error of the first material of its faces.
fn judged(mesh: Result<FileMesh, FileError>) -> Result<FileMesh, FileError> {
    let mesh = mesh?;
    let faults = mesh.materials.iter().map(|m| m.material.clone());
    faults.collect::<Result<Vec<_>, _>>()?;
    Ok(mesh)
}

fn area(mesh: &FileMesh) -> f64 {
    let twice = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).length();
    mesh.faces
        .iter()
        .map(|face| twice(face.vertices) / 2.0)
        .sum()
}

/// The volume within a closed mesh: positive if its faces look outward.
fn volume(mesh: &FileMesh) -> f64 {
    mesh.faces
        .iter()
        .map(|f| f.vertices[0].dot(f.vertices[1].cross(f.vertices[2])) / 6.0)
        .sum()
}

const CUBE: &str = "# a cube\n\
    v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
    f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

#[test]
fn a_cube_has_its_area_and_volume() {
    let mesh = read(CUBE).unwrap();
    assert_eq!((mesh.faces.len(), mesh.materials.len()), (12, 0));
    assert_eq!(area(&mesh), 6.0);
    assert!((volume(&mesh) - 1.0).abs() < 1e-15);
    assert!(mesh.faces.iter().all(|face| face.material.is_none()));
}

#[test]
fn all_ways_to_write_a_face_say_the_same() {
    let vertices = "v 0 0 0\nv 1 0 0 1.0\nv 0 2 0 2 # halved\n";
    let others = "vt 0\nvt 0 0 0\nvt 1 1\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\n";
    let expected = vec![FileFace {
        vertices: [DVec3::ZERO, DVec3::X, DVec3::Y],
        material: None,
    }];
    for face in [
        "f 1 2 3",
        "f -3 -2 -1",
        "f 1/1 2/2 3/3",
        "f 1//1 2//2 3//3",
        "f 1/ 2// 3/1/",
        "f 1/1/1 2/2/2 -1/-1/-1",
        "f\t1 \\\n 2 \\\r\n 3   # a comment",
        "\\\n\\\n\nf 1 2 3\n\\\n",
        "  f  1  2  3  ",
    ] {
        let text = format!("\u{feff}o thing\ng a b\ns off\n{vertices}{others}{face}");
        assert_eq!(read(&text).unwrap().faces, expected, "{face}");
        let crlf = text.replace("\r\n", "\n").replace('\n', "\r\n");
        assert_eq!(read(&crlf).unwrap().faces, expected, "{face}");
    }
    // A face may stand before its vertices, and among groups.
    let early = format!("f 1 2 3\ng one\n{vertices}g two\n");
    assert_eq!(read(&early).unwrap().faces, expected);
}

#[test]
fn coordinates_keep_all_their_digits() {
    let mesh = read("v 0.1 1e9 -1e-9\nv 123456789.123456789 0 0\nv 0 0 1\nf 1 2 3").unwrap();
    let [a, b, _] = mesh.faces[0].vertices;
    assert_eq!(a, DVec3::new(0.1, 1e9, -1e-9));
    assert_eq!(b.x, 123_456_789.123_456_79);
}

const TWO: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nmtllib my colours.mtl\n\
    usemtl dark red\nf 1 2 3\nusemtl lamp\nf 3 2 1\nusemtl dark red\nf 2 3 1\n";
const COLOURS: &str = "# made by hand\nnewmtl dark red\nKa 1 1 1\nKd 0.5 0.1 0\nKs 0 0 0\nNs 10\n\
    illum 2\n\nnewmtl lamp\n  Kd 0\n\tKe 17 12.5 4e0 # bright\nd 1.0\n";

#[test]
fn faces_take_the_materials_of_their_libraries() {
    let mesh = read_with(TWO, &[("my colours.mtl", COLOURS)]).unwrap();
    let red = Material::from(Lambertian {
        albedo: [0.5, 0.1, 0.0].into(),
    });
    let lamp = Material::from(Emitter {
        radiance: [17.0, 12.5, 4.0],
        albedo: [0.0; 3].into(),
    });
    let found = mesh
        .materials
        .iter()
        .map(|m| (&*m.name, &*m.label, &m.material));
    let found: Vec<_> = found.collect();
    assert_eq!(
        found,
        [
            ("dark red", "my colours.mtl:dark red", &Ok(red)),
            ("lamp", "my colours.mtl:lamp", &Ok(lamp)),
        ]
    );
    let used: Vec<_> = mesh.faces.iter().map(|face| face.material).collect();
    // The third face is a copy of the first.
    assert_eq!(used, [Some(0), Some(1)]);
    // Several libraries in a statement, and one that comes after its use.
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl b\nf 1 2 3\nmtllib a.mtl b.mtl\nmtllib a.mtl\n";
    let files = [
        ("a.mtl", "newmtl a\nKd 0 0 0\n"),
        ("b.mtl", "newmtl b\nKd 1 1 1"),
    ];
    let mesh = read_with(text, &files).unwrap();
    assert_eq!(mesh.materials.len(), 1);
    assert_eq!(mesh.materials[0].label, "b.mtl:b");
    // A mesh with a material of the scene needs no library.
    assert_eq!(read(TWO).unwrap().faces.len(), 2);
    assert!(read(TWO).unwrap().materials.is_empty());
}

#[track_caller]
fn refused(result: Result<FileMesh, FileError>, code: &str, line: Option<usize>, words: &str) {
    let error = judged(result).expect_err(words);
    let told = error.what.description();
    let place = line.map_or(FilePlace::Whole, FilePlace::Line);
    assert_eq!((told.code, &error.place), (code, &place), "{error}");
    let text = format!("{error} | {}", told.help.unwrap_or_default());
    assert!(text.contains(words), "{text}");
}

#[test]
fn faulty_meshes_are_refused_at_their_line() {
    let v3 = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let cases: [(&str, &str, Option<usize>, &str); 36] = [
        (
            "v nan 0 0\n",
            "QRT0326",
            Some(1),
            "`nan` is not a finite number",
        ),
        ("v 0 0 0\nv 0 -inf 0\n", "QRT0326", Some(2), "`-inf`"),
        ("v 1e999 0 0\n", "QRT0326", Some(1), "`1e999`"),
        ("v 1 1 1 0\n", "QRT0326", Some(1), "infinity"),
        ("v 1 1\n", "QRT0325", Some(1), "not 2"),
        ("v 1 1 1 1 1\n", "QRT0325", Some(1), "not 5"),
        ("v 1 1 1 1 1 1 1 1\n", "QRT0325", Some(1), "not 8"),
        ("v 1 1 x\n", "QRT0325", Some(1), "`x` is not a number"),
        ("v 1,5 1 1\n", "QRT0325", Some(1), "`1,5`"),
        ("f 1 2\n", "QRT0327", Some(4), "a face of 2 corners"),
        ("f 1\n", "QRT0327", Some(4), "a face of 1 corner"),
        ("f\n", "QRT0327", Some(4), "a face of 0 corners"),
        ("f 1 2 # 3\n", "QRT0327", Some(4), "a face of 2 corners"),
        (
            "f 1 2 4\n",
            "QRT0329",
            Some(4),
            "no vertex 4: the file has 3",
        ),
        (
            "f 1 2 -4\n",
            "QRT0329",
            Some(4),
            "no vertex -4: 3 stand before it",
        ),
        ("f 1 2 0\n", "QRT0328", Some(4), "no vertex 0"),
        (
            "f 1 2 99999999999999999999\n",
            "QRT0328",
            Some(4),
            "not a corner",
        ),
        (
            "f 1 2 9223372036854775807\n",
            "QRT0329",
            Some(4),
            "no vertex",
        ),
        (
            "f 1 2 -9223372036854775808\n",
            "QRT0329",
            Some(4),
            "no vertex",
        ),
        ("f 1 2 3.0\n", "QRT0328", Some(4), "`3.0` is not a corner"),
        ("f 1 2 /3\n", "QRT0328", Some(4), "`/3` is not a corner"),
        ("f 1 2 3/1\n", "QRT0329", Some(4), "no texture coordinate 1"),
        ("f 1 2 3//-1\n", "QRT0329", Some(4), "no normal -1"),
        ("f 1 2 3/1/1/1\n", "QRT0328", Some(4), "not a corner"),
        ("f 1 2 2\n", "QRT0343", Some(4), "no area"),
        ("v 2 0 0\nf 1 2 4\n", "QRT0343", Some(5), "no area"),
        (
            "v 2 0 0\nv 3 0 0\nf 1 2 4 5\n",
            "QRT0343",
            Some(6),
            "no area",
        ),
        ("v 1 1 0\nf 1 2 3 4\n", "QRT0343", Some(5), "no area"),
        ("v 3 2 0\nf 1 4 2 3\n", "QRT0330", Some(5), "crosses itself"),
        ("v 1e300 0 0\nf 1 3 4\n", "QRT0326", Some(5), "too large"),
        ("usemtl a\n", "QRT0331", None, "no faces"),
        ("l 1 2\n", "QRT0331", None, "no faces"),
        ("f 1 2 \\", "QRT0332", Some(4), "is the file whole?"),
        ("usem a\n", "QRT0323", Some(4), "did you mean `usemtl`?"),
        ("<html>\n", "QRT0323", Some(4), "no OBJ statement"),
        ("f 1 2 \0\n", "QRT0322", Some(4), "not a text file"),
    ];
    for (text, code, line, words) in cases {
        let own = text.starts_with('v') && line.is_some_and(|line| line < 3);
        let text = if own {
            text.to_owned()
        } else {
            format!("{v3}{text}")
        };
        refused(read(&text), code, line, words);
    }
    refused(read(""), "QRT0331", None, "no faces");
    refused(read("\n# nothing\n"), "QRT0331", None, "no faces");
}

#[test]
fn faulty_materials_are_refused_at_their_line() {
    let with = |mtl: &str| read_with(TWO, &[("my colours.mtl", mtl)]);
    let lamp = "newmtl lamp\nKe 1 1 1\n";
    let red = |rest: &str| with(&format!("{lamp}newmtl dark red\n{rest}"));
    refused(with(lamp), "QRT0335", Some(5), "no material `dark red`");
    refused(
        with("newmtl dark rad\nKd 1 1 1"),
        "QRT0335",
        Some(5),
        "did you mean `dark rad`?",
    );
    refused(
        red("Kd 1.5 0 0"),
        "QRT0338",
        Some(4),
        "1.5, which is not in [0, 1]",
    );
    refused(red("Kd 0 -0.1 0"), "QRT0338", Some(4), "-0.1");
    refused(red("Ke 0 0 -1"), "QRT0339", Some(4), "is -1, which");
    refused(red("Ke 0 0 inf"), "QRT0337", Some(4), "not a finite number");
    refused(red("Kd 1 1"), "QRT0337", Some(4), "not 2");
    refused(red("Kd"), "QRT0337", Some(4), "not 0");
    refused(red("Kd 1 1 1 1"), "QRT0337", Some(4), "not 4");
    refused(red("Kd a b c"), "QRT0337", Some(4), "`a` is not a number");
    refused(red("Kd xyz 1 1 1"), "QRT0337", Some(4), "linear RGB");
    refused(red("map_Kd wood.png"), "QRT0342", Some(4), "no textures");
    refused(red("Ns 10"), "QRT0341", Some(3), "neither");
    refused(
        red("Kd 1 1 1\nnewmtl lamp\nKd 1 1 1"),
        "QRT0340",
        Some(5),
        "line 1",
    );
    refused(red("Kd 1 1 1\nd 2"), "QRT0337", Some(5), "not in [0, 1]");
    refused(
        red("Kd 1 1 1\nillum 11"),
        "QRT0337",
        Some(5),
        "not in [0, 10]",
    );
    refused(
        red("Kd 1 1 1\nillum 2.5"),
        "QRT0337",
        Some(5),
        "whole number",
    );
    refused(red("Kd 1 1 1\nNs -1"), "QRT0337", Some(5), "negative");
    refused(
        red("Kd 1 1 1\nPr 1 1"),
        "QRT0337",
        Some(5),
        "1 number, not 2",
    );
    refused(
        red("illum 9\nd 0\nNi 0"),
        "QRT0337",
        Some(3),
        "not in [0.001, 1000]",
    );
    refused(red("illum 5\nKs 1 2 1"), "QRT0338", Some(3), "`Ks` is 2");
    refused(red("Pm 1\nKs 1 1 1"), "QRT0341", Some(3), "neither");
    refused(
        with("Kd 1 1 1\n"),
        "QRT0337",
        Some(1),
        "before any `newmtl`",
    );
    refused(with("newmtl\n"), "QRT0337", Some(1), "without a name");
    let v3 = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let file = ("a.mtl", "newmtl a\nKd 1 1 1\n");
    let with = |text: &str| read_with(&format!("{v3}{text}"), &[file]);
    refused(
        with("mtllib b.mtl\nf 1 2 3\n"),
        "QRT0336",
        Some(5),
        "no material",
    );
    refused(
        with("mtllib b.mtl\nusemtl a\nf 1 2 3\n"),
        "QRT0334",
        Some(4),
        "b.mtl",
    );
    refused(
        with("usemtl a\nf 1 2 3\n"),
        "QRT0333",
        Some(4),
        "`mtllib` statement is missing",
    );
    refused(
        with("mtllib\nusemtl a\nf 1 2 3\n"),
        "QRT0333",
        Some(4),
        "without a name",
    );
    refused(
        with("mtllib a.mtl\nusemtl\nf 1 2 3\n"),
        "QRT0335",
        Some(5),
        "without a name",
    );
}

#[test]
fn files_are_looked_up_beside_the_mesh() {
    let dir = std::env::temp_dir().join(format!("qrt-obj-{}", std::process::id()));
    std::fs::create_dir_all(dir.join("deep")).unwrap();
    let obj = dir.join("deep/mesh.obj");
    let text = |library: &str| TWO.replace("my colours.mtl", library);
    std::fs::write(&obj, text("../colours.mtl")).unwrap();
    std::fs::write(dir.join("colours.mtl"), COLOURS).unwrap();
    refused(load(&obj, Wanted::USUAL), "QRT0319", Some(4), "is outside");
    std::fs::write(&obj, text("more/colours.mtl")).unwrap();
    refused(
        load(&obj, Wanted::USUAL),
        "QRT0334",
        Some(4),
        "there is no such file",
    );
    std::fs::create_dir(dir.join("deep/more")).unwrap();
    std::fs::write(dir.join("deep/more/colours.mtl"), COLOURS).unwrap();
    assert_eq!(
        load(&obj, Wanted::USUAL).unwrap().materials[1].label,
        "more/colours.mtl:lamp"
    );
    refused(
        load(&dir, Wanted::default()),
        "QRT0320",
        None,
        "not a regular file",
    );
    refused(
        load(&dir.join("none.obj"), Wanted::default()),
        "QRT0320",
        None,
        "there is no such file",
    );
    // Bytes that are not UTF-8 do no harm in a comment, or in a name that is not wanted.
    let latin = b"# caf\xe9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl caf\xe9\nf 1 2 3\n";
    std::fs::write(&obj, latin).unwrap();
    assert_eq!(load(&obj, Wanted::default()).unwrap().faces.len(), 1);
    refused(load(&obj, Wanted::USUAL), "QRT0322", Some(5), "not UTF-8");
    std::fs::remove_dir_all(&dir).unwrap();
}

#[cfg(unix)]
#[test]
fn an_endless_file_is_refused() {
    refused(
        load(Path::new("/dev/zero"), Wanted::default()),
        "QRT0320",
        None,
        "not a regular file",
    );
}

#[cfg(unix)]
#[test]
fn a_pipe_is_refused_at_once() {
    let dir = std::env::temp_dir().join(format!("qrt-pipe-{}", std::process::id()));
    std::fs::create_dir_all(&dir).unwrap();
    let pipe = dir.join("pipe");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.unwrap().success());
    refused(
        load(&pipe, Wanted::default()),
        "QRT0320",
        None,
        "not a regular file",
    );
    let report = crate::front::load(&pipe, &[]).unwrap_err();
    assert!(
        report.to_string().contains("not a regular file"),
        "{report}"
    );
    std::fs::remove_dir_all(&dir).unwrap();
}

#[test]
fn entries_that_name_one_file_share_its_mesh() {
    let entry = "{ mesh: { obj: two.obj, material: a } }, { mesh: { obj: two.obj } }";
    let text = format!(
        "{{ name: a, film: {{ width: 1, height: 1 }}, \
         materials: {{ a: {{ lambertian: {{ albedo: [1, 1, 1] }} }} }}, \
         camera: {{ perspective: {{ eye: [0, 0, 1], target: [0, 0, 0], vfov: 40 }} }}, \
         geometry: [{}] }}",
        vec![entry; 2500].join(", ")
    );
    let scene = Scene::from_yaml(&text, "two.yaml").unwrap();
    let obj = format!("{TWO}f 1 2 # a fault\n");
    for (obj, is_right) in [(TWO, true), (&obj, false)] {
        let held: &[(&str, &[u8])] = &[
            ("two.obj", obj.as_bytes()),
            ("my colours.mtl", COLOURS.as_bytes()),
        ];
        let meshes = load_all(&scene, Files::held(held));
        let of = |index: usize| match &scene.geometry[index] {
            Geometry::Mesh(mesh) => meshes.get(mesh),
            other => panic!("{other:?}"),
        };
        if is_right {
            for index in 0..5000 {
                assert!(std::ptr::eq(of(index).unwrap(), of(index % 2).unwrap()));
            }
            assert_eq!(
                [0, 1].map(|index| of(index).unwrap().materials.len()),
                [0, 2]
            );
            let valid = crate::valid::validate(scene.clone(), &meshes).unwrap();
            assert_eq!(valid.polygons().len(), 5000 * 2);
            assert_eq!(
                valid.files(),
                ["my colours.mtl", "two.obj"].map(PathBuf::from)
            );
        } else {
            let problems = crate::valid::validate(scene.clone(), &meshes).unwrap_err();
            assert_eq!(problems.len(), 5000);
            assert_eq!(problems[4999].description().label, "two.obj:11");
        }
    }
    // The file was not read, and validation does not read it.
    let problems = crate::valid::validate(scene, &Meshes::default()).unwrap_err();
    assert_eq!(problems.len(), 5000);
    assert_eq!(problems[0].code(), codes::OBJ_UNREADABLE);
}

/// A text with some of its bytes or lines changed, lost or doubled.
fn mutated(text: &'static str) -> impl Strategy<Value = Vec<u8>> {
    let piece = prop::sample::select(vec![
        " ",
        "\n",
        "\\\n",
        "\\",
        "#",
        "/",
        "-",
        "0",
        "1",
        "9999999999",
        "-1",
        "nan",
        "1e308",
        "f",
        "v",
        "vt",
        "l",
        "p",
        "usemtl ",
        "mtllib ",
        "newmtl ",
        "Kd ",
        "Ke",
        "\0",
        "\u{e9}",
        "\t",
        "v 0 0 0 0\n",
        "f 1 2 3 4 1\n",
        "f -1 -2 -3\n",
        "o\n",
        "g  \n",
        "usemtl\n",
        "Kd 1\n",
        "v 1e200 -1e200 1e-200\n",
        "Ka 1\n",
        "Ns\n",
        "illum\n",
        "d x\n",
        "illum 9\n",
        "illum 5\n",
        "illum 3\n",
        "Ks 0.5\n",
        "Ns 300\n",
        "Pm 1\n",
        "Pr 0.3\n",
        "Ni 2\n",
        "d 0\n",
        "# Blender\n",
    ]);
    let edit = (0.0..1.0_f64, 0..4_u8, piece, any::<u8>());
    prop::collection::vec(edit, 0..6).prop_map(move |edits| {
        let mut bytes = text.as_bytes().to_vec();
        for (place, kind, piece, byte) in edits {
            let at = (place * bytes.len() as f64) as usize;
            match kind {
                0 => drop(bytes.splice(at..at, piece.bytes())),
                1 if at < bytes.len() => bytes[at] = byte,
                2 => bytes.truncate(bytes.len().max(8) - at % 8),
                _ => drop(bytes.drain(at..(at + 1 + usize::from(byte % 16)).min(bytes.len()))),
            }
        }
        bytes
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(3000) })]

    #[test]
    fn no_text_makes_it_panic(
        obj in prop_oneof![mutated(TWO), mutated(CUBE)],
        mtl in mutated(COLOURS),
        materials in any::<bool>(),
        normals in any::<bool>(),
    ) {
        let wants = Wanted {
            materials,
            normals,
            colours: false,
        };
        let mut library = |_: &Path| Ok(mtl.clone().into());
        match parse(Path::new("mesh.obj"), &obj, wants, Faces::default(), &mut library) {
            Ok(mesh) => {
                prop_assert!(!mesh.faces.is_empty());
                for face in &mesh.faces {
                    prop_assert!(face.vertices.iter().all(|v| v.is_finite()));
                    prop_assert_eq!(face.material.is_some(), wants.materials);
                    prop_assert!(face.material.is_none_or(|m| m < mesh.materials.len()));
                }
                let mut problems = Problems::default();
                for material in mesh.materials.iter().flat_map(|m| &m.material) {
                    // The checks of the scene refuse a radiance that is too large.
                    let radiance = match material {
                        Material::Emitter(lamp) => lamp.radiance,
                        _ => [0.0; 3],
                    };
                    if radiance.iter().all(|c| *c <= 1e30) {
                        material.check(&Place::ROOT, &mut problems);
                    }
                }
                prop_assert!(problems.count() == 0, "{:?}", mesh.materials);
            }
            // The reader behind the scan accepts everything that the scan passes on.
            Err(error) => prop_assert_ne!(error.what.description().code, "QRT0344", "{}", error),
        }
    }
}
