//! Tests that writing destroys no input and no file of another process, and leaves nothing behind.

use crate::common::command::Folder;
use std::fs;

const BOX: &str = include_str!("../scenes/box.yaml");

/// A lamp that is a mesh, with a material from a library.
const MESH: &str = "
name: mesh
camera: { perspective: { eye: [0, 0, 5], target: [0, 0, 0], vfov: 40 } }
film: { width: 4, height: 4 }
materials: { lamp: { emitter: { radiance: [1, 1, 1] } } }
geometry: [{ mesh: { obj: meshes/lamp.obj } }, { mesh: { obj: meshes/lamp.obj, material: lamp } }]
sampling: { path_bits: 4, depths: [{ bits: [4, 4] }] }
";
const OBJ: &str = "mtllib lamp.mtl\nusemtl glow\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n";
const MTL: &str = "newmtl glow\nKe 1 1 1\n";

/// Creates a folder with the mesh, and other names for its files.
fn folder() -> Folder {
    let folder = Folder::with("mesh.yaml", MESH);
    fs::create_dir(folder.path("meshes")).unwrap();
    fs::write(folder.path("meshes/lamp.obj"), OBJ).unwrap();
    fs::write(folder.path("meshes/lamp.mtl"), MTL).unwrap();
    fs::hard_link(folder.path("mesh.yaml"), folder.path("hard.svg")).unwrap();
    #[cfg(unix)]
    {
        use std::os::unix::fs::symlink;
        symlink("meshes/lamp.mtl", folder.path("soft.exr")).unwrap();
        symlink("new.csv", folder.path("dangling.exr")).unwrap();
        symlink(".", folder.path("here")).unwrap();
    }
    folder
}

#[test]
fn no_output_is_written_over_an_input_or_another_whatever_they_are_called() {
    let folder = folder();
    folder.works(&["render", "mesh.yaml", "-q", "-o", "usual.exr"]);
    let names = folder.names();
    let mut commands = vec![
        "render mesh.yaml -o k.exr --counts meshes/lamp.obj",
        "render mesh.yaml -o k.exr --stats ./meshes/../meshes/lamp.mtl",
        "render mesh.yaml -o k.exr --stats hard.svg",
        "render mesh.yaml -o ./n.exr --counts n.exr",
        "render mesh.yaml -o n.exr --counts meshes/../n.exr",
        "render mesh.yaml -o n.exr --counts c --stats meshes/../c",
        "render mesh.yaml -o n.exr --counts n.exr.qrt-partial",
        "render mesh.yaml -o n.exr --stats ./n.exr.qrt-partial",
        "render mesh.yaml -o usual.exr --stats ./usual.exr",
        "export mesh.yaml -o meshes/lamp.obj",
        "export mesh.yaml -o ./mesh.yaml",
        "export mesh.yaml -o hard.svg",
        "inspect mesh.yaml --circuit hard.svg",
        "inspect mesh.yaml --circuit a.svg --registers ./a.svg",
        "inspect mesh.yaml --registers meshes/lamp.mtl",
        "trade mesh.yaml -o . --quick --pixels 1",
    ];
    if cfg!(unix) {
        commands.extend([
            "render mesh.yaml -o soft.exr",
            "render mesh.yaml -o dangling.exr --counts new.csv",
            "render mesh.yaml -o dangling.exr --counts here/new.csv",
            "render mesh.yaml -o here/mesh.exr --stats mesh.exr",
        ]);
    }
    for command in commands {
        let arguments: Vec<&str> = command.split(' ').collect();
        let errors = folder.fails(2, &arguments);
        assert!(
            errors.contains("used for two different things"),
            "{command}: {errors}"
        );
        assert_eq!(folder.names(), names, "{command}");
        assert_eq!(folder.read("mesh.yaml"), MESH.as_bytes(), "{command}");
        assert_eq!(folder.read("meshes/lamp.obj"), OBJ.as_bytes(), "{command}");
        assert_eq!(folder.read("meshes/lamp.mtl"), MTL.as_bytes(), "{command}");
    }
    // No output may be another picture's checkpoint.
    for option in ["--counts", "--stats"] {
        let errors = folder.fails(2, &["render", "mesh.yaml", option, "other.png.qrt-partial"]);
        assert!(errors.contains("named as a checkpoint"), "{errors}");
    }
    assert_eq!(folder.names(), names);
    let errors = folder.fails(
        2,
        &["render", "mesh.yaml", "-o", "k.exr", "--counts", "hard.svg"],
    );
    assert!(errors.contains("`hard.svg` is `mesh.yaml`"), "{errors}");
}

#[cfg(unix)]
#[test]
fn a_link_to_what_is_not_there_yet_is_followed() {
    let folder = folder();
    folder.works(&["render", "mesh.yaml", "-q", "-o", "dangling.exr"]);
    let made = folder.path("new.csv");
    assert!(fs::symlink_metadata(made).unwrap().is_file());
    let link = fs::symlink_metadata(folder.path("dangling.exr")).unwrap();
    assert!(link.is_symlink());
}

