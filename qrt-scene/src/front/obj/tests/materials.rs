//! MTL statements as materials, and the parts of files that have no place in a picture.

use super::*;
use crate::scene::{Dielectric, Ggx, Mirror, Phong};

const FACE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nmtllib a.mtl\nusemtl m\nf 1 2 3\n";

/// The material `m` with these statements, and the keywords without a counterpart.
#[track_caller]
fn material(head: &str, statements: &str) -> (Material, String) {
    let mtl = format!("{head}\nnewmtl m\n{}\n", statements.replace("; ", "\n"));
    let mesh = read_with(FACE, &[("a.mtl", &mtl)]).unwrap();
    let [material] = &mesh.materials[..] else {
        panic!("{:?}", mesh.materials);
    };
    let left_out: Vec<&str> = material.left_out.iter().map(String::as_str).collect();
    (material.material.clone().unwrap(), left_out.join(" "))
}

fn matte(grey: f64) -> Material {
    Lambertian {
        albedo: [grey; 3].into(),
    }
    .into()
}

fn glass(ior: f64) -> Material {
    Dielectric::clear(ior).into()
}

fn mirror(grey: f64) -> Material {
    let reflectance = [grey; 3];
    Mirror {
        reflectance: reflectance.into(),
    }
    .into()
}

fn rough(alpha: f64, grey: f64) -> Material {
    let reflectance = [grey; 3];
    Ggx {
        alpha,
        reflectance: reflectance.into(),
    }
    .into()
}

#[test]
fn materials_of_blender_are_what_they_were_there() {
    const HEAD: &str = "# Blender 4.2.0 MTL File: 'room.blend'\n# www.blender.org\n";
    // `Pr`, `Pm`, `Ps`, `Pc`, `Pcr`, `aniso`, `anisor` and `Tf` belong to the exporter's option "PBR
    // Extensions". Ns is 1000 (1 - roughness)^2, and Ks the specular level.
    for (statements, expected, left_out) in [
        (
            "Ns 250; Ka 1 1 1; Kd 0.8 0.8 0.8; Ks 0.5 0.5 0.5; Ke 0 0 0; Ni 1.45; d 1; illum 2",
            matte(0.8),
            "Ks",
        ),
        (
            "Ns 250; Ka 1 1 1; Kd 0.8 0.8 0.8; Ks 0 0 0; Ke 0 0 0; Ni 1.45; d 1; illum 1",
            matte(0.8),
            "",
        ),
        (
            "Ns 1000; Ka 1 1 1; Kd 0.9 0.9 0.9; Ks 0.5 0.5 0.5; Ke 0 0 0; Ni 1.45; d 1; illum 3",
            mirror(0.9),
            "",
        ),
        (
            "Ns 250; Ka 1 1 1; Kd 0.2 0.2 0.2; Ks 0.5 0.5 0.5; Ke 0 0 0; Ni 1.45; d 1; illum 3",
            rough(0.25, 0.2),
            "",
        ),
        (
            "Ns 250; Ka 0.25 0.25 0.25; Kd 0.8 0.8 0.8; Ks 0.5 0.5 0.5; Ni 1.45; d 1; illum 3",
            matte(0.8),
            "Ks Pm",
        ),
        (
            "Ns 1000; Ka 1 1 1; Kd 0.8 0.8 0.8; Ks 0.5 0.5 0.5; Ke 0 0 0; Ni 1.33; d 0; illum 9",
            glass(1.33),
            "",
        ),
        (
            "Ns 1000; Ka 1 1 1; Kd 0.8 0.8 0.8; Ks 0.5 0.5 0.5; Ni 1.45; d 0.9; illum 9",
            matte(0.8),
            "Ks d",
        ),
        (
            "Kd 0.8 0.8 0.8; Ks 0.5 0.5 0.5; Ni 1.5; d 1; illum 2; Pr 0; Pm 0; Ps 0; Pc 0; \
             Pcr 0.03; aniso 0; anisor 0; Tf 1 1 1",
            glass(1.5),
            "",
        ),
        (
            "Kd 0.8 0.8 0.8; Ks 0.5 0.5 0.5; d 1; illum 3; Pr 0.5; Pm 1; Ps 0; Pc 0; aniso 0",
            rough(0.25, 0.8),
            "",
        ),
        (
            "Ns 250; Ka 1 1 1; Kd 0.8 0.8 0.8; Ks 0.5 0.5 0.5; Ke 5 5 5; Ni 1.45; d 1; illum 2",
            Emitter {
                radiance: [5.0; 3],
                albedo: [0.8; 3].into(),
            }
            .into(),
            "",
        ),
    ] {
        let found = material(HEAD, statements);
        assert_eq!(found, (expected, left_out.to_owned()), "{statements}");
    }
}

