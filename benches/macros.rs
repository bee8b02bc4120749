//! What `qrt!` costs a crate that uses it: how long it takes to build, and how much it writes.
//!
//! `cargo bench --bench macros` makes a crate that depends on `qrt` without its command, with scenes
//! from files: the Cornell box, rendered by its compiled circuit, and a mesh of 1,536 triangles. It
//! prints the seconds of its first build (all dependencies, nothing optimised), of builds after either
//! scene was changed, and of the expansion of the box; and the bytes that this expands to.
//!
//! It fails where a promise is broken, on two cores with nothing else to do: the first build takes
//! less than 60 seconds, the next one less than 3 with the box and less than 5 with the mesh, the
//! expansion less than half a second, and what is written is less than 2 MB.

// A bench that cannot run has nothing to report.
#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "common/promises.rs"]
mod promises;

use promises::Promises;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;

const PROGRAM: &str = r#"
use qrt::prelude::*;

qrt! { pub scene CornellBox from "box.yaml" }

fn main() {
    println!("{} qubits, {} Toffolis", CornellBox::QUBITS, CornellBox::TOFFOLI);
    let options = Options { model: Model::Fixed, crop: Some([20, 40, 2, 2]), ..Options::default() };
    println!("{} pixels", render_compiled::<CornellBox>(&options).unwrap().image.pixels.len());
}
"#;

const MESH: &str = r#"
use qrt::prelude::*;

qrt! { pub scene Knot from "knot.yaml" }

fn main() {
    println!("{} qubits, {} Toffolis", Knot::QUBITS, Knot::TOFFOLI);
    let options = Options { crop: Some([20, 40, 2, 2]), ..Options::default() };
    println!("{} pixels", render(Knot::scene(), &options).unwrap().image.pixels.len());
}
"#;

fn main() -> ExitCode {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let user = User::new(root);
    let first = user.seconds(&["build", "--bin", "author"]);
    user.seconds(&["build", "--bin", "mesh"]);
    let [mut next, mut mesh] = [f64::INFINITY; 2];
    for albedo in ["0.71", "0.72", "0.74"] {
        user.scene(
            root,
            "cornell-box",
            "box",
            "[0.725, ",
            &format!("[{albedo}, "),
        );
        next = next.min(user.seconds(&["build", "--bin", "author"]));
        user.scene(
            root,
            "knot",
            "knot",
            "[0.6, 0.6, 0.6]",
            &format!("[{albedo}, 0.6, 0.6]"),
        );
        mesh = mesh.min(user.seconds(&["build", "--bin", "mesh"]));
    }
    user.touch();
    let passes = user
        .output(&["rustc", "--bin", "author", "--", "-Ztime-passes"])
        .1;
    // `time:   0.392; rss:   44MB ->  105MB (  +61MB)	macro_expand_crate`
    let line = passes
        .lines()
        .find(|line| line.ends_with("macro_expand_crate"));
    let time = line.and_then(|line| line.strip_prefix("time:")?.split(';').next());
    let expansion = time.and_then(|time| time.trim().parse::<f64>().ok());
    let expansion = expansion.expect("the compiler's times");
    user.touch();
    let expanded = ["rustc", "--bin", "author", "--", "-Zunpretty=expanded"];
    let written = user.output(&expanded).0.len();
    let mut promises = Promises::new();
    for (what, figure, bar, unit) in [
        ("first build", first, 60.0, "s"),
        ("build after a change of the box", next, 3.0, "s"),
        ("build after a change of the mesh", mesh, 5.0, "s"),
        ("expansion", expansion, 0.5, "s"),
        ("expands to", written as f64 / 1e6, 2.0, "MB"),
    ] {
        let what = format!("{what}: {figure:.2} {unit}, below {bar}");
        promises.judge(&what, figure < bar);
    }
    std::fs::remove_dir_all(&user.folder).ok();
    promises.exit()
}

/// A crate of an author's.
struct User {
    folder: PathBuf,
}

impl User {
    fn new(root: &Path) -> Self {
        let folder = std::env::temp_dir().join(format!("qrt-macro-user-{}", std::process::id()));
        std::fs::create_dir_all(folder.join("src/bin")).expect("a folder");
        std::fs::create_dir_all(folder.join("meshes")).expect("a folder");
        let manifest = format!(
            "[package]\nname = \"author\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n\
             [dependencies]\nqrt = {{ path = '{}', default-features = false }}\n\n[workspace]\n",
            root.display()
        );
        std::fs::write(folder.join("Cargo.toml"), manifest).expect("a file");
        std::fs::write(folder.join("src/main.rs"), PROGRAM).expect("a file");
        std::fs::write(folder.join("src/bin/mesh.rs"), MESH).expect("a file");
        let knot = "meshes/knot.obj";
        std::fs::copy(root.join("scenes-yaml").join(knot), folder.join(knot)).expect("a file");
        // The versions that were tested.
        std::fs::copy(root.join("Cargo.lock"), folder.join("Cargo.lock")).expect("a file");
        let user = Self { folder };
        user.scene(root, "cornell-box", "box", "", "");
        user.scene(root, "knot", "knot", "", "");
        user
    }

    /// Writes a scene of this repository, with something changed.
    fn scene(&self, root: &Path, name: &str, own: &str, from: &str, to: &str) {
        let text = std::fs::read_to_string(root.join(format!("scenes-yaml/{name}.yaml")));
        let text = text.expect("the scene");
        let changed = text.replace(from, to);
        assert!(from.is_empty() || text != changed, "{name} has no {from}");
        std::fs::write(self.folder.join(format!("{own}.yaml")), changed).expect("a file");
    }

    /// So that it is compiled again.
    fn touch(&self) {
        std::fs::write(self.folder.join("src/main.rs"), PROGRAM).expect("a file");
    }

    fn output(&self, arguments: &[&str]) -> (String, String) {
        let output = Command::new(env!("CARGO"))
            .args(arguments)
            .current_dir(&self.folder)
            .env("CARGO_TARGET_DIR", self.folder.join("target"))
            // For the compiler's own figures.
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