#[cfg(unix)]
#[test]
fn a_checkpoint_is_not_written_through_a_link() {
    let folder = folder();
    fs::write(folder.path("thesis"), "").unwrap();
    for target in ["thesis", "missing"] {
        let partial = folder.path("p.exr.qrt-partial");
        std::os::unix::fs::symlink(target, &partial).unwrap();
        let errors = folder.fails(2, &["render", "mesh.yaml", "-o", "p.exr"]);
        assert!(errors.contains("is a link or no regular file"), "{errors}");
        fs::remove_file(partial).unwrap();
        assert_eq!(folder.read("thesis"), b"");
        assert!(!folder.path("missing").exists());
        assert!(!folder.path("p.exr").exists());
    }
}

#[test]
fn renders_of_one_picture_at_a_time_leave_it_whole_and_nothing_else() {
    let folder = Folder::with("box.yaml", BOX);
    let command = ["render", "box.yaml", "-q", "--set", "sampling.path_bits=4"];
    folder.works(&command);
    let expected = folder.read("box.png");
    for _ in 0..50 {
        let running = [(); 2].map(|()| folder.started(&command));
        let mut finished = 0;
        for child in running {
            let output = child.wait_with_output().unwrap();
            let errors = String::from_utf8(output.stderr).unwrap();
            // The command finishes, or reports that the other process writes the file.
            match output.status.code() {
                Some(0) => finished += 1,
                Some(1) => assert!(errors.contains("is being written by another"), "{errors}"),
                code => panic!("{code:?}: {errors}"),
            }
        }
        assert!(finished > 0);
        assert_eq!(folder.read("box.png"), expected);
        assert_eq!(folder.names(), ["box.png", "box.yaml"]);
    }
}

/// Returns a checkpoint with finished tiles of another seed.
fn interrupted(folder: &Folder) -> Vec<u8> {
    folder.fails(1, &["render", "box.yaml", "--counts", "/dev/full"]);
    folder.read("box.png.qrt-partial")
}

#[cfg(target_os = "linux")]
#[test]
fn a_render_that_is_refused_costs_no_finished_work() {
    let folder = Folder::with("box.yaml", BOX);
    let tiles = interrupted(&folder);
    for refused in [
        &["--model", "gates", "--set", "budget={toffoli: 1000}"][..],
        &["--crop", "12,0,2,1"],
        &["--estimator", "exact", "--noise", "depolarising=0.1"],
        &["--set", "sampling.path_bits=60"],
        &["--model", "fixed", "--set", "precision.fraction=40"],
    ] {
        folder.fails(2, &[&["render", "box.yaml"], refused].concat());
        assert_eq!(folder.read("box.png.qrt-partial"), tiles, "{refused:?}");
    }
    let accuracy = BOX.replace("  path_bits: 10\n", "");
    let accuracy = accuracy
        .lines()
        .filter(|line| !line.starts_with("counting"));
    let accuracy = accuracy.collect::<Vec<_>>().join("\n");
    let impossible = format!("{accuracy}\naccuracy: {{ error: 0.3, confidence: 0.9999999 }}\n");
    fs::write(folder.path("box.yaml"), impossible).unwrap();
    folder.fails(2, &["render", "box.yaml"]);
    assert_eq!(folder.read("box.png.qrt-partial"), tiles);
    fs::write(folder.path("box.yaml"), BOX).unwrap();
    folder.works(&["render", "box.yaml", "--resume"]);
}

