//! Tests of untrusted scenes: the files that they may read, their resources, and that they cannot make
//! an undefined picture.

use crate::common::command::Folder;
use std::fmt::Write as _;
use std::fs;

/// A triangle.
const MESH: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// Returns a scene with `materials` and `geometry`, whose film is a pixel.
fn scene(materials: &str, geometry: &str) -> String {
    format!(
        "name: strange
camera: {{ perspective: {{ eye: [0, 0, 3], target: [0, 0, 0], vfov: 45 }} }}
film: {{ width: 1, height: 1 }}
materials: {{ lamp: {{ emitter: {{ radiance: [1, 1, 1] }} }}, {materials} }}
geometry: [{geometry}]
sampling: {{ path_bits: 4, depths: [{{ bits: [2, 2] }}, {{ bits: [2, 2] }}], lights: none }}
"
    )
}

fn mesh(obj: &str) -> String {
    scene("", &format!("{{ mesh: {{ obj: {obj}, material: lamp }} }}"))
}

#[test]
fn nothing_outside_its_folder_is_read() {
    let folder = Folder::new();
    fs::create_dir_all(folder.path("inside/more")).unwrap();
    let secret = "the secret of the house";
    for file in ["secret", "inside/own.obj", "inside/more/beside.obj"] {
        fs::write(folder.path(file), MESH).unwrap();
    }
    fs::write(folder.path("secret"), secret).unwrap();
    let run = |obj: &str, more: &[&str]| {
        fs::write(folder.path("inside/s.yaml"), mesh(obj)).unwrap();
        let own = ["render", "inside/s.yaml", "-o", "s.png", "--quiet"];
        folder.qrt(&[&own, more].concat())
    };
    let absolute = folder.path("secret").display().to_string();
    let mut outside = vec![
        "../secret".to_owned(),
        "more/../../secret".to_owned(),
        "../none".to_owned(),
        "/etc/passwd".to_owned(),
        "/dev/stdin".to_owned(),
        absolute,
    ];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("../secret", folder.path("inside/link.obj")).unwrap();
        outside.push("link.obj".to_owned());
    }
    for obj in outside {
        let output = run(&obj, &[]);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{obj}: {errors}");
        assert!(errors.contains("QRT0319"), "{obj}: {errors}");
        assert!(errors.contains("--allow-files"), "{obj}: {errors}");
        assert!(!errors.contains(secret), "{obj}: {errors}");
        assert!(!errors.contains("root:"), "{obj}: {errors}");
    }
    for obj in ["own.obj", "more/beside.obj", "more/../own.obj"] {
        assert_eq!(run(obj, &[]).status.code(), Some(0), "{obj}");
    }
    // With permission the file is read, and the error is about its content.
    let output = run("../secret", &["--allow-files", "."]);
    let errors = String::from_utf8(output.stderr).unwrap();
    assert!(errors.contains("QRT0323"), "{errors}");
    fs::write(folder.path("good.obj"), MESH).unwrap();
    let output = run("../good.obj", &["--allow-files", "."]);
    assert_eq!(output.status.code(), Some(0));
    // A material library follows the rules of any other file.
    let own = format!("mtllib ../secret\nusemtl a\n{MESH}");
    fs::write(folder.path("inside/own.obj"), own).unwrap();
    fs::write(
        folder.path("inside/s.yaml"),
        scene("", "{ mesh: { obj: own.obj } }"),
    )
    .unwrap();
    let errors = folder.fails(2, &["render", "inside/s.yaml"]);
    assert!(
        errors.contains("QRT0319") && !errors.contains(secret),
        "{errors}"
    );
}

/// Runs the command with at most 1 GB of address space; returns its exit code and errors.
#[cfg(unix)]
fn confined(folder: &Folder, arguments: &str) -> (Option<i32>, String) {
    let program = env!("CARGO_BIN_EXE_qrt");
    let output = std::process::Command::new("sh")
        .args([
            "-c",
            &format!("ulimit -v 1000000; exec {program} {arguments}"),
        ])
        .current_dir(folder.path(""))
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code(), errors)
}

