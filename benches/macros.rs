//! What `qrt!` costs a crate that uses it: how long it takes to build, and how much it writes.
//!
//! `cargo bench --bench macros` makes a crate that depends on `qrt` alone, with a scene from a
//! file, the Cornell box, and prints the seconds of its first build (all dependencies, nothing
//! optimised), of a build after the scene was changed, and of the expansion of its macros; and the
//! bytes that they expand to.
//!
//! It fails where a promise is broken, on two cores with nothing else to do: the first build takes
//! less than 90 seconds, the next one less than 3, the expansion less than half a second, and what
//! is written is less than 2 MB.

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
    println!("{} pixels", render(CornellBox::scene(), &Options::default()).unwrap().image.pixels.len());
}
"#;

fn main() -> ExitCode {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let user = User::new(root);
    let first = user.seconds(&["build"]);
    let mut next = f64::INFINITY;
    for albedo in ["0.71", "0.72", "0.74"] {
        user.scene(root, albedo);
        next = next.min(user.seconds(&["build"]));
    }
    user.touch();
    let passes = user.output(&["rustc", "--", "-Ztime-passes"]).1;
    // `time:   0.392; rss:   44MB ->  105MB (  +61MB)	macro_expand_crate`
    let line = passes
        .lines()
        .find(|line| line.ends_with("macro_expand_crate"));
    let time = line.and_then(|line| line.strip_prefix("time:")?.split(';').next());
    let expansion = time.and_then(|time| time.trim().parse::<f64>().ok());
    let expansion = expansion.expect("the compiler's times");
    user.touch();
    let written = user.output(&["rustc", "--", "-Zunpretty=expanded"]).0.len();
    let mut promises = Promises::new();
    for (what, figure, bar, unit) in [
        ("first build", first, 90.0, "s"),
        ("build after a change of the scene", next, 3.0, "s"),
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
        std::fs::create_dir_all(folder.join("src")).expect("a folder");
        let manifest = format!(
            "[package]\nname = \"author\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n\
             [dependencies]\nqrt = {{ path = '{}' }}\n\n[workspace]\n",
            root.display()
        );
        std::fs::write(folder.join("Cargo.toml"), manifest).expect("a file");
        std::fs::write(folder.join("src/main.rs"), PROGRAM).expect("a file");
        // The versions that were tested.
        std::fs::copy(root.join("Cargo.lock"), folder.join("Cargo.lock")).expect("a file");
        let user = Self { folder };
        user.scene(root, "0.725");
        user
    }

    /// Writes the scene, with walls of this albedo.
    fn scene(&self, root: &Path, albedo: &str) {
        let text = std::fs::read_to_string(root.join("scenes-yaml/cornell-box.yaml"));
        let text = text.expect("the scene");
        let changed = text.replace("[0.725, ", &format!("[{albedo}, "));
        assert!(
            albedo == "0.725" || text != changed,
            "the scene has grey walls"
        );
        std::fs::write(self.folder.join("box.yaml"), changed).expect("a file");
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
