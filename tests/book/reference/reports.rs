//! Reports of real faults, one for each code.

use qrt::core::compile::BuildError;
use qrt::core::oracle::{MOST_FACES, NearestOracle, OracleError, Oracles, check_budget};
use qrt::lab::mitsuba;
use qrt::scene::front::{Files, Loaded, meshes, parse, parse_with};
use qrt::scene::meshes::Meshes;
use qrt::scene::valid::{bsdf, validate};
use qrt::scene::{Bsdf, Jacobian};
use qrt::syntax::{Problem, Report};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::LazyLock;

/// Returns, for each code, the shortest report that shows it.
pub(crate) fn all() -> &'static BTreeMap<String, String> {
    static ALL: LazyLock<BTreeMap<String, String>> = LazyLock::new(collected);
    &ALL
}

fn collected() -> BTreeMap<String, String> {
    let mut reports = BTreeMap::new();
    let mut keep = |code: String, text: String| {
        // Reports of scene files come before those of the compiler.
        let size = |text: &str| {
            (
                text.starts_with("error: ") || text.starts_with("error[E"),
                text.lines().count(),
                text.len(),
            )
        };
        let old = reports.entry(code).or_insert_with(|| text.clone());
        if size(&text) < size(old) {
            *old = text;
        }
    };
    // The compiler names programs from their package's folder on.
    for (package, folder, end) in [
        ("", "tests/bad_scenes", "txt"),
        ("tests/compile_fail", "ui", "stderr"),
    ] {
        let mut files: Vec<_> = fs::read_dir(Path::new(package).join(folder))
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|found| found == end))
            .collect();
        files.sort();
        for file in files {
            let text = fs::read_to_string(file).unwrap();
            let text = text
                .replace(&format!("{folder}/"), "")
                .replace("tests/bad_scenes", "scenes");
            for (code, report) in split(&text) {
                keep(code, report);
            }
        }
    }
    for text in elsewhere() {
        for (code, report) in split(&text) {
            keep(code, report);
        }
    }
    reports
}

/// Splits a text into its reports, each with its code.
fn split(text: &str) -> Vec<(String, String)> {
    let mut reports: Vec<String> = Vec::new();
    for line in text.lines() {
        if line.starts_with("error") || line.starts_with("warning") {
            reports.push(String::new());
        }
        if let Some(report) = reports.last_mut() {
            report.push_str(line.trim_end());
            report.push('\n');
        }
    }
    let coded = reports.into_iter().filter_map(|report| {
        let title = report.lines().next()?;
        let at = title.find("[QRT")?;
        let code = title.get(at + 1..at + 8)?.to_owned();
        // The last line of the text counts the errors.
        let (report, last) = report.trim_end().rsplit_once('\n')?;
        let counts = last.contains(": ") && (last.ends_with(" error") || last.ends_with(" errors"));
        let end = if counts { "" } else { last };
        Some((code, format!("{report}\n{end}").trim_end().to_owned()))
    });
    coded.collect()
}

/// Returns a scene with a wall in front of the camera, and more blocks.
fn wall(more: &str) -> Loaded {
    let text = format!(
        "\
name: wall
camera: {{ perspective: {{ eye: [0, 0, 1], target: [0, 0, 0], vfov: 45 }} }}
film: {{ width: 1, height: 1 }}
materials: {{ lit: {{ emitter: {{ radiance: [1, 1, 1] }} }} }}
geometry: [quad: {{ vertices: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], material: lit }}]
{more}"
    );
    parse(&text, "wall.yaml", &[], "".as_ref()).unwrap()
}