#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_written_is_told_before_the_work() {
    let folder = Folder::with("box.yaml", BOX);
    // One byte longer than the longest name.
    let long = "x".repeat(256);
    for option in ["--stats", "--counts"] {
        let slow = ["--set", "sampling.path_bits=30"];
        let errors = folder.fails(
            1,
            &[&["render", "box.yaml", option, &long], &slow[..]].concat(),
        );
        assert!(errors.contains(&long), "{errors}");
        assert_eq!(folder.names(), ["box.yaml"]);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_picture_survives_its_folder() {
    let folder = Folder::with("box.yaml", BOX);
    let slow = ["--set", "sampling.path_bits=15", "--counts", "c.csv"];
    let slow = [&["render", "box.yaml", "-o", "out/p.png"], &slow[..]].concat();
    fs::create_dir(folder.path("out")).unwrap();
    folder.works(&slow);
    let expected = folder.read("out/p.png");
    fs::remove_file(folder.path("out/p.png")).unwrap();
    let mut child = folder.started(&slow);
    let partial = folder.path("out/p.png.qrt-partial");
    // Wait for the header and at least one tile.
    while fs::metadata(&partial).map_or(0, |found| found.len()) < 2048 {
        assert!(child.try_wait().unwrap().is_none(), "finished too soon");
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    fs::remove_dir_all(folder.path("out")).unwrap();
    let output = child.wait_with_output().unwrap();
    let errors = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{errors}");
    assert!(
        errors.contains("has vanished, and is made again"),
        "{errors}"
    );
    assert_eq!(folder.read("out/p.png"), expected);
    assert_eq!(folder.names(), ["box.yaml", "c.csv", "out"]);
    assert_eq!(fs::read_dir(folder.path("out")).unwrap().count(), 1);
}

#[cfg(unix)]
#[test]
fn a_limit_on_the_size_of_files_is_told_and_not_died_of() {
    let folder = Folder::with("box.yaml", BOX);
    folder.works(&["render", "box.yaml", "-q", "-o", "expected.png"]);
    let qrt = env!("CARGO_BIN_EXE_qrt");
    let limited = |blocks: &str, arguments: &str| {
        let script = format!("ulimit -f {blocks} && exec \"$0\" render box.yaml {arguments}");
        let mut command = std::process::Command::new("bash");
        command.args(["-c", &script, qrt]);
        let output = command.current_dir(folder.path("")).output().unwrap();
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(
            output.status.code(),
            Some(1),
            "{:?}: {errors}",
            output.status
        );
        errors
    };
    // The first limit is too small for the checkpoint, the second only for the counts.
    let errors = limited("1", "--set sampling.path_bits=11");
    assert!(errors.contains("too large"), "{errors}");
    let errors = limited("16", "--counts c.csv");
    assert!(errors.contains("too large"), "{errors}");
    assert!(errors.contains("`--resume`"), "{errors}");
    folder.works(&["render", "box.yaml", "-q", "--resume"]);
    assert_eq!(folder.read("box.png"), folder.read("expected.png"));
    assert_eq!(folder.names(), ["box.png", "box.yaml", "expected.png"]);
}

#[test]
fn what_a_scene_reads_is_kept_whatever_its_name_ends_in() {
    let folder = Folder::new();
    fs::create_dir(folder.path("out")).unwrap();
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let meshes = |file: &str| {
        BOX.replace(
            "geometry:\n",
            &format!("geometry:\n  - mesh: {{ obj: {file}, material: lamp }}\n"),
        )
    };
    fs::write(folder.path("mesh.exr"), mesh).unwrap();
    fs::write(folder.path("box.yaml"), meshes("mesh.exr")).unwrap();
    let errors = folder.fails(2, &["render", "box.yaml", "-o", "./mesh.exr"]);
    assert!(errors.contains("mesh.exr"), "{errors}");
    assert_eq!(folder.read("mesh.exr"), mesh.as_bytes());
    // A folder of plots in which the scene or its mesh lies.
    fs::write(folder.path("out/mesh.svg"), mesh).unwrap();
    fs::write(folder.path("out/scene.svg"), meshes("mesh.svg")).unwrap();
    fs::write(folder.path("out/scene.yaml"), meshes("mesh.svg")).unwrap();
    for scene in ["out/scene.svg", "out/scene.yaml"] {
        let errors = folder.fails(2, &["trade", scene, "--quick", "-o", "out"]);
        assert!(errors.contains(".svg"), "{errors}");
    }
    assert_eq!(folder.read("out/mesh.svg"), mesh.as_bytes());
    assert_eq!(folder.read("out/scene.svg"), meshes("mesh.svg").as_bytes());
    assert!(!folder.path("out/trade.csv").exists());
}

/// A shell that redirects standard output to a file keeps that file open: other commands write to it too,
/// before and after.
#[cfg(unix)]
#[test]
fn what_standard_output_is_led_into_is_added_to_and_not_replaced() {
    use std::io::Write as _;
    let folder = folder();
    let mut log = fs::File::create(folder.path("log")).unwrap();
    log.write_all(b"before\n").unwrap();
    for name in ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"] {
        if cfg!(not(target_os = "linux")) && name.starts_with("/proc") {
            continue;
        }
        let arguments = [
            "render",
            "mesh.yaml",
            "-q",
            "-o",
            "k.exr",
            "--crop",
            "1,1,1,1",
            "--counts",
            name,
        ];
        let mut command = folder.command(&arguments);
        let output = command.stdout(log.try_clone().unwrap()).output().unwrap();
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{name}: {errors}");
    }
    let text = String::from_utf8(folder.read("log")).unwrap();
    let header = "x,y,channel,value,good,total,scale";
    let pictures = if cfg!(target_os = "linux") { 3 } else { 2 };
    assert!(
        text.starts_with(&format!("before\n{header}\n1,1,r,")),
        "{text}"
    );
    assert_eq!(text.matches(header).count(), pictures, "{text}");
    assert_eq!(text.lines().count(), 1 + 4 * pictures, "{text}");
}