#[test]
fn materials_of_others_are_what_their_statements_mean() {
    let phong = |diffuse: f64, specular: f64, exponent: f64| {
        Material::from(Phong {
            diffuse: [diffuse; 3],
            specular: [specular; 3],
            exponent,
        })
    };
    for (statements, expected, left_out) in [
        ("Kd 0.5", matte(0.5), ""),
        ("Kd 0.5; Ks 0.25; Ns 20", phong(0.5, 0.25, 20.0), ""),
        ("Kd 0.5; Ks 0.5; Ns 20; illum 2", phong(0.5, 0.5, 20.0), ""),
        ("Ks 0.5; Ns 20", phong(0.0, 0.5, 20.0), ""),
        // No highlight is meant, or one that would reflect more than arrives.
        ("Kd 0.5; Ks 0.25; Ns 20; illum 1", matte(0.5), "Ks"),
        ("Kd 0.5; Ks 0.75; Ns 20; illum 2", matte(0.5), "Ks"),
        ("Kd 0.5; Ks -0.1; Ns 20", matte(0.5), "Ks"),
        ("Kd 0.5; Ks 0.25; illum 2", matte(0.5), "Ks"),
        ("Kd 0.5; Ks 0.25; Ns 2e6", matte(0.5), "Ks"),
        ("Kd 0.5; Ks xyz 1 1 1; Ns 20", matte(0.5), "Ks"),
        ("Kd 0; Ks 0.9; Ns 20; illum 3", mirror(0.9), ""),
        ("Kd 0.01; Ks 0.9; illum 5", mirror(0.9), "Kd"),
        ("Ks 0.9; illum 8", mirror(0.9), ""),
        ("Kd 0.6; Ks 0.1; Ns 9; illum 5", phong(0.6, 0.1, 9.0), ""),
        ("Kd 0.5; Ks 0.9; illum 3; Pr 0.5", rough(0.25, 0.9), "Kd"),
        ("Kd 0.5; Pm 0.75; Pr 0.05", mirror(0.5), "Pm"),
        ("Kd 0.5; Pm 0.25", matte(0.5), "Pm"),
        ("illum 4", glass(1.5), ""),
        ("illum 9; Ni 1.8", glass(1.8), ""),
        ("illum 7; Ni 1.3; d 1; Tf 1; Kd 0", glass(1.3), ""),
        ("illum 6; Kd 0.1 0.2 0.3; Tf 1 1 0.5", glass(1.5), "Kd Tf"),
        ("Kd 0.5; illum 4; d 1", matte(0.5), ""),
        ("Kd 0.5; d 0.25; Ni 1.4; Pr 0.5", glass(1.4), "Pr d"),
        ("Kd 0.5; Tr 0.75; Ni 1.4", glass(1.4), "Tr"),
        ("Kd 0.5; Tr 1; Ni 1.4", glass(1.4), ""),
        ("Kd 0.5; d 0.75", matte(0.5), "d"),
        // 3ds Max writes both, and a filter for all.
        (
            "Kd 0.5; d 1; Tr 0; Tf 1 1 1; illum 2; Ni 1.5",
            matte(0.5),
            "",
        ),
        ("Kd 0.5; d 1; Tr 1", matte(0.5), ""),
        ("Kd 0.5; Ni 0; Ns 0", matte(0.5), ""),
        ("Kd 0.5; d -halo 0.5", matte(0.5), "d -halo"),
        (
            "Kd 0.5; Pc 0.2; aniso 0; bump a.png; shadow",
            matte(0.5),
            "Pc bump shadow",
        ),
        (
            "Ka 1; Kd 0.2; Kd 0.5; map_Ka a.png; sharpness 60",
            matte(0.5),
            "",
        ),
    ] {
        let found = material("# a library", statements);
        assert_eq!(found, (expected, left_out.to_owned()), "{statements}");
    }
}

/// Reads a scene of the mesh `obj` and the library `a.mtl`, with `materials` of its own.
fn scene(
    obj: &str,
    mtl: Option<&str>,
    materials: &str,
) -> Result<crate::front::Loaded, qrt_syntax::Report> {
    let text = format!(
        "{{ name: a, film: {{ width: 1, height: 1 }}, materials: {{ {materials} }}, \
         camera: {{ perspective: {{ eye: [0, 0, 1], target: [0, 0, 0], vfov: 40 }} }}, \
         geometry: [mesh: {{ obj: m.obj }}] }}"
    );
    let mut held: Vec<(&str, &[u8])> = vec![("m.obj", obj.as_bytes())];
    held.extend(mtl.map(|mtl| ("a.mtl", mtl.as_bytes())));
    crate::front::parse_with(&text, "a.yaml", &[], Files::held(&held))
}