#[cfg(unix)]
#[test]
fn bombs_are_refused_in_a_gigabyte() {
    let folder = Folder::new();
    let anchored = |levels: usize| {
        let mut text = String::new();
        for level in 0..levels {
            let _ = write!(text, "&a{level} [");
        }
        text += &"1, ".repeat(600_000);
        text + &"]".repeat(levels)
    };
    // A mesh of many triangles, placed many times.
    let mut many = String::from("v 0 0 0\nv 1 0 0\n");
    for n in 3..20_003 {
        let _ = writeln!(many, "v 0 {n} 0\nf 1 2 {n}");
    }
    fs::write(folder.path("many.obj"), many).unwrap();
    let copy = "&m { mesh: { obj: many.obj, material: lamp } }";
    // One polygon that is very many triangles.
    let mut fan = String::from("v 0 0 0\nv 1 0 0\nv 0 1 0\nf");
    fan += &" 1 2 3".repeat(5_000_000);
    fs::write(folder.path("fan.obj"), fan).unwrap();
    let alias = "&n a".to_owned() + &"a".repeat(1 << 20);
    for (name, text, code) in [
        ("nested", scene("", &anchored(60)), "QRT0122"),
        ("wide", scene("", &"1,".repeat((8 << 20) - 400)), "QRT0113"),
        ("wrong", scene("", &"a,".repeat(400_000)), "QRT0122"),
        (
            "copies",
            scene("", &format!("{copy}{}", ", *m".repeat(5000))),
            "QRT0308",
        ),
        ("fan", mesh("fan.obj"), "QRT0321"),
        (
            "texts",
            scene("", &format!("{alias}{}", ", *n".repeat(1000))),
            "QRT0111",
        ),
    ] {
        let file = format!("{name}.yaml");
        fs::write(folder.path(&file), text).unwrap();
        let (status, errors) = confined(&folder, &format!("render {file} -o {name}.png"));
        let shown: String = errors.chars().take(2000).collect();
        assert_eq!(status, Some(2), "{name}: {shown}");
        assert!(
            errors.contains(&format!("error[{code}]")),
            "{name}: {shown}"
        );
    }
}

/// The circuit of a polygon of 12,000 corners looks up each triangle by its number.
#[cfg(unix)]
#[test]
fn circuits_of_many_faces_fit_in_a_gigabyte() {
    let folder = Folder::new();
    let mut polygon = String::new();
    for corner in 0..12_000 {
        let (sin, cos) = (f64::from(corner) * std::f64::consts::TAU / 12_000.0).sin_cos();
        let _ = writeln!(polygon, "v {cos} {sin} 0");
    }
    polygon += "f";
    for corner in 1..=12_000 {
        let _ = write!(polygon, " {corner}");
    }
    fs::write(folder.path("polygon.obj"), polygon).unwrap();
    fs::write(folder.path("s.yaml"), mesh("polygon.obj")).unwrap();
    let (status, errors) = confined(&folder, "render s.yaml --model fixed -o s.png");
    assert_eq!(status, Some(0), "{errors}");
}

