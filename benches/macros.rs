//! Cost of `qrt!` for a crate that uses it: build time, and bytes of the expansion.
//!
//! `cargo bench --bench macros` makes a crate that depends on `qrt` with the feature `png`, in two parts:
//!
//! - `first_program` has the program of README. It prints the seconds of the processor of the first build (all
//!   dependencies, nothing optimised), the bytes of the binary, and the seconds of a build after the program's
//!   scene was changed.
//! - `scenes` has programs with larger scenes: the Cornell box, rendered by its compiled circuit, the same within
//!   500 qubits, and a mesh of 1,536 triangles. It prints the seconds of builds after one scene was changed and of
//!   the expansion of the box, and the bytes of this expansion.
//!
//! It fails where a promise is broken, on two cores with nothing else to do: the first build takes at most
//! 100 seconds of the processor; the next one at most 1.5 seconds with README's program, 3 with the box, 5 with
//! the mesh and 15 with the box of few qubits; the expansion takes at most half a second, and has at most 2 MB.

// A bench that cannot run has nothing to report.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use common::{Arguments, Promises, processor};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

const PROGRAM: &str = r#"
use qrt::prelude::*;

qrt! { pub scene CornellBox from "NAME.yaml" }

fn main() {
    println!("{} qubits, {} Toffolis", CornellBox::QUBITS, CornellBox::TOFFOLI);
    let options = RenderOptions { crop: Some([20, 40, 2, 2]), ..RenderOptions::default() };
    println!("{} pixels", render_compiled::<CornellBox>(&options).unwrap().image.pixels.len());
}
"#;

const MESH: &str = r#"
use qrt::prelude::*;

qrt! { pub scene Knot from "NAME.yaml" }

fn main() {
    println!("{} qubits, {} Toffolis", Knot::QUBITS, Knot::TOFFOLI);
    let options = RenderOptions { crop: Some([20, 40, 2, 2]), ..RenderOptions::default() };
    println!("{} pixels", render(Knot::scene(), &options).unwrap().image.pixels.len());
}
"#;