#[test]
fn a_material_of_the_scene_replaces_that_of_the_file() {
    let own = "m: { emitter: { radiance: [1, 2, 3] } }";
    for mtl in [
        Some("newmtl m\nKd 0.5\n"),
        Some("newmtl m\nmap_Kd wood.png\n"),
        Some("newmtl m # of wood\nKd 7\n"),
        Some("newmtl other\nKd 1\n"),
        Some("newmtl\n"),
        None,
    ] {
        let valid = scene(FACE, mtl, own).unwrap().valid;
        let surface = &valid.surfaces()[valid.polygons()[0].surface as usize];
        assert_eq!((&*surface.name, surface.radiance), ("m", [1.0, 2.0, 3.0]));
        assert_eq!(valid.warnings(), [], "{mtl:?}");
    }
    for (mtl, code, line) in [
        (Some("newmtl m\n\nmap_Kd wood.png\n"), "QRT0342", "a.mtl:3"),
        (Some("newmtl m # of wood\nKd 7\n"), "QRT0338", "a.mtl:2"),
        (Some("newmtl other\nKd 1\n"), "QRT0335", "m.obj:5"),
        (None, "QRT0334", "m.obj:4"),
    ] {
        let report = scene(FACE, mtl, "").unwrap_err();
        assert_eq!(report.codes(), [code]);
        assert!(report.to_string().contains(line), "{report}");
    }
    let report = scene(FACE, Some("newmtl m\nmap_Kd wood.png\n"), "").unwrap_err();
    let help = "name a material of the scene `m`, which replaces this one";
    assert!(report.to_string().contains(help), "{report}");
}

#[test]
fn materials_that_no_face_uses_are_not_judged() {
    let faulty = "newmtl a\nKd 2\nnewmtl b\nmap_Kd b.png\nnewmtl c\nillum 9\nNi 0\nnewmtl d\n\
                  newmtl a\nKd 1\nnewmtl m\nKe 1\n";
    let uses = FACE.replace("usemtl m", "usemtl none\nusemtl a\nusemtl b\nusemtl m");
    let loaded = scene(&uses, Some(faulty), "").unwrap();
    assert_eq!(loaded.valid.surfaces().len(), 1);
    // A face without area uses nothing, and a library that no face needs may be missing.
    let flat = format!("{FACE}usemtl a\nf 1 2 2\nmtllib b.mtl\n");
    let codes = scene(&flat, Some(faulty), "")
        .unwrap()
        .warnings()
        .unwrap()
        .codes();
    assert_eq!(codes, ["QRT0343", "QRT0334"]);
}

#[test]
fn what_a_material_leaves_out_is_named_once() {
    let obj = format!("{FACE}v 0 0 1\nusemtl n\nf 1 2 4\nusemtl o\nf 1 3 4\nusemtl m\nf 2 3 4\n");
    let mtl = "newmtl m\nKd 0.5\nKs 0.9\nnewmtl n\nKd 0.5\nbump a\nnewmtl o\nKe 1\n";
    let loaded = scene(&obj, Some(mtl), "").unwrap();
    let shown = loaded.warnings().unwrap();
    assert_eq!(shown.codes(), ["QRT0346"]);
    let shown = shown.to_string();
    assert!(
        shown.contains("`Ks` and `bump` of `m` and 1 other have no counterpart"),
        "{shown}"
    );
    assert!(shown.contains("a.mtl:1"), "{shown}");
    // What the scene replaces is left out of the note.
    let own = "m: { lambertian: { albedo: [1, 1, 1] } }";
    let shown = scene(&obj, Some(mtl), own)
        .unwrap()
        .warnings()
        .unwrap()
        .to_string();
    assert!(
        shown.contains("`bump` of `n` has no counterpart"),
        "{shown}"
    );
}

