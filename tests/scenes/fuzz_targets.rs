//! Runs the fuzzer's targets on the corpora of this repository, and on mutations of them that are the same each time.

use crate::numbers::Numbers;
use crate::targets;
use std::fs;
use std::path::Path;

/// Returns the files of `folders` in the repository.
fn corpus(folders: &[&str], ends: &[&str]) -> Vec<Vec<u8>> {
    let mut paths = Vec::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    // The fuzzer's own package runs this test, too.
    let root = if root.ends_with("fuzz") {
        root.join("..")
    } else {
        root.to_path_buf()
    };
    for folder in folders {
        let entries = fs::read_dir(root.join(folder)).unwrap();
        paths.extend(entries.map(|entry| entry.unwrap().path()));
    }
    let wanted = |path: &Path| {
        ends.iter()
            .any(|end| path.extension().is_some_and(|e| e == *end))
    };
    paths.retain(|path| wanted(path));
    paths.sort();
    let read = |path: &std::path::PathBuf| fs::read(path).unwrap();
    paths
        .iter()
        .map(read)
        .filter(|bytes| bytes.len() < 10_000)
        .collect()
}

/// Calls `target` on every seed, and `times` times on one with a few bytes changed, left out, or taken from another.
fn tried(target: fn(&[u8]), seeds: &[Vec<u8>], times: usize) {
    for seed in seeds {
        target(seed);
    }
    let mut numbers = Numbers(1);
    for _ in 0..times {
        let mut bytes = seeds[numbers.below(seeds.len())].clone();
        for _ in 0..=numbers.below(4) {
            let at = numbers.below(bytes.len());
            let other = &seeds[numbers.below(seeds.len())];
            let from = numbers.below(other.len());
            let piece = &other[from..(from + numbers.below(16)).min(other.len())];
            match numbers.below(4) {
                0 if at < bytes.len() => bytes[at] = numbers.below(256) as u8,
                1 => drop(bytes.splice(
                    at.min(bytes.len())..at.min(bytes.len()),
                    piece.iter().copied(),
                )),
                2 if at < bytes.len() => drop(bytes.drain(at..(at + 8).min(bytes.len()))),
                _ => bytes.truncate(bytes.len().max(at)),
            }
        }
        target(&bytes);
    }
}

#[test]
fn scenes() {
    tried(
        targets::scene,
        &corpus(&["tests/good_scenes", "tests/bad_scenes"], &["yaml"]),
        400,
    );
}

#[test]
fn meshes() {
    let mut seeds = corpus(&["tests/bad_scenes/meshes", "tests/good_scenes"], &["obj"]);
    seeds.push(
        b"mtllib any.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n\0newmtl a\nKd 1 1 1\n"
            .to_vec(),
    );
    seeds.push(
        b"v 0 0 0 # from parts\\left\\\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 \\\n 4 4 \\\n# c:\\\nf 1 3 4 1\n".to_vec(),
    );
    tried(targets::mesh, &seeds, 2000);
}

#[test]
fn other_meshes() {
    let seeds = |end: &'static str, first: u8| {
        let files = corpus(&["tests/bad_scenes/meshes", "tests/good_scenes"], &[end]);
        let seed = move |file: Vec<u8>| [&[first], &file[..]].concat();
        files.into_iter().map(seed)
    };
    let seeds: Vec<Vec<u8>> = seeds("ply", 0).chain(seeds("gltf", 1)).collect();
    tried(targets::other_mesh, &seeds, 2000);
}

#[test]
fn expressions() {
    let seeds = corpus(&["fuzz/seeds/expression"], &["txt"]);
    tried(targets::expression, &seeds, 2000);
}

#[test]
fn programs() {
    let mut numbers = Numbers(2);
    let seeds: Vec<Vec<u8>> = (0..200)
        .map(|_| (0..80).map(|_| numbers.below(256) as u8).collect())
        .collect();
    tried(targets::program, &seeds, 800);
}

#[test]
fn openqasm() {
    let mut numbers = Numbers(3);
    let mut seeds: Vec<Vec<u8>> = (0..100)
        .map(|_| (0..80).map(|_| numbers.below(256) as u8).collect())
        .collect();
    // The sum of both inputs, with a word of the language as the name of all registers.
    for word in ["input", "bit", "swap", "work", "in", "measure"] {
        let name = [&[word.len() as u8][..], word.as_bytes()].concat();
        let sum = vec![0, 3, 4, 0, 0, 0, 3, 0, 1, 0, 3, 0, 1];
        seeds.push([sum, name.repeat(3)].concat());
    }
    tried(targets::openqasm, &seeds, 800);
}

/// Returns a tile of one pixel.
fn tile(x: u8, y: u8) -> Vec<u8> {
    let place = [0, 0, 0, 0, x, 0, 0, 0, y, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0];
    [&place[..], &[7; 83]].concat()
}

fn part(x: u8, number: u8) -> Vec<u8> {
    let place = [1, 0, 0, 0, x, 0, 0, 0, 1, 0, 0, 0];
    let number = [number, 0, 0, 0, 0, 0, 0, 0];
    [&place[..], &number, &[3; 8], &[1, 0, 0, 0], &[9; 8]].concat()
}

/// Returns the last record of a part of a picture, with a text and an empty scene as properties.
fn ending() -> Vec<u8> {
    [&[2, 0, 0, 0, 6, 0, 0, 0][..], &[4], b"hash", &[0]].concat()
}

#[test]
fn checkpoints() {
    let both = [
        tile(1, 0),
        part(2, 0),
        part(1, 1),
        tile(2, 0),
        part(1, 1),
        part(2, 3),
    ];
    let seeds = [tile(2, 1), part(1, 4), both.join(&255), ending()];
    let seeds = seeds.map(|seed| [&[0][..], &seed].concat());
    tried(targets::checkpoint, &seeds, 1000);
}

/// Headers of arbitrary words, bodies of headers, and files.
#[test]
fn headers_of_checkpoints() {
    let body = targets::header_of_the_render();
    let (magic, rest) = body.split_at(16);
    let (text, _) = rest.split_at(rest.len() - 4);
    let seeds = [
        [
            &[1][..],
            b"\x03\x02\x01\x00\x02\x02\xffany\xffmodel\xffreal\xffmodel\xfffixed",
        ]
        .concat(),
        [&[2][..], text].concat(),
        [&[3][..], &body].concat(),
        [&[3][..], magic].concat(),
    ];
    tried(targets::checkpoint, &seeds, 1000);
}