/// Returns reports that no faulty scene file alone causes. QRT0344 has none: as far as known, the
/// checks before the OBJ library refuse everything that the library would refuse.
fn elsewhere() -> Vec<String> {
    let tell = |loaded: &Loaded, problems| loaded.report(problems).render(false);
    let mut texts = Vec::new();

    let tight = wall("budget: { qubits: 100, toffoli: 1000 }");
    let costs = Oracles::new(&tight.valid).costs().unwrap();
    let over = check_budget(&tight.valid, &costs).unwrap_err();
    texts.push(tell(&tight, over));

    let fine = wall("precision: { fraction: 30 }");
    for error in [
        OracleError::Build(BuildError::TooWide {
            what: "a number of the scene",
            bits: 70,
            fraction: 30,
            value: None,
        }),
        OracleError::Build(BuildError::UnboundedQuotient),
        OracleError::Build(BuildError::UnboundedFunction),
        OracleError::TooManyFaces {
            faces: MOST_FACES + 1,
        },
    ] {
        texts.push(tell(&fine, vec![error.problem()]));
    }

    let ground = "\
name: ground
camera: { perspective: { eye: [0, 1, 4], target: [0, 0.1, 0], vfov: 45 } }
film: { width: 1, height: 1 }
sky: { radiance: 1 }
materials: { white: { lambertian: { albedo: 0.5 } } }
geometry:
  - sphere: { center: [0, -1000, 0], radius: 1000, material: white }
  - sphere: { center: [0, 0.1, 0], radius: 0.1, material: white }
";
    let ground = parse(ground, "ground.yaml", &[], "".as_ref()).unwrap();
    let small = Oracles::new(&ground.valid).costs().unwrap_err();
    let searched = NearestOracle::new(&ground.valid).unwrap_err();
    texts.push(tell(&ground, vec![small.problem()]));
    texts.push(tell(&ground, vec![searched.problem()]));

    let shiny = wall("").source.text.replace(
        "emitter: { radiance: [1, 1, 1] }",
        "phong: { diffuse: [0, 0, 0], specular: [0.5, 0.5, 0.5], exponent: 9 }",
    );
    let shiny = parse(&shiny, "wall.yaml", &[], "".as_ref()).unwrap();
    let refused = mitsuba::export(&shiny.valid, "wall").unwrap_err();
    texts.push(tell(&shiny, vec![refused.problem()]));

    let nothing = "\
name: cellar
camera: { perspective: { eye: [0, 0, 1], target: [0, 0, 0], vfov: 45 } }
film: { width: 1, height: 1 }
materials: { grey: { lambertian: { albedo: [0.5, 0.5, 0.5] } } }
geometry: [quad: { vertices: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], material: grey }]
sampling: { depths: [{ bits: [8, 8] }, { bits: [8, 8], light: [8, 8] }] }
";
    let dark = parse(nothing, "cellar.yaml", &[], "".as_ref()).unwrap();
    texts.extend(dark.warnings().map(|report| report.render(false)));

    let back_to_back = wall("").source.text.replace(
        "material: lit }]",
        "material: lit },\n  quad: { vertices: [[0, 0, 0], [0, 1, 0], [1, 1, 0], [1, 0, 0]], material: lit }]",
    );
    let back_to_back = back_to_back.replace(
        "lit: {",
        "spare: { mirror: { reflectance: [1, 1, 1] } }, lit: {",
    );
    let warned = parse(&back_to_back, "wall.yaml", &[], "".as_ref()).unwrap();
    texts.extend(warned.warnings().map(|report| report.render(false)));

    let whole =
        |problem: Problem| Report::of_file("a scene made in Rust", problem.what).render(false);
    let mut scene = fine.valid.scene().clone();
    scene.materials.push(scene.materials[0].clone());
    let problems = validate(scene, &Meshes::default()).unwrap_err();
    texts.extend(problems.into_iter().map(whole));

    let grey = Bsdf {
        map: ["u".into(), "v".into(), "1".into()],
        jacobian: Jacobian::Auto,
        value: vec!["0.1".into(), "0.2".into()],
        pdf: None,
    };
    let problems = bsdf::compile(&grey, &bsdf::Faces::NONE).unwrap_err();
    texts.extend(problems.into_iter().map(whole));

    // The file is sparse: it takes no disk space, and no time until it is read.
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("book_reference");
    fs::create_dir_all(&folder).unwrap();
    let file = fs::File::create(folder.join("large.obj")).unwrap();
    file.set_len(meshes::MAX_BYTES + 1).unwrap();
    let large = "\
name: large
camera: { perspective: { eye: [0, 0, 1], target: [0, 0, 0], vfov: 45 } }
film: { width: 1, height: 1 }
materials: { grey: { lambertian: { albedo: [0.5, 0.5, 0.5] } } }
geometry: [mesh: { obj: large.obj, material: grey }]
";
    let report = parse(large, "large.yaml", &[], &folder).unwrap_err();
    texts.push(report.render(false));
    fs::write(
        folder.join("large.obj"),
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    )
    .unwrap();
    let entry = "mesh: { obj: large.obj, material: grey }";
    let often = large.replace(entry, &vec![format!("{{ {entry} }}"); 4].join(", "));
    let files = Files::of_folder(&folder).most_faces(3);
    let report = parse_with(&often, "large.yaml", &[], files).unwrap_err();
    texts.push(report.render(false));
    fs::remove_dir_all(folder).unwrap();
    texts
}