/// A program with a scene, and the seconds that its build may take after a change of the scene.
struct Author {
    binary: &'static str,
    program: String,
    /// The file with the scene, and its text.
    scene: (String, String),
    /// The text of the scene that the bench changes: where an albedo begins, and its first number.
    changed: [&'static str; 2],
    seconds: f64,
}

/// Returns the program of README and its scene.
fn first() -> Author {
    let scene = "scenes-yaml/floor-and-light.yaml";
    let program = first_program();
    assert!(program.contains(scene), "{program}");
    let text = std::fs::read_to_string(format!("{ROOT}/{scene}")).expect("the scene");
    Author {
        binary: "first",
        program,
        scene: (scene.to_owned(), text),
        changed: ["[", "0.8"],
        seconds: 1.5,
    }
}

/// Returns the programs with larger scenes.
fn larger() -> Vec<Author> {
    let of_file = |binary, scene, changed, added, program: &str, seconds| {
        let text = std::fs::read_to_string(format!("{ROOT}/scenes-yaml/{scene}.yaml"));
        Author {
            binary,
            program: program.replace("NAME", binary),
            scene: (
                format!("{binary}.yaml"),
                text.expect("the scene") + "\n" + added,
            ),
            changed,
            seconds,
        }
    };
    vec![
        of_file("cornell", "cornell-box", ["[", "0.725"], "", PROGRAM, 3.0),
        of_file(
            "few-qubits",
            "cornell-box",
            ["[", "0.725"],
            FEW,
            PROGRAM,
            15.0,
        ),
        of_file("mesh", "knot", ["[", "0.6"], "", MESH, 5.0),
    ]
}

/// Returns the program of README.
fn first_program() -> String {
    let text = std::fs::read_to_string(format!("{ROOT}/README.md")).expect("a page");
    let code = text
        .split("```rust,no_run\n")
        .nth(1)
        .and_then(|code| code.split("```").next());
    let lines = code.expect("a program").lines();
    let lines: Vec<&str> = lines
        .map(|line| line.strip_prefix("# ").unwrap_or(line))
        .collect();
    let code = lines.join("\n");
    format!("fn main() -> Result<(), Box<dyn std::error::Error>> {{\n{code}\n}}\n")
}

const FEW: &str = "circuit: { uncompute: auto }\nbudget: { qubits: 500 }\n";

fn main() -> ExitCode {
    common::run(&[("first_program", measure_first), ("scenes", measure_larger)])
}

/// Judges a figure by the most that is promised.
fn judge(promises: &mut Promises, what: &str, (figure, most): (f64, f64), unit: &str) {
    let what = format!("{what}: {figure:.2} {unit}, at most {most}");
    promises.judge(&what, figure <= most);
}

fn measure_first(_: &Arguments, promises: &mut Promises) {
    let user = User::new(vec![first()]);
    let before = processor::of_children();
    let passed = user.seconds(&["build", "--bin", "first"]);
    let first = processor::of_children() - before;
    println!("first build: {passed:.2} s have passed");
    judge(
        promises,
        "first build",
        (first, 100.0),
        "s of the processor",
    );
    let binary = std::fs::metadata(user.folder.join("target/debug/first")).expect("a binary");
    println!("first binary: {:.1} MB", binary.len() as f64 / 1e6);
    user.change_all(promises);
    std::fs::remove_dir_all(&user.folder).ok();
}

fn measure_larger(_: &Arguments, promises: &mut Promises) {
    let user = User::new(larger());
    user.change_all(promises);
    user.touch();
    let passes = ["rustc", "--bin", "cornell", "--", "-Ztime-passes"];
    let passes = user.output(&passes).1;
    // `time:   0.392; rss:   44MB ->  105MB (  +61MB)	macro_expand_crate`
    let line = passes
        .lines()
        .find(|line| line.ends_with("macro_expand_crate"));
    let time = line.and_then(|line| line.strip_prefix("time:")?.split(';').next());
    let expansion = time.and_then(|time| time.trim().parse::<f64>().ok());
    let expansion = expansion.expect("the compiler's times");
    user.touch();
    let expanded = ["rustc", "--bin", "cornell", "--", "-Zunpretty=expanded"];
    let written = user.output(&expanded).0.len();
    judge(promises, "expansion", (expansion, 0.5), "s");
    judge(promises, "expands to", (written as f64 / 1e6, 2.0), "MB");
    std::fs::remove_dir_all(&user.folder).ok();
}

/// The crate of a user.
struct User {
    folder: PathBuf,
    authors: Vec<Author>,
}

impl User {
    fn new(authors: Vec<Author>) -> Self {
        let root = Path::new(ROOT);
        let folder = std::env::temp_dir().join(format!("qrt-macro-user-{}", std::process::id()));
        std::fs::create_dir_all(folder.join("src/bin")).expect("a folder");
        std::fs::create_dir_all(folder.join("meshes")).expect("a folder");
        std::fs::create_dir_all(folder.join("scenes-yaml")).expect("a folder");
        let manifest = format!(
            "[package]\nname = \"author\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n\
             [dependencies]\nqrt = {{ path = '{}', default-features = false, features = [\"png\"] }}\n\n[workspace]\n",
            root.display()
        );
        std::fs::write(folder.join("Cargo.toml"), manifest).expect("a file");
        for author in &authors {
            let file = folder.join(format!("src/bin/{}.rs", author.binary));
            std::fs::write(file, &author.program).expect("a file");
        }
        let knot = "meshes/knot.obj";
        std::fs::copy(root.join("scenes-yaml").join(knot), folder.join(knot)).expect("a file");
        // The build uses the tested versions.
        std::fs::copy(root.join("Cargo.lock"), folder.join("Cargo.lock")).expect("a file");
        let user = Self { folder, authors };
        for author in &user.authors {
            user.scene(author, author.changed[1]);
        }
        user
    }

    /// Judges the time of a build of each program after a change of its scene, the least of three.
    fn change_all(&self, promises: &mut Promises) {
        for author in &self.authors {
            let build = ["build", "--bin", author.binary];
            self.seconds(&build);
            let builds = ["0.71", "0.72", "0.74"].map(|albedo| {
                self.scene(author, albedo);
                self.seconds(&build)
            });
            let least = builds.into_iter().fold(f64::INFINITY, f64::min);
            let what = format!("build after a change of {}", author.binary);
            judge(promises, &what, (least, author.seconds), "s");
        }
    }

    /// Writes an author's scene, with `albedo` as the first number of one.
    fn scene(&self, author: &Author, albedo: &str) {
        let [begin, known] = author.changed;
        let known = format!("{begin}{known}, ");
        let (file, text) = &author.scene;
        assert!(text.contains(&known), "{file}: {known}");
        let text = text.replace(&known, &format!("{begin}{albedo}, "));
        std::fs::write(self.folder.join(file), text).expect("a file");
    }

    /// Rewrites the program, so that the box is compiled again.
    fn touch(&self) {
        let program = PROGRAM.replace("NAME", "cornell");
        std::fs::write(self.folder.join("src/bin/cornell.rs"), program).expect("a file");
    }

    fn output(&self, arguments: &[&str]) -> (String, String) {
        let output = Command::new(env!("CARGO"))
            .args(arguments)
            .current_dir(&self.folder)
            .env("CARGO_TARGET_DIR", self.folder.join("target"))
            // The nightly option for the compiler's own figures needs it.
            .env("RUSTC_BOOTSTRAP", "1")
            .output()
            .expect("cargo");
        let [text, errors] = [output.stdout, output.stderr]
            .map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
        assert!(output.status.success(), "{arguments:?}:\n{errors}");
        (text, errors)
    }

    fn seconds(&self, arguments: &[&str]) -> f64 {
        let started = Instant::now();
        self.output(arguments);
        started.elapsed().as_secs_f64()
    }
}
