//! A scene's oracle as the phase oracle of a pixel.

use super::Oracle;
use crate::compile::{Label, StageName};
use qrt_circuit::quantum::{LevelPhases, MAX_LEVEL_BITS, PhaseOracle, QuantumError};
use qrt_circuit::{
    Bit, BlockId, Instruction, Op, Operand, Program, Register, RegisterId, Style, Type, lower,
};
use std::sync::Arc;

/// Most bits in registers of a circuit whose gates are stored.
pub const MOST_BITS: u64 = 1 << 19;

/// Most bits of a count whose phase is looked up: those of a level, one for a count of all thresholds,
/// and a sign.
const ADDRESS_BITS: u32 = MAX_LEVEL_BITS + 2;

impl Oracle {
    /// The circuit of channel number `channel` of [`Oracle::channels`] in pixel (column, row): its
    /// qubits in superposition are the path index and, above it, the comparator.
    ///
    /// If the registers have more than [`MOST_BITS`] bits, the gates are not stored, but generated
    /// in each call: [`PhaseOracle::lowered`].
    ///
    /// # Errors
    /// The oracle has no channel of that number.
    pub fn phase(
        &self,
        channel: usize,
        seed: u64,
        pixel: [u32; 2],
    ) -> Result<PhaseOracle, QuantumError> {
        if channel >= self.channels.len() {
            return Err(QuantumError::NoChannel(channel));
        }
        let whole = self.whole(channel);
        let words = self.parameter_words(seed, pixel);
        self.placed(whole, &[self.id, self.comparator], &words)
    }

    /// The phase oracle of a program that computes, flips and uncomputes; the registers `index` are in
    /// superposition.
    fn placed(
        &self,
        whole: Program,
        index: &[RegisterId],
        words: &[u64],
    ) -> Result<PhaseOracle, QuantumError> {
        let widths = whole.registers.iter();
        let bits: u64 = widths.map(|register| u64::from(register.width)).sum();
        if bits > MOST_BITS {
            return PhaseOracle::lowered(whole, index, words);
        }
        let compute = self.program.instructions.len();
        let flip = whole.instructions.len() - 2 * compute;
        let parts = lower::parts(&whole, &[compute, compute + flip]);
        let [compute, flip, uncompute] = &parts[..] else {
            return Err(QuantumError::NoIndex);
        };
        let qubits = index.iter().flat_map(|register| {
            let mut inputs = compute.inputs.iter();
            let found = inputs.find(|(id, _)| id == register);
            found.map_or(&[][..], |(_, qubits)| qubits)
        });
        PhaseOracle::new(compute, flip, uncompute, qubits.copied().collect(), words)
    }

    /// The circuit of the phases of levels, of channel number `channel` in pixel (column, row): an
    /// oracle without a comparator, whose qubits in superposition are the path index.
    ///
    /// It computes a path's colour, looks the phase of its level up, flips the sign of each bit of
    /// that phase, bit 0 first, and uncomputes all:
    /// [`MeanPhaseCircuit`](qrt_circuit::quantum::MeanPhaseCircuit) turns these signs into phases.
    ///
    /// # Errors
    /// The oracle has no channel of that number, levels of another number of bits, or a single path.
    pub fn level_phases(
        &self,
        channel: usize,
        seed: u64,
        pixel: [u32; 2],
        phases: &LevelPhases,
    ) -> Result<PhaseOracle, QuantumError> {
        let whole = self.look_up(channel, phases)?;
        let words = self.parameter_words(seed, pixel);
        self.placed(whole, &[self.id], &words)
    }

