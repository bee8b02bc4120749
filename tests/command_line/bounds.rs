//! Tests that work is bounded in memory and in time, and that work beyond the bounds is refused before it begins.
#![cfg(target_os = "linux")]

use crate::common::command::{Folder, signalled, worked};
use std::fmt::Write as _;
use std::fs;
use std::time::{Duration, Instant};

/// Resources that a command has used, as read last before its end.
#[derive(Default)]
struct Used {
    /// Peak of resident memory, in bytes.
    bytes: u64,
    /// Seconds of all processors.
    seconds: f64,
}

/// Runs the command, which must end with the exit code `code`.
fn used(folder: &Folder, code: i32, arguments: &[&str]) -> (Used, String) {
    let mut child = folder.started(arguments);
    let process = child.id();
    let mut used = Used::default();
    while child.try_wait().unwrap().is_none() {
        let text = fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kilobytes = line.and_then(|line| line.trim().strip_suffix(" kB"));
        if let (Some(kilobytes), Some(seconds)) = (kilobytes, worked(process)) {
            let bytes = 1024 * kilobytes.parse::<u64>().unwrap();
            used = Used { bytes, seconds };
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let output = child.wait_with_output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {errors}");
    (used, errors)
}

#[test]
#[ignore = "half a minute: the circuit of 1,538 faces is compiled for each of four commands"]
fn the_knot_is_verified_and_run_gate_by_gate_in_a_gigabyte() {
    let folder = Folder::new();
    let knot = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes-yaml/knot.yaml");
    // Two paths of a pixel. The estimate allows them, too. With less than `least`, the program would not be
    // there.
    for (uncompute, least) in [("keep", 200_000_000), ("scoped", 100_000_000)] {
        let uncompute = format!("circuit.uncompute={uncompute}");
        let few = [
            knot,
            "--set",
            &uncompute,
            "--set",
            "sampling.path_bits=1",
            "--max-memory",
            "950M",
        ];
        for command in [
            &["verify", "--pixels", "1"][..],
            &[
                "render",
                "--model",
                "gates",
                "--crop",
                "30,30,1,1",
                "-o",
                "k.exr",
            ],
        ] {
            let (Used { bytes: most, .. }, _) = used(&folder, 0, &[command, &few].concat());
            let fits = (least..1_000_000_000).contains(&most);
            assert!(fits, "{command:?}, {uncompute}: {most} bytes");
        }
    }
}

/// Returns a scene with `materials`, `quads` quads for each of them, and paths of the rays `rays`.
fn scene(materials: &[String], quads: usize, rays: &[String]) -> String {
    let mut text = String::from(
        "name: large
camera: { perspective: { eye: [0, 0, 3], target: [0, 0, 0], vfov: 45 } }
film: { width: 1, height: 1 }
materials:
  lamp: { emitter: { radiance: [1, 1, 1] } }
",
    );
    for (number, material) in materials.iter().enumerate() {
        let _ = writeln!(text, "  m{number}: {{ {material} }}");
    }
    text += "geometry:
  - quad: { vertices: [[-1, -1, 4], [-1, 1, 4], [1, 1, 4], [1, -1, 4]], material: lamp }
";
    for number in 0..quads {
        let z = number as f64 / quads as f64;
        let _ = writeln!(
            text,
            "  - quad: {{ vertices: [[-1, -1, {z}], [1, -1, {z}], [1, 1, {z}], [-1, 1, {z}]], \
             material: m{} }}",
            number % materials.len()
        );
    }
    let rays = rays.join(", ");
    let _ = writeln!(
        text,
        "sampling: {{ path_bits: 2, depths: [{rays}], lights: none }}"
    );
    text
}

fn rays(bits: u32, count: usize) -> Vec<String> {
    vec![format!("{{ bits: [{bits}, {bits}] }}"); count]
}

fn bsdf(value: &str) -> String {
    let map = r#"["sqrt(u)*cos(2*pi*v)", "sqrt(u)*sin(2*pi*v)", "sqrt(1-u)"]"#;
    format!(r#"bsdf: {{ map: {map}, jacobian: auto, value: ["{value}"] }}"#)
}

#[test]
fn circuits_of_few_faces_and_many_rays_are_refused_with_a_number() {
    let grey = ["lambertian: { albedo: [0.5, 0.5, 0.5] }".to_owned()];
    let folder = Folder::with("s.yaml", &scene(&grey, 350, &rays(8, 60)));
    for command in [
        &["render", "--model", "fixed"][..],
        &["render", "--model", "gates"],
        &["verify", "--pixels", "1"],
        &["inspect"],
        &["export", "-o", "s.qasm"],
    ] {
        let less = ["s.yaml", "--max-memory", "100M"];
        let (used, errors) = used(&folder, 2, &[command, &less].concat());
        let words = "the circuit of a scene of 351 faces and paths of 60 rays would take";
        assert!(errors.contains(words), "{command:?}: {errors}");
        assert!(errors.contains("GB of memory") || errors.contains("MB of memory"));
        assert!(
            errors.contains("or allow more with --max-memory"),
            "{errors}"
        );
        let Used { bytes, .. } = used;
        assert!(bytes < 600_000_000, "{command:?}: {bytes} bytes");
    }
    assert_eq!(folder.names(), ["s.yaml"]);
}

/// Under the product lattice rays may have no bits, so path indices do not limit the number of rays.
#[test]
fn a_path_of_very_many_rays_is_refused() {
    let grey = ["lambertian: { albedo: [0.5, 0.5, 0.5] }".to_owned()];
    let of = |count| {
        let text = scene(&grey, 1, &rays(0, count));
        text.replace("path_bits: 2", "sequence: product-lattice")
    };
    let folder = Folder::with("s.yaml", &of(1024));
    let (Used { bytes, .. }, _) = used(&folder, 0, &["render", "s.yaml", "-q", "-o", "p.exr"]);
    assert!(bytes < 200_000_000, "{bytes}");
    fs::write(folder.path("s.yaml"), of(1025)).unwrap();
    let errors = folder.fails(2, &["render", "s.yaml", "-o", "q.exr"]);
    let words = "error[QRT0504]: the depths are 1025 rays: a path has 1024 at most";
    assert!(errors.contains(words), "{errors}");
    assert!(errors.contains("--> s.yaml:"), "{errors}");
}

/// Each depth has tables of functions of a coordinate; equal depths share them, and at most 256 MB are stored.
#[test]
fn tables_of_many_materials_and_rays_fit_in_a_gigabyte() {
    let folder = Folder::new();
    let phong = |number: usize| {
        format!(
            "phong: {{ diffuse: [0.1, 0.1, 0.1], specular: [0.2, 0.2, 0.2], exponent: {} }}",
            number + 1
        )
    };
    let phongs: Vec<String> = (0..1000).map(phong).collect();
    let waves: Vec<String> = (1..100)
        .map(|k| format!("(1 + sin({k}*u))*(1 + cos({k}*v))"))
        .collect();
    let own = [bsdf(&format!("0.0001*({})", waves.join("+")))];
    // No two depths have the same bits.
    let all: Vec<String> = (0..40)
        .map(|n| format!("{{ bits: [{}, {}] }}", 8 + n % 7, 9 + n / 7))
        .collect();
    for (name, text) in [
        ("phong.yaml", scene(&phongs, 1000, &rays(14, 60))),
        ("own.yaml", scene(&own, 1, &rays(14, 60))),
        ("depths.yaml", scene(&phongs, 1000, &all)),
    ] {
        fs::write(folder.path(name), text).unwrap();
        let (Used { bytes, seconds }, _) = used(&folder, 0, &["render", name, "-o", "p.exr"]);
        println!("{name}: {bytes} bytes, {seconds} s");
        assert!(bytes < 1_000_000_000, "{name}: {bytes} bytes");
    }
}

/// The checker tests each different BSDF at some ten thousand points, for up to 76 viewers, and an equal one not
/// again.
#[test]
fn very_many_bsdfs_are_checked_or_refused_and_end_at_an_interrupt() {
    let folder = Folder::new();
    let flat = |number: usize| bsdf(&format!("{}/pi", 0.1 + number as f64 * 1e-6));
    let many: Vec<String> = (0..500).map(flat).collect();
    fs::write(folder.path("many.yaml"), scene(&many, 1, &rays(2, 2))).unwrap();
    let (many, _) = used(&folder, 0, &["render", "many.yaml", "-q", "-o", "p.exr"]);
    println!("{:.2} ms for each", 1e3 * many.seconds / 500.0);

    // Values of the greatest length.
    let longest = |number: usize| {
        let term = |k: usize| format!("cos_a^2/(1+cos_o*{}.{number})", k + 1);
        let terms: Vec<String> = (0..150).map(term).collect();
        let value = format!("0.001*({})", terms.join("+"));
        assert!(value.len() < 4096);
        bsdf(&value)
    };
    let same = vec![longest(0); 100];
    fs::write(folder.path("same.yaml"), scene(&same, 1, &rays(2, 2))).unwrap();
    let (same, _) = used(&folder, 0, &["render", "same.yaml", "-q", "-o", "p.exr"]);
    println!("{:.2} s for one of the longest", same.seconds);
    // A hundred would take minutes if each were checked.
    assert!(same.seconds < 30.0, "{} s for one", same.seconds);
    let all: Vec<String> = (0..400).map(longest).collect();
    fs::write(folder.path("long.yaml"), scene(&all, 1, &rays(2, 2))).unwrap();
    let (long, errors) = used(&folder, 2, &["render", "long.yaml", "-q"]);
    assert!(errors.contains("error[QRT0405]"), "{errors}");
    assert!(errors.contains("minutes; the limit is 10"), "{errors}");
    assert!(long.seconds < 30.0, "{} s to refuse them", long.seconds);

    // Checks that may take minutes end at an interrupt.
    fs::write(folder.path("some.yaml"), scene(&all[..60], 1, &rays(2, 2))).unwrap();
    for command in ["render", "verify"] {
        let child = folder.started(&[command, "some.yaml"]);
        std::thread::sleep(Duration::from_millis(1500));
        let start = Instant::now();
        let (code, said, errors) = signalled(child, "-INT");
        assert_eq!((code, &*said), (Some(1), ""), "{command}: {errors}");
        assert!(start.elapsed() < Duration::from_secs(5), "{command}");
    }
}

/// A comparator of 30 bits has 2^30 thresholds: gates that tried each of them would take 256 times as long as
/// with 22 bits.
#[test]
fn the_widest_comparator_costs_gates_no_more_tries() {
    let folder = Folder::new();
    let floor = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/scenes-yaml/floor-and-light.yaml"
    );
    let counted = |model: &str, bits: u32| {
        let comparator = format!("comparator.bits={bits}");
        let sets = ["--set", "sampling.path_bits=4", "--set", &comparator];
        let options = ["--model", model, "--crop", "8,8,2,2"];
        let outputs = ["-o", "picture.exr", "--counts", "counts.csv"];
        let all = [&["render", floor][..], &sets, &options, &outputs].concat();
        let (used, _) = used(&folder, 0, &all);
        (folder.read("counts.csv"), used.seconds)
    };
    let (gates, seconds) = counted("gates", 30);
    let (_, few) = counted("gates", 22);
    assert!(seconds < 8.0 * few, "{seconds} s, and {few} s with 22 bits");
    // The counts equal those by arithmetic in fixed point.
    let (fixed, _) = counted("fixed", 30);
    assert!(gates == fixed);
}
