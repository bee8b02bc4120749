//! Tests of `qrt render --watch`: it renders each saved state of the files, and no other.
#![cfg(unix)]

use crate::common::command::{Folder, signalled};
use std::fs;
use std::time::{Duration, Instant};

const SCENE: &str = "
name: watched
camera: { perspective: { eye: [0.3, 0.3, 3], target: [0.3, 0.3, 0], vfov: 40 } }
film: { width: 4, height: 4 }
materials: { lamp: { emitter: { radiance: [1, 0.5, 0.25] } } }
geometry: [{ mesh: { obj: part.obj, material: lamp } }]
sampling: { path_bits: 4 }
counting: { estimator: exact }
";
const MESH: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// Waits until `name` holds these bytes.
fn wait_for(folder: &Folder, name: &str, bytes: &[u8]) {
    let begun = Instant::now();
    while fs::read(folder.path(name)).ok().as_deref() != Some(bytes) {
        assert!(begun.elapsed() < Duration::from_mins(1), "waited in vain");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn every_change_of_a_file_of_the_scene_is_rendered_until_ctrl_c() {
    let folder = Folder::with("scene.yaml", SCENE);
    let write = |name: &str, text: &str| fs::write(folder.path(name), text).unwrap();
    // The pictures of each state of the files.
    let dim = SCENE.replace("[1, 0.5, 0.25]", "[0.5, 0.5, 0.125]");
    let wide = MESH.replace("v 1 0 0", "v 1.5 0 0");
    let states = [
        (SCENE, MESH),
        (&*dim, MESH),
        (&*dim, &*wide),
        (SCENE, &*wide),
    ];
    let pictures = states.map(|(scene, mesh)| {
        write("scene.yaml", scene);
        write("part.obj", mesh);
        folder.works(&["render", "scene.yaml", "-o", "once.png"]);
        folder.read("once.png")
    });
    write("scene.yaml", states[0].0);
    write("part.obj", states[0].1);

    let child = folder.started(&["render", "scene.yaml", "-o", "a.png", "--watch"]);
    wait_for(&folder, "a.png", &pictures[0]);
    write("scene.yaml", states[1].0);
    wait_for(&folder, "a.png", &pictures[1]);
    write("part.obj", states[2].1);
    wait_for(&folder, "a.png", &pictures[2]);
    // An error is reported, and the next change renders again.
    write("scene.yaml", &SCENE.replace("lamp: {", "lmp: {"));
    std::thread::sleep(Duration::from_secs(1));
    assert_eq!(folder.read("a.png"), pictures[2]);
    write("scene.yaml", states[3].0);
    wait_for(&folder, "a.png", &pictures[3]);
    let (code, out, errors) = signalled(child, "-INT");
    assert_eq!(code, Some(0), "{errors}");
    assert!(out.matches("a.png").count() >= 4, "{out}");
    assert!(errors.contains("error[QRT"), "{errors}");
    assert_eq!(
        folder.names(),
        ["a.png", "once.png", "part.obj", "scene.yaml"]
    );
}

#[test]
fn what_no_change_mends_ends_it() {
    let folder = Folder::with("scene.yaml", SCENE);
    let watch = ["render", "scene.yaml", "--watch"];
    let ends = |more: &[&str]| folder.fails(2, &[&watch[..], more].concat());
    assert!(ends(&["--resume"]).contains("cannot be used with"));
    assert!(ends(&["-o", "a.gif"]).contains("a.gif"));
}
