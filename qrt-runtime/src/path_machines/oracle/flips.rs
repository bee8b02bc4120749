//! Tests of the comparisons between compute and uncompute, on all of their inputs.

use super::{Defect, OracleCircuits};
use qrt_circuit::{Gate, GateCircuit, Operand, Qubit, Word};
use qrt_core::oracle::{Channel, Oracle};
use qrt_machines::{GatesMachine, Rows};
use std::collections::HashMap;
use std::ops::Range;

/// Largest number of bits of a colour and a comparator together for which all pairs are tried. With
/// more bits, many colours are tried with the comparators at, next to, and far from the threshold.
const EXHAUSTIVE: u32 = 26;

/// Bits 0 to 5 of the numbers 0 to 63: bit `n` of word `k` is bit `k` of number `n`.
const COUNTING: [u64; 6] = [
    0xaaaa_aaaa_aaaa_aaaa,
    0xcccc_cccc_cccc_cccc,
    0xf0f0_f0f0_f0f0_f0f0,
    0xff00_ff00_ff00_ff00,
    0xffff_0000_ffff_0000,
    0xffff_ffff_0000_0000,
];

/// Tries the comparison of every channel, on its [`Pairs`] of a colour and a comparator.
///
/// # Errors
/// The first defect found.
pub(super) fn try_all(oracle: &Oracle, parts: &OracleCircuits) -> Result<(), Defect> {
    let flips = oracle.channels.iter().zip(&parts.flips);
    for (channel, flip) in flips {
        let flip = Flip::new(oracle, parts, channel, flip)?;
        let gates = GatesMachine::new(&[&flip.circuit])?;
        let lanes = gates.lanes() as u64;
        let blocks = flip.pairs.count.div_ceil(lanes) as usize;
        let faults = gates.blocks(blocks, |rows, block| {
            let first = block as u64 * lanes;
            let end = (first + lanes).min(flip.pairs.count);
            rows.clear();
            flip.set(rows, first..end);
            let held = flip.held();
            let before: Vec<Vec<u64>> = held.iter().map(|q| rows.bits(*q).to_vec()).collect();
            gates.run(0, rows);
            if let Some(mut dirty) = rows.dirty(&held, (end - first) as usize) {
                dirty.qubit = flip.names[dirty.qubit as usize];
                return Some(Defect::Dirty {
                    dirty,
                    pixel: [0, 0],
                    id: 0,
                    register: parts.name(oracle, dirty.qubit),
                });
            }
            let signs = rows.signs().iter().enumerate();
            signs.into_iter().find_map(|(word, signs)| {
                let first = first + 64 * word as u64;
                let expected = flip.pairs.signs(first..(first + 64).min(end));
                let changed = held.iter().zip(&before);
                let changed =
                    changed.fold(0, |any, (q, was)| any | rows.bits(*q)[word] ^ was[word]);
                let wrong = changed | (signs ^ expected);
                // The lanes after the last pair also hold a pair, but their results do not count.
                let lane = u64::from(wrong.trailing_zeros());
                if wrong == 0 || first + lane >= end {
                    return None;
                }
                let channel = channel.number;
                let (colour, comparator) = flip.pairs.pair(first + lane);
                let count = flip.pairs.count_of(colour);
                Some(if changed >> lane & 1 == 1 {
                    Defect::Compared {
                        channel,
                        count,
                        comparator,
                    }
                } else {
                    Defect::Flip {
                        channel,
                        count,
                        comparator,
                    }
                })
            })
        });
        if let Some(defect) = faults.into_iter().flatten().next() {
            return Err(defect);
        }
    }
    Ok(())
}

/// A channel's comparison, on the few qubits that it touches.
struct Flip {
    circuit: GateCircuit,
    colour: Vec<Qubit>,
    comparator: Vec<Qubit>,
    /// By qubit of `circuit`: its number in the oracle's circuits.
    names: Vec<Qubit>,
    pairs: Pairs,
}

