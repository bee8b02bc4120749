//! The comparisons between compute and uncompute, on all that they can meet.

use super::{Defect, OracleCircuits};
use crate::machines::gates::Gates;
use qrt_circuit::{Circuit, Gate, Operand, Qubit, Word};
use qrt_core::oracle::{Channel, Oracle};
use std::collections::HashMap;

/// Most bits of a colour and a comparator together that are tried in all pairs. With more, every
/// colour is tried with the comparators at, next to, and far from the threshold.
const EXHAUSTIVE: u32 = 26;

/// Tries the comparison of every channel, for every colour and comparator.
///
/// # Errors
/// The first defect that shows.
pub(super) fn try_all(oracle: &Oracle, parts: &OracleCircuits) -> Result<(), Defect> {
    let flips = oracle.channels.iter().zip(&parts.flips);
    for (channel, flip) in flips {
        let flip = Flip::new(oracle, parts, channel, flip)?;
        let gates = Gates::new(&[&flip.circuit])?;
        let lanes = gates.lanes() as u64;
        let blocks = flip.pairs.count.div_ceil(lanes) as usize;
        let faults = gates.blocks(blocks, |rows, block| {
            let first = block as u64 * lanes;
            let end = (first + lanes).min(flip.pairs.count);
            let (colours, comparators): (Vec<u64>, Vec<u64>) =
                (first..end).map(|pair| flip.pairs.pair(pair)).unzip();
            rows.clear();
            rows.set(&flip.colour, &colours);
            rows.set(&flip.comparator, &comparators);
            gates.run(0, rows);
            if let Some(mut dirty) = rows.dirty(&flip.held(), colours.len()) {
                dirty.qubit = flip.names[dirty.qubit as usize];
                return Some(Defect::Dirty {
                    dirty,
                    pixel: [0, 0],
                    id: 0,
                    register: parts.name(oracle, dirty.qubit),
                });
            }
            let [mut colours_after, mut comparators_after] =
                [(); 2].map(|()| vec![0; colours.len()]);
            rows.get(&flip.colour, &mut colours_after);
            rows.get(&flip.comparator, &mut comparators_after);
            (0..colours.len()).find_map(|lane| {
                let (channel, comparator) = (channel.number, comparators[lane]);
                let count = flip.pairs.count_of(colours[lane]);
                if colours_after[lane] != colours[lane] || comparators_after[lane] != comparator {
                    return Some(Defect::Compared {
                        channel,
                        count,
                        comparator,
                    });
                }
                let flipped = rows.signs()[lane / 64] >> (lane % 64) & 1 == 1;
                let exceeds = i128::from(comparator) < i128::from(count);
                (flipped != exceeds).then_some(Defect::Flip {
                    channel,
                    count,
                    comparator,
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
    circuit: Circuit,
    colour: Vec<Qubit>,
    comparator: Vec<Qubit>,
    /// By qubit of `circuit`: the qubit that it is.
    names: Vec<Qubit>,
    pairs: Pairs,
}

impl Flip {
    fn new(
        oracle: &Oracle,
        parts: &OracleCircuits,
        channel: &Channel,
        flip: &Circuit,
    ) -> Result<Self, Defect> {
        let colour = parts.qubits(channel.count);
        let comparator = parts.register(oracle.comparator);
        let mut names = [&colour[..], comparator].concat();
        let pairs = Pairs::new(channel.count, colour.len() as u32, oracle.comparator_bits());
        let mut places: HashMap<Qubit, Qubit> = names.iter().copied().zip(0..).collect();
        // All others are zero when it begins, unless they hold something.
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
            circuit: Circuit {
                gates,
                qubits: names.len() as u32,
                parameters: flip.parameters.clone(),
                ..Circuit::default()
            },
            colour: (0..width).collect(),
            comparator: (width..width + comparator.len() as Qubit).collect(),
            names,
            pairs,
        })
    }

    /// The qubits that may hold something else than zero: the colour's and the comparator's.
    fn held(&self) -> Vec<Qubit> {
        [&self.colour[..], &self.comparator].concat()
    }
}

/// Pairs of a count register's bits and a comparator: all of them, or where these are too many, for
/// each of many colours the comparators about its threshold.
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

    fn pair(&self, number: u64) -> (u64, u64) {
        let colours = u64::MAX.checked_shr(64 - self.count_bits).unwrap_or(0);
        let comparators = (1_u64 << self.bits) - 1;
        if self.all {
            return (number & colours, number >> self.count_bits & comparators);
        }
        // Colours far apart, by a multiplier that is prime to any power of two; comparators next
        // to each one's threshold, and one far away.
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

    /// The number that a count register's bits stand for.
    fn count_of(&self, bits: u64) -> i64 {
        match self.operand {
            Operand::Constant(value) => value,
            Operand::Word(word) => Word { offset: 0, ..word }.read(bits),
        }
    }
}
