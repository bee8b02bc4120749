//! Scenes and their paths, as the machines and the definition of operations compute them.

pub(crate) mod simulator;

use qrt::circuit::{Operand, Word};
use qrt::core::oracle::{Oracle, OracleOptions};
use qrt::runtime::path_machines::{Defect, OracleMachine};
use qrt::scene::valid::ValidScene;
use std::sync::Arc;

/// A floor, a coloured wall and a lamp; 4 x 3 pixels of 2^5 paths of two rays. The scene is small enough
/// to test all of it.
pub(crate) const CORNER: &str = "\
name: corner
camera: { perspective: { eye: [0.3, 1.2, -3], target: [0, 0.8, 0], up: [0, 1, 0], vfov: 50 } }
film: { width: 4, height: 3 }
materials:
  floor: { lambertian: { albedo: [0.8, 0.6, 0.3] } }
  wall: { lambertian: { albedo: [0.2, 0.5, 0.7] } }
  lamp: { emitter: { radiance: [3, 2, 1], albedo: [0.2, 0.2, 0.2] } }
geometry:
  - quad: { vertices: [[-2, 0, -2], [-2, 0, 2], [2, 0, 2], [2, 0, -2]], material: floor }
  - quad: { vertices: [[-2, 0, 1], [-2, 2, 1], [2, 2, 1], [2, 0, 1]], material: wall }
  - quad: { vertices: [[-1, 2, -1], [1, 2, -1], [1, 2, 1], [-1, 2, 1]], material: lamp }
sampling:
  path_bits: 5
  lights: none
  depths: [{ bits: [4, 4] }, { bits: [4, 4] }]
precision: { fraction: 8 }
comparator: { bits: 4 }
";

pub(crate) fn oracle(scene: &ValidScene) -> Arc<Oracle> {
    Arc::new(Oracle::rgb(scene, OracleOptions::default()).unwrap())
}

/// Returns all pixels of the oracle's film, row by row.
pub(crate) fn film(oracle: &Oracle) -> Vec<[u32; 2]> {
    let [width, height] = oracle.film;
    (0..height)
        .flat_map(|y| (0..width).map(move |x| [x, y]))
        .collect()
}

/// Colour and count of every path, by channel; pixel by pixel, and by path index.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Paths {
    pub(crate) colours: [Vec<i64>; 3],
    pub(crate) good: [Vec<i64>; 3],
}

/// Computes all paths of `pixels` on a machine.
pub(crate) fn paths(machine: &OracleMachine, pixels: &[[u32; 2]]) -> Result<Paths, Defect> {
    let mut paths = Paths::default();
    let mut expected = (0, 0);
    machine.trace(pixels, 0..machine.paths(), |finished| {
        assert_eq!((finished.pixel, finished.first_id), expected);
        let end = finished.first_id + finished.good[0].len() as u64;
        expected = if end == machine.paths() {
            (finished.pixel + 1, 0)
        } else {
            (finished.pixel, end)
        };
        for c in 0..3 {
            paths.colours[c].extend_from_slice(finished.colours[c]);
            paths.good[c].extend_from_slice(finished.good[c]);
        }
    })?;
    assert_eq!(expected, (pixels.len(), 0));
    Ok(paths)
}

/// Returns the program's inputs for a path: its index, and 0 as the comparator.
pub(crate) fn inputs(oracle: &Oracle, id: u64) -> Vec<u64> {
    let inputs = oracle.program.inputs.iter();
    inputs
        .map(|input| if *input == oracle.id { id } else { 0 })
        .collect()
}

/// Returns the value of an operand, given the registers.
pub(crate) fn number(operand: Operand, registers: &[u64]) -> i64 {
    match operand {
        Operand::Constant(value) => value,
        Operand::Word(word) => word.read(registers[word.register.index()]),
    }
}

pub(crate) fn word(operand: Operand) -> Option<Word> {
    match operand {
        Operand::Word(word) => Some(word),
        Operand::Constant(_) => None,
    }
}