#[test]
fn names_of_libraries_and_materials_are_read_as_others_read_them() {
    let light = ("my lib.mtl", "newmtl m\nKe 1\n");
    let sub = ("sub/a.mtl", "newmtl m\nKe 1\n");
    let plain = ("a.mtl", "newmtl m\nKe 1\n");
    let hash = ("a #1.mtl", "newmtl m #1\nKe 1\nnewmtl m #2\nKd 1\n");
    for (statement, file) in [
        ("mtllib a.mtl # note", plain),
        ("mtllib a.mtl\t# note", plain),
        ("mtllib \"a.mtl\"", plain),
        ("mtllib ./a.mtl", plain),
        ("mtllib .\\a.mtl", plain),
        ("mtllib '.\\a.mtl' # note", plain),
        ("mtllib none.mtl a.mtl # note", plain),
        ("mtllib my lib.mtl", light),
        ("mtllib my lib.mtl # note", light),
        ("mtllib \"my lib.mtl\" # note", light),
        ("mtllib sub\\a.mtl", sub),
        ("mtllib .\\sub\\a.mtl # note", sub),
        ("mtllib a #1.mtl", hash),
    ] {
        let uses = if file == hash { "m #1" } else { "m" };
        let obj = FACE.replace("mtllib a.mtl", statement);
        let mesh = read_with(&obj.replace("usemtl m", &format!("usemtl {uses}")), &[file]);
        let mesh = judged(mesh).unwrap_or_else(|error| panic!("{statement}: {error}"));
        let emits = matches!(mesh.materials[0].material, Ok(Material::Emitter(_)));
        assert!(emits, "{statement}: {mesh:?}");
        assert_eq!(mesh.files[1], Path::new("dir").join(file.0), "{statement}");
    }
    for uses in ["m", "m # note", "\"m\"", "m\t#"] {
        for name in ["m", "m # of glass", "\"m\""] {
            let mtl = format!("newmtl {name}\nKe 1\n");
            let obj = FACE.replace("usemtl m", &format!("usemtl {uses}"));
            let mesh = judged(read_with(&obj, &[("a.mtl", &mtl)])).unwrap();
            assert_eq!(mesh.materials[0].name, "m", "{uses} {name}");
        }
    }
}

#[test]
fn a_mesh_cannot_make_the_reader_look_up_any_number_of_names() {
    let names: Vec<String> = (0..1000).map(|number| format!("{number}.mtl")).collect();
    for statements in [
        format!("mtllib {}", names.join(" ")),
        format!("mtllib {}", names.join("\nmtllib ")),
        format!(
            "mtllib {}\nmtllib {}",
            names[..200].join(" "),
            names[200..].join(" ")
        ),
    ] {
        let mut count = 0;
        let mut library = |file: &Path| {
            count += 1;
            let (file, is_library) = (file.to_owned(), true);
            Err(MeshFile::Missing { file, is_library })
        };
        let obj = FACE.replace("mtllib a.mtl", &statements);
        let path = Path::new("dir/mesh.obj");
        let read = parse(
            path,
            obj.as_bytes(),
            Wanted::USUAL,
            Faces::default(),
            &mut library,
        );
        assert!(judged(read).is_err());
        assert!(count < 1000, "{count} look-ups");
    }
}

#[test]
fn statements_without_a_part_in_the_picture_are_skipped() {
    let face = "v 0 0 0 1 0 0 1\nv 1 0 0 0.5 nan x\nv 0 1 0\n";
    for text in [
        "vn nan nan nan\nvt inf\nvn\nvt 1 2 3 4\nvn a b c\nf 1/1/1 2/2/2 3/1/3\n",
        "f 1 2 3\nl 1 2\np 1\n",
        "cstype bspline\ndeg 3\ncurv 0 1 1 2 3\nparm u 0 1\nend\nf 1 2 3\n",
    ] {
        let mesh = read(&format!("{face}{text}")).unwrap();
        assert_eq!(mesh.faces.len(), 1, "{text}");
        let codes: Vec<_> = mesh
            .notes
            .iter()
            .map(|note| note.what.description().code)
            .collect();
        let expected: &[&str] = if text.starts_with("vn") {
            &["QRT0354"]
        } else {
            &["QRT0324", "QRT0354"]
        };
        assert_eq!(codes, expected, "{text}");
    }
    let mesh = read(&format!(
        "{face}v 1 1 0\nf 1 2 3 3\nf 2 3 1\nf 2 2 3\nf 1 4 2\n"
    ))
    .unwrap();
    assert_eq!(mesh.faces.len(), 2);
    let notes: Vec<_> = mesh
        .notes
        .iter()
        .map(|note| (&*note.what, &note.place))
        .collect();
    assert_eq!(
        notes,
        [
            (&MeshFile::FlatLeftOut { count: 1 }, &FilePlace::Line(7)),
            (&MeshFile::CopiesLeftOut { count: 1 }, &FilePlace::Line(6)),
            (&MeshFile::ColoursUnused, &FilePlace::Line(1)),
        ]
    );
}