    /// The program of [`Oracle::level_phases`].
    fn look_up(&self, channel: usize, phases: &LevelPhases) -> Result<Program, QuantumError> {
        if self.points.path_bits() == 0 {
            return Err(QuantumError::NoIndex);
        }
        let channel = (self.channels.get(channel)).ok_or(QuantumError::NoChannel(channel))?;
        if phases.level_bits() != self.comparator_bits() {
            return Err(QuantumError::LevelBits);
        }
        let mut program = self.program.clone();
        program.inputs.retain(|input| *input != self.comparator);
        let block = BlockId(program.blocks.len() as u32);
        let label = Label {
            stage: StageName::LevelPhase,
            depth: None,
        };
        program.blocks.push(label.block(Some(BlockId::ROOT)));
        let bits = phases.bits();
        let word = RegisterId(program.registers.len() as u32);
        let scratch = RegisterId(word.0 + 1);
        program
            .registers
            .push(Register::new("phase", Type::UInt, bits));
        program
            .registers
            .push(Register::new("phase.scratch", Type::Scratch, 0));
        let mask = (1_i64 << bits) - 1;
        let entry = |count: i64| phases.word(self.good(count)) & mask;
        let first = program.ops.len() as u32;
        let (address, entries): (Vec<Bit>, Arc<[i64]>) = match channel.count {
            // All paths have one level. A table has an address, whatever it holds.
            Operand::Constant(count) => (vec![Bit::at(self.id, 0)], [entry(count); 2].into()),
            Operand::Word(word) => {
                if word.width > ADDRESS_BITS {
                    return Err(QuantumError::LevelBits);
                }
                let bits = (0..word.width).map(|bit| Bit::at(word.register, word.offset + bit));
                let sign = if word.signed { 1 << word.width >> 1 } else { 0 };
                let count = |address: i64| ((address ^ sign) - sign) << word.shift;
                let entries = (0..1_i64 << word.width).map(|address| entry(count(address)));
                (bits.collect(), entries.collect())
            }
        };
        let columns = vec![entries];
        let look_up = Op::Table {
            low: lower::best_low(address.len() as u32, &columns),
            address: address.into(),
            columns: columns.into(),
            style: Style::OutOfPlace,
            targets: Box::new([word]),
            scratch,
        };
        let width = |register: RegisterId| program.registers[register.index()].width;
        let garbage = lower::scratch_width(&look_up, width);
        program.registers[scratch.index()].width = garbage;
        program.ops.push(look_up);
        let turns = (0..bits).map(|bit| Op::Phase {
            bit: Bit::at(word, bit),
        });
        program.ops.extend(turns);
        let undo = self.program.inverse().instructions;
        let step = |op: u32, inverse| Instruction {
            op: first + op,
            inverse,
            block,
        };
        let steps = (0..=bits).map(|op| step(op, false));
        program.instructions.extend(steps);
        program.instructions.push(step(0, true));
        program.instructions.extend(undo);
        Ok(program)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oracle::OracleOptions;
    use qrt_circuit::quantum::QuantumGate;
    use qrt_scene::front::parse;

    #[test]
    fn gates_that_are_not_held_are_those_that_are() {
        let text = include_str!("../../../scenes-yaml/floor-and-light.yaml");
        let short = ["precision.fraction=8", "comparator.bits=4"].map(String::from);
        let scene = parse(text, "floor.yaml", &short, "".as_ref());
        let scene = scene.unwrap().valid;
        let oracle = Oracle::rgb(&scene, OracleOptions::default()).unwrap();
        let gates = |oracle: &PhaseOracle, control| {
            let mut all = Vec::new();
            let done = oracle.apply(control, &mut |gate: QuantumGate<'_>| {
                all.push(format!("{gate:?}"));
                Ok::<(), ()>(())
            });
            done.unwrap();
            all
        };
        for channel in 0..3 {
            let held = oracle.phase(channel, 7, [2, 1]).unwrap();
            let words = oracle.parameter_words(7, [2, 1]);
            let inputs = [oracle.id, oracle.comparator];
            let lowered = PhaseOracle::lowered(oracle.whole(channel), &inputs, &words).unwrap();
            assert_eq!(lowered.superposed(), held.superposed());
            assert_eq!(lowered.index(), held.index());
            assert_eq!(lowered.qubits(), held.qubits());
            assert_eq!(lowered.gates(), held.gates());
            for control in [None, Some(held.qubits())] {
                let all = gates(&lowered, control);
                assert_eq!(all.len() as u64, held.gates());
                assert!(all == gates(&held, control));
            }
            let less = &words[..words.len() - 1];
            let missing = PhaseOracle::lowered(oracle.whole(channel), &inputs, less);
            assert!(matches!(missing, Err(QuantumError::MissingWord { .. })));
        }
    }
}
