//! Pictures of an independent renderer, and their comparison with qrt's.
//!
//! The data and its conventions are described in `tests/references/README.md`.

use qrt_runtime::path_machines::Real;
use qrt_scene::valid::ValidScene;
use std::panic::resume_unwind;
use std::path::PathBuf;

/// Pixels from the top left, row by row; linear red, green, blue.
pub(crate) type Picture = Vec<[f64; 3]>;

/// Pixels along each side of the reference pictures.
pub(crate) const SIDE: u32 = 16;

/// Returns the path of a file of the reference data.
pub(crate) fn file(name: &str) -> PathBuf {
    let root = env!("CARGO_MANIFEST_DIR");
    [root, "tests", "references", name].iter().collect()
}

/// Reads the numbers of a NumPy array file: little-endian floats in C order.
///
/// Format: the magic, the version 1.0, the header's length in two bytes, and a header that contains
/// `'descr': '<f4'` or `'<f8'`, then the values.
pub(crate) fn array(name: &str) -> Vec<f64> {
    let bytes = std::fs::read(file(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\0", "{name}");
    let start = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let header = String::from_utf8_lossy(&bytes[10..start]);
    assert!(header.contains("'fortran_order': False"), "{name}");
    let values = &bytes[start..];
    if header.contains("'<f4'") {
        let value = |b: &[u8]| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
        values.chunks_exact(4).map(value).collect()
    } else {
        assert!(header.contains("'<f8'"), "{name}: {header}");
        let value = |b: &[u8]| f64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]]);
        values.chunks_exact(8).map(value).collect()
    }
}

/// A picture of the independent renderer, and its standard error.
pub(crate) struct Reference {
    pub(crate) picture: Picture,
    pub(crate) standard_error: Picture,
}

/// Reads the reference of a scene at a depth (rays on a path).
pub(crate) fn reference(scene: &str, depth: usize) -> Reference {
    let read = |suffix: &str| -> Picture {
        let values = array(&format!("{scene}_D{depth}_{SIDE}{suffix}.npy"));
        let pixels = values.chunks_exact(3).map(|p| [p[0], p[1], p[2]]);
        pixels.collect()
    };
    Reference {
        picture: read(""),
        standard_error: read("_se"),
    }
}

/// Returns the overrides for `depth` rays and `2^path_bits` paths, with 16 bits for each coordinate in the
/// pixel and `bits` for those of directions; and for those of lamps, if `lights` samples them.
pub(crate) fn asking(bits: u32, depth: usize, path_bits: u32, lights: &str) -> Vec<String> {
    let light = match lights {
        "none" => String::new(),
        _ => format!(", light: [{bits}, {bits}]"),
    };
    let directions = format!(", {{bits: [{bits}, {bits}]{light}}}").repeat(depth - 1);
    vec![
        format!("sampling.depths=[{{bits: [16, 16]}}{directions}]"),
        format!("sampling.path_bits={path_bits}"),
        format!("sampling.lights={lights}"),
    ]
}

/// Loads the scene of a file of the reference data, with overrides.
pub(crate) fn scene(name: &str, sets: &[String]) -> ValidScene {
    let path = file(&format!("{name}.yaml"));
    match qrt_scene::front::load(&path, sets) {
        Ok(loaded) => loaded.valid,
        Err(report) => panic!("{report}"),
    }
}

/// Renders a picture on a machine.
pub(crate) fn picture(real: &Real, width: u32, height: u32) -> Picture {
    let pixels: Vec<[u32; 2]> = (0..width * height)
        .map(|i| [i % width, i / width])
        .collect();
    let paths = real.paths() as f64;
    let share = pixels.len().div_ceil(cores()).max(1);
    std::thread::scope(|scope| {
        let parts: Vec<_> = pixels
            .chunks(share)
            .map(|part| scope.spawn(|| real.sums(part)))
            .collect();
        let joined = parts.into_iter().map(std::thread::ScopedJoinHandle::join);
        let sums = joined.flat_map(|part| part.unwrap_or_else(|panic| resume_unwind(panic)));
        sums.map(|sum| sum.colour.map(|c| c / paths)).collect()
    })
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Renders the picture of `scene` under `seed`.
pub(crate) fn traced(scene: &ValidScene, seed: u64) -> Picture {
    let film = scene.scene().film;
    match Real::new(scene, seed) {
        Ok(real) => picture(&real, film.width, film.height),
        Err(error) => panic!("{error}"),
    }
}

/// Returns the mean over pixels and channels.
pub(crate) fn mean(picture: &[[f64; 3]]) -> f64 {
    picture.as_flattened().iter().sum::<f64>() / (3 * picture.len()) as f64
}

/// Returns the root of the mean square over pixels and channels of `a - b`.
pub(crate) fn rms_difference(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    assert_eq!(a.len(), b.len());
    let pairs = a.as_flattened().iter().zip(b.as_flattened());
    let squares: f64 = pairs.map(|(a, b)| (a - b) * (a - b)).sum();
    (squares / (3 * a.len()) as f64).sqrt()
}