#[test]
fn values_below_zero_are_refused_or_zero() {
    let folder = Folder::new();
    let shape = "{ quad: { vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], material: m } }, \
                 { quad: { vertices: [[-1, -1, 4], [-1, 1, 4], [1, 1, 4], [1, -1, 4]], material: lamp } }";
    let with = |value: &str| {
        let map = r#"["sqrt(u)*cos(2*pi*v)", "sqrt(u)*sin(2*pi*v)", "sqrt(1-u)"]"#;
        let material =
            format!(r#"m: {{ bsdf: {{ map: {map}, jacobian: auto, value: ["{value}"] }} }}"#);
        scene(&material, shape)
    };
    fs::write(folder.path("v.yaml"), with("-1e-12")).unwrap();
    let errors = folder.fails(2, &["render", "v.yaml"]);
    assert!(errors.contains("QRT0415"), "{errors}");
    fs::write(folder.path("v.yaml"), with("(u - 0.5)*1e-323")).unwrap();
    folder.works(&["render", "v.yaml", "--counts", "v.csv"]);
    let counts = String::from_utf8(folder.read("v.csv")).unwrap();
    assert!(!counts.contains(",-"), "{counts}");
}

/// A channel without light, and a colour that exceeds no threshold, are counted as the paper's edges say.
#[test]
fn verify_holds_where_a_channel_is_dark() {
    let folder = Folder::new();
    let shape =
        "{ quad: { vertices: [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], material: lamp } }";
    let text = scene("", shape).replace("[1, 1, 1]", "[2, 1, 0]");
    fs::write(folder.path("s.yaml"), text).unwrap();
    for at in ["edges", "midpoints"] {
        for bits in ["4", "20"] {
            folder.works(&[
                "verify",
                "s.yaml",
                "--set",
                &format!("comparator={{ at: {at}, bits: {bits} }}"),
            ]);
        }
    }
}

/// Saturated bounds are negated, too.
#[test]
fn numbers_at_the_end_of_what_there_is_are_refused() {
    let text = r"
name: far
camera: { perspective: { eye: [0, 0, 1e10], target: [1e30, 1e15, -1], vfov: 179.999999 } }
film: { width: 3, height: 2 }
materials: { lamp: { emitter: { radiance: [1, 1, 1] } }, m: { lambertian: { albedo: [0.7, 0.6, 0.5] } } }
geometry:
  - quad: { vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], material: m }
  - quad: { vertices: [[-1, 1, 1e6], [1, 1, 1e6], [1, -1, 1e6], [-1, -1, 1e6]], material: lamp }
precision: { fraction: 30 }
sampling: { path_bits: 4, depths: [{ bits: [2, 2] }, { bits: [2, 2] }], lights: none }
";
    let folder = Folder::with("far.yaml", text);
    let errors = folder.fails(2, &["inspect", "far.yaml"]);
    assert!(errors.contains("QRT0611"), "{errors}");
}

/// Files that a command reads beside a scene must be regular: it neither waits for a pipe nor reads a device
/// until memory ends.
#[cfg(unix)]
#[test]
fn parts_and_pictures_are_regular_files() {
    let shape =
        "{ quad: { vertices: [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], material: lamp } }";
    let folder = Folder::with("s.yaml", &scene("", shape));
    let made = std::process::Command::new("mkfifo")
        .args(["pipe", "pipe.png", "pipe.exr"])
        .current_dir(folder.path(""))
        .status();
    assert!(made.unwrap().success());
    fs::create_dir(folder.path("part")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", folder.path("part/trade.csv")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", folder.path("zero")).unwrap();
    for arguments in [
        &["merge", "pipe", "-o", "m.png"][..],
        &["merge", "zero", "-o", "m.png"],
        &["diff", "pipe.png", "pipe.png"],
        &["diff", "pipe.exr", "pipe.exr"],
        &["verify", "s.yaml", "--parts", "pipe"],
        &["trade", "s.yaml", "-o", "out", "--quick", "--parts", "part"],
    ] {
        let errors = folder.fails(1, arguments);
        assert!(errors.contains("it is no regular file"), "{errors}");
    }
}

/// An operand that no register can hold is reported at every width.
#[test]
fn a_function_of_an_overwide_number_is_refused() {
    let folder = Folder::new();
    let shape = "{ quad: { vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], material: m } }, \
                 { quad: { vertices: [[-1, -1, 4], [-1, 1, 4], [1, 1, 4], [1, -1, 4]], material: lamp } }";
    let map = r#"["sqrt(u)*cos(2*pi*v)", "sqrt(u)*sin(2*pi*v)", "sqrt(1-u)"]"#;
    for factor in ["1e11", "1e13", "1e15", "1e18"] {
        let value = format!("0.1 + 0.1*cos({factor}*cos_o*u)");
        let material =
            format!(r#"m: {{ bsdf: {{ map: {map}, jacobian: auto, value: ["{value}"] }} }}"#);
        let text = scene(&material, shape) + "precision: { fraction: 30 }\n";
        fs::write(folder.path("w.yaml"), text).unwrap();
        let errors = folder.fails(2, &["inspect", "w.yaml"]);
        assert!(errors.contains("QRT0611"), "{factor}: {errors}");
    }
}
