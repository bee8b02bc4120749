//! Tests that each command compiles a scene once.

use super::{Cli, run};
use clap::Parser;
use qrt_scene::valid::ValidScene;
use std::cell::RefCell;
use std::fs;
use std::path::{Path, PathBuf};

thread_local! {
    /// The scene that a command of this thread has loaded last.
    pub(super) static LOADED: RefCell<Option<ValidScene>> = const { RefCell::new(None) };
}

/// A wall that a lamp behind the camera lights, and another lamp before it, on the right of the film:
/// some pixels may see that one, and others see none.
const SCENE: &str = "
name: half
camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 2 } }
film: { width: 4, height: 2 }
materials:
  wall: { lambertian: { albedo: [0.5, 0.25, 0.125] } }
  lamp: { emitter: { radiance: [1, 1, 1] } }
geometry:
  - quad: { vertices: [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], material: wall }
  - quad: { vertices: [[1, -1, 0.5], [3, -1, 0.5], [3, 1, 0.5], [1, 1, 0.5]], material: lamp }
  - quad: { vertices: [[-1, -1, 3], [-1, 1, 3], [1, 1, 3], [1, -1, 3]], material: lamp }
sampling: { path_bits: 2, depths: [{ bits: [2, 2] }, { bits: [2, 2], light: [2, 2] }] }
precision: { fraction: 8 }
comparator: { bits: 4 }
";

/// A folder that is removed in the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = format!("qrt-compiled-once-{name}-{}", std::process::id());
        let folder = std::env::temp_dir().join(folder);
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("half.yaml"), SCENE).unwrap();
        Self(folder)
    }

    /// Runs a command on the scene. Returns the number of programs that it recorded.
    fn recordings(&self, arguments: &[&str]) -> u64 {
        let named = |argument: &&str| {
            let file = [".yaml", ".exr", ".qasm", ".json"];
            if file.iter().any(|end| argument.ends_with(end)) {
                self.0.join(argument).into_os_string()
            } else {
                argument.into()
            }
        };
        let arguments = arguments.iter().map(named);
        let all = std::iter::once("qrt".into()).chain(arguments);
        let Cli { command } = Cli::try_parse_from(all).unwrap();
        run(command).unwrap_or_else(|failure| panic!("{failure}"));
        LOADED.take().unwrap().recordings()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        fs::remove_dir_all(Path::new(&self.0)).ok();
    }
}

/// A setting of the number of paths above which counts are not compared with those of more fraction bits.
const MANY: &str = "sampling.path_bits=17";

/// Number of classes of the scene's pixels. Each is compiled by itself.
const CLASSES: u64 = 2;

#[test]
fn a_render_compiles_each_class_of_pixels_once() {
    let folder = Folder::new("render");
    let render = ["render", "half.yaml", "-q", "-o", "p.exr"];
    let recordings = |more: &[&str]| folder.recordings(&[&render[..], more].concat());
    assert_eq!(recordings(&[]), 0);
    let budget = ["--set", "budget.toffoli=1000000000"];
    for model in ["fixed", "gates"] {
        let model = ["--model", model];
        assert_eq!(recordings(&model), CLASSES);
        assert_eq!(recordings(&[model, budget].concat()), CLASSES);
        assert_eq!(
            recordings(&[model, ["--colour", "one-run"]].concat()),
            CLASSES
        );
        // One program for each class continues the paths, and one finds the hits of all.
        let search = ["--visibility", "exhaustive"];
        assert_eq!(recordings(&[model, search].concat()), CLASSES + 1);
    }
    // A budget is one of the scene's own oracles.
    let all = ["--model", "fixed", "--colour", "one-run"];
    assert_eq!(recordings(&[&all[..], &budget].concat()), CLASSES);
}

#[test]
fn an_inspection_compiles_each_class_once_and_the_steps_of_its_passes() {
    // Without passes, with the first one, and with the second: the others change a recorded program.
    const PASSES: u64 = 3;
    let folder = Folder::new("inspect");
    for (more, of_pixel) in [
        (&[][..], 0),
        (&["--channel", "g"], 0),
        (&["--pixel", "0,0", "--set", MANY], 1),
        (&["--pixel", "3,1", "--channel", "b", "--set", MANY], 1),
        (&["--logical-counts", "counts.json"], 0),
    ] {
        let arguments = [&["inspect", "half.yaml", "--json"], more].concat();
        let recordings = folder.recordings(&arguments);
        assert_eq!(recordings, CLASSES + of_pixel + PASSES, "{more:?}");
    }
    // Each kind of recording that strategies need (three sorts of garbage, and recomputing, which leaves
    // none), of one class; and of the other class one kind.
    let front = ["inspect", "half.yaml", "--json", "--pareto"];
    assert_eq!(folder.recordings(&front), 8 + 1 + 1);
}

#[test]
fn an_export_compiles_its_pixel_once() {
    let folder = Folder::new("export");
    for pixel in ["0,0", "3,1"] {
        let export = [
            "export",
            "half.yaml",
            "--json",
            "-o",
            "p.qasm",
            "--set",
            MANY,
        ];
        let export = [&export[..], &["--pixel", pixel]].concat();
        assert_eq!(folder.recordings(&export), 1, "{pixel}");
    }
}

#[test]
fn a_check_compiles_each_class_once() {
    let folder = Folder::new("verify");
    let verify = ["verify", "half.yaml", "--json", "--pixels", "8"];
    assert_eq!(folder.recordings(&verify), CLASSES);
    let budget = ["--set", "budget.toffoli=1000000000"];
    assert_eq!(folder.recordings(&[&verify[..], &budget].concat()), CLASSES);
}