impl Flip {
    fn new(
        oracle: &Oracle,
        parts: &OracleCircuits,
        channel: &Channel,
        flip: &GateCircuit,
    ) -> Result<Self, Defect> {
        let colour = parts.qubits(channel.count);
        let comparator = parts.register(oracle.comparator);
        let mut names = [&colour[..], comparator].concat();
        let pairs = Pairs::new(channel.count, colour.len() as u32, oracle.comparator_bits());
        let mut places: HashMap<Qubit, Qubit> = names.iter().copied().zip(0..).collect();
        // All other qubits are zero at the beginning, except those that hold the content of a
        // register.
        let held = parts.compute.outputs.iter().flat_map(|(_, qubits)| qubits);
        let mut foreign = vec![false; parts.compute.qubits as usize];
        for qubit in held.filter(|qubit| !places.contains_key(qubit)) {
            foreign[*qubit as usize] = true;
        }
        let mut place = |qubit: Qubit| {
            if foreign.get(qubit as usize) == Some(&true) {
                return Err(Defect::Foreign {
                    channel: channel.number,
                    qubit,
                    register: parts.name(oracle, qubit),
                });
            }
            Ok(*places.entry(qubit).or_insert_with(|| {
                names.push(qubit);
                names.len() as Qubit - 1
            }))
        };
        let gates = flip.gates.iter().map(|gate| {
            Ok::<_, Defect>(match *gate {
                Gate::X(t) => Gate::X(place(t)?),
                Gate::Cx(a, t) => Gate::Cx(place(a)?, place(t)?),
                Gate::Ccx(a, b, t) => Gate::Ccx(place(a)?, place(b)?, place(t)?),
                Gate::Z(t) => Gate::Z(place(t)?),
                Gate::Load {
                    parameter,
                    bit,
                    target,
                } => Gate::Load {
                    parameter,
                    bit,
                    target: place(target)?,
                },
            })
        });
        let gates = gates.collect::<Result<_, Defect>>()?;
        let width = colour.len() as Qubit;
        Ok(Self {
            circuit: GateCircuit {
                gates,
                qubits: names.len() as u32,
                parameters: flip.parameters.clone(),
                ..GateCircuit::default()
            },
            colour: (0..width).collect(),
            comparator: (width..width + comparator.len() as Qubit).collect(),
            names,
            pairs,
        })
    }

    /// Sets colour and comparator to `pairs`, one pair per lane.
    fn set(&self, rows: &mut Rows, pairs: Range<u64>) {
        if self.pairs.all {
            // From lane to lane, their bits are those of a number that counts up.
            for (bit, qubit) in self.held().into_iter().enumerate() {
                for (word, first) in rows
                    .bits_mut(qubit)
                    .iter_mut()
                    .zip((pairs.start..).step_by(64))
                {
                    *word = COUNTING
                        .get(bit)
                        .copied()
                        .unwrap_or(match first >> bit & 1 {
                            0 => 0,
                            _ => u64::MAX,
                        });
                }
            }
            return;
        }
        let pairs = pairs.map(|pair| self.pairs.pair(pair));
        let (colours, comparators): (Vec<u64>, Vec<u64>) = pairs.unzip();
        rows.set(&self.colour, &colours);
        rows.set(&self.comparator, &comparators);
    }

    /// Qubits that may be non-zero: the colour's and the comparator's.
    fn held(&self) -> Vec<Qubit> {
        [&self.colour[..], &self.comparator].concat()
    }
}

/// Pairs of a count register's bits and a comparator. If all pairs are too many, they are many
/// colours, each with comparators about its threshold.
struct Pairs {
    operand: Operand,
    count_bits: u32,
    bits: u32,
    all: bool,
    count: u64,
}

impl Pairs {
    fn new(operand: Operand, count_bits: u32, bits: u32) -> Self {
        let all = count_bits + bits <= EXHAUSTIVE;
        let count = if all {
            1 << (count_bits + bits)
        } else {
            1 << EXHAUSTIVE
        };
        Self {
            operand,
            count_bits,
            bits,
            all,
            count,
        }
    }

    /// Returns the expected signs of up to 64 pairs, the first in the lowest bit.
    fn signs(&self, pairs: Range<u64>) -> u64 {
        pairs.rev().fold(0, |signs, pair| {
            let (colour, comparator) = self.pair(pair);
            let exceeds = i128::from(comparator) < i128::from(self.count_of(colour));
            signs << 1 | u64::from(exceeds)
        })
    }

    fn pair(&self, number: u64) -> (u64, u64) {
        let colours = u64::MAX.checked_shr(64 - self.count_bits).unwrap_or(0);
        let comparators = (1_u64 << self.bits) - 1;
        if self.all {
            return (number & colours, number >> self.count_bits & comparators);
        }
        // An odd multiplier spreads the colours far apart. Each colour has three comparators next
        // to its threshold, and one far away.
        let colour = (number >> 2).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 7 & colours;
        let near = self.count_of(colour).clamp(0, i64::MAX).cast_unsigned();
        let comparator = match number & 3 {
            0 => near.wrapping_sub(1),
            1 => near,
            2 => near.wrapping_add(1),
            _ => number.wrapping_mul(0xd134_2543_de82_ef95) >> 11,
        };
        (colour, comparator & comparators)
    }

    /// Returns the number that a count register's bits stand for.
    fn count_of(&self, bits: u64) -> i64 {
        match self.operand {
            Operand::Constant(value) => value,
            Operand::Word(word) => Word { offset: 0, ..word }.read(bits),
        }
    }
}
