//! A simple simulator of gates on bits: 64 states a word, independent of the machines' code.

use super::{inputs, number};
use qrt::circuit::{Gate, GateCircuit, Operand, Qubit};
use qrt::core::oracle::Oracle;

/// States of all paths of all pixels of a film, 64 to a word.
pub(crate) struct States {
    /// Words of each qubit.
    pub(crate) qubits: Vec<Vec<u64>>,
    /// Words of each bit of each parameter.
    words: Vec<Vec<Vec<u64>>>,
    /// Number of states.
    pub(crate) count: usize,
}

/// Packs bits into words, 64 to a word.
fn packed(bits: impl Iterator<Item = bool>) -> Vec<u64> {
    let mut words = Vec::new();
    for (place, bit) in bits.enumerate() {
        if place % 64 == 0 {
            words.push(0);
        }
        words[place / 64] |= u64::from(bit) << (place % 64);
    }
    words
}

impl States {
    /// Prepares the state before `circuit`, in every pixel and path: the path index, and zeros.
    pub(crate) fn new(
        oracle: &Oracle,
        circuit: &GateCircuit,
        seed: u64,
        pixels: &[[u32; 2]],
    ) -> Self {
        let paths = 1_usize << oracle.points.path_bits();
        let count = pixels.len() * paths;
        let width = count.div_ceil(64);
        let mut qubits = vec![vec![0; width]; circuit.qubits as usize];
        for (register, places) in &circuit.inputs {
            for (bit, qubit) in places.iter().enumerate() {
                qubits[*qubit as usize] = packed((0..count).map(|state| {
                    let values = inputs(oracle, (state % paths) as u64);
                    let mut known = oracle.program.inputs.iter();
                    let place = known.position(|input| input == register).unwrap();
                    values[place] >> bit & 1 == 1
                }));
            }
        }
        let of_pixels: Vec<Vec<u64>> = pixels
            .iter()
            .map(|pixel| oracle.parameter_words(seed, *pixel))
            .collect();
        let words = circuit
            .parameters
            .iter()
            .enumerate()
            .map(|(place, parameter)| {
                let bits = (0..parameter.width).map(|bit| {
                    packed((0..count).map(|state| of_pixels[state / paths][place] >> bit & 1 == 1))
                });
                bits.collect()
            });
        Self {
            qubits,
            words: words.collect(),
            count,
        }
    }

    /// Runs a gate; returns the states in which it changes a bit.
    pub(crate) fn gate(&mut self, gate: Gate) -> Vec<u64> {
        let width = self.qubits[0].len();
        let (target, flips): (Qubit, Vec<u64>) = match gate {
            Gate::X(t) => (t, vec![u64::MAX; width]),
            Gate::Cx(a, t) => (t, self.qubits[a as usize].clone()),
            Gate::Ccx(a, b, t) => {
                let (a, b) = (&self.qubits[a as usize], &self.qubits[b as usize]);
                (t, a.iter().zip(b).map(|(a, b)| a & b).collect())
            }
            Gate::Load {
                parameter,
                bit,
                target,
            } => (target, self.words[parameter as usize][bit as usize].clone()),
            Gate::Z(_) => panic!("no phases in compute"),
        };
        for (word, flip) in self.qubits[target as usize].iter_mut().zip(&flips) {
            *word ^= flip;
        }
        flips
    }

    pub(crate) fn run(&mut self, gates: &[Gate]) {
        for gate in gates {
            self.gate(*gate);
        }
    }

    /// Returns the value of an operand in every state, whose register's qubits are in `outputs`.
    pub(crate) fn numbers(&self, circuit: &GateCircuit, operand: Operand) -> Vec<i64> {
        let Operand::Word(word) = operand else {
            return vec![number(operand, &[]); self.count];
        };
        let mut held = circuit.outputs.iter();
        let places = &held.find(|(id, _)| *id == word.register).unwrap().1;
        let read = (0..self.count).map(|state| {
            let bits = places.iter().enumerate().fold(0, |bits, (bit, qubit)| {
                let row = &self.qubits[*qubit as usize];
                bits | (row[state / 64] >> (state % 64) & 1) << bit
            });
            word.read(bits)
        });
        read.collect()
    }
}

/// Returns a gate's qubits, the target last.
pub(crate) fn qubits(gate: Gate) -> Vec<Qubit> {
    match gate {
        Gate::X(t) | Gate::Load { target: t, .. } | Gate::Z(t) => vec![t],
        Gate::Cx(a, t) => vec![a, t],
        Gate::Ccx(a, b, t) => vec![a, b, t],
    }
}
