//! A scene's oracle as the phase oracle of a pixel.

use super::Oracle;
use crate::compile::{Label, StageName};
use qrt_circuit::quantum::{LevelPhases, PhaseOracle, QuantumError};
use qrt_circuit::{
    Bit, BlockId, Instruction, Op, Operand, Program, Register, RegisterId, Style, Type, Word, lower,
};
use std::sync::Arc;

/// Most bits in registers of a circuit whose gates are stored.
pub const MOST_BITS: u64 = 1 << 19;

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
        let first = program.ops.len() as u32;
        let bits = phases.bits();
        let mask = (1_i64 << bits) - 1;
        let entry = |count: i64| phases.word(self.good(count)) & mask;
        let (address, entries): (Vec<Bit>, Arc<[i64]>) = match channel.count {
            Operand::Constant(count) => (Vec::new(), [entry(count)].into()),
            Operand::Word(count) => {
                let (address, entries) = level(&mut program, count, phases.level_bits());
                let entries = (0..entries).map(|level| entry(level << count.shift));
                (address, entries.collect())
            }
        };
        // All paths have one level. A table has an address, whatever it holds.
        let (address, entries) = match &entries[..] {
            [one] => (vec![Bit::at(self.id, 0)], [*one; 2].into()),
            _ => (address, entries),
        };
        let word = register(&mut program, "phase", Type::UInt, bits);
        let scratch = register(&mut program, "phase.scratch", Type::Scratch, 0);
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
        let computed = first..program.ops.len() as u32;
        let turns = (0..bits).map(|bit| Op::Phase {
            bit: Bit::at(word, bit),
        });
        program.ops.extend(turns);
        let undo = self.program.inverse().instructions;
        let step = |inverse| move |op| Instruction { op, inverse, block };
        let flips = computed.end..program.ops.len() as u32;
        let steps = computed.clone().chain(flips).map(step(false));
        program.instructions.extend(steps);
        program.instructions.extend(computed.rev().map(step(true)));
        program.instructions.extend(undo);
        Ok(program)
    }
}

fn register(program: &mut Program, name: &str, ty: Type, width: u32) -> RegisterId {
    let id = RegisterId(program.registers.len() as u32);
    program.registers.push(Register::new(name, ty, width));
    id
}

/// Appends operations that bound a count to the levels `0 ..= 2^level_bits`; returns the bits of the level, without
/// the zeros below a count's bits, and the number of levels.
///
/// A level of all thresholds has its top bit alone, so a table of all levels has `2^level_bits + 1` entries.
fn level(program: &mut Program, count: Word, level_bits: u32) -> (Vec<Bit>, i64) {
    let mut and = |a: Bit, b: Bit| {
        let target = register(program, "level.bit", Type::Bool, 1);
        program.ops.push(Op::And { a, b, target });
        Bit::at(target, 0)
    };
    let bit = |bit: u32| Bit::at(count.register, count.offset + bit);
    let not = |bit: Bit| Bit {
        inverted: !bit.inverted,
        ..bit
    };
    let magnitude = count.width - u32::from(count.signed);
    let width = magnitude.min(level_bits.saturating_sub(count.shift));
    // `below`: no bit above the level is set. `positive`: the count is not negative.
    let above = (width..magnitude).map(|high| not(bit(high)));
    let below = above.reduce(&mut and);
    let positive = count.signed.then(|| not(bit(magnitude)));
    let all = below.map(|below| match positive {
        Some(positive) => and(not(below), positive),
        None => not(below),
    });
    let mut address: Vec<Bit> = (0..width).map(bit).collect();
    let inside = match (below, positive) {
        (Some(below), Some(positive)) if width > 0 => Some(and(below, positive)),
        (one, other) => one.or(other),
    };
    if let Some(when) = inside.filter(|_| width > 0) {
        let target = register(program, "level", Type::UInt, width);
        let low = Word::unsigned(count.register, count.offset, width);
        program.ops.push(Op::Select {
            when,
            a: Operand::Word(low),
            b: Operand::Constant(0),
            target,
        });
        address = (0..width).map(|bit| Bit::at(target, bit)).collect();
    }
    address.extend(all);
    (address, (1 << width) + i64::from(all.is_some()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oracle::OracleOptions;
    use qrt_circuit::Contents;
    use qrt_circuit::quantum::QuantumGate;
    use qrt_scene::front::parse;

    /// Counts of all widths, with a sign and without: those below 0 have level 0, those above all thresholds the highest.
    #[test]
    fn counts_beyond_the_levels_have_the_first_and_the_last() {
        for (width, signed, level_bits, shift) in [
            (4, false, 4, 0),
            (5, false, 4, 0),
            (5, true, 4, 0),
            (6, true, 4, 0),
            (7, false, 4, 0),
            (8, true, 3, 1),
            (3, true, 5, 2),
            (2, true, 0, 0),
            (1, true, 2, 0),
            (3, false, 2, 4),
        ] {
            let mut program = Program::default();
            let input = register(&mut program, "count", Type::UInt, width);
            program.inputs.push(input);
            let count = Word {
                signed,
                shift,
                ..Word::unsigned(input, 0, width)
            };
            let (address, levels) = level(&mut program, count, level_bits);
            for read in 0..1 << width {
                let mut contents = Contents::new(&program, &[read], &[]);
                program.ops.iter().for_each(|op| contents.compute(op));
                let place = address.iter().rev().fold(0, |place, bit| {
                    2 * place + i64::from(bit.read(contents.registers[bit.register.index()]))
                });
                let expected = count.read(read).clamp(0, 1 << level_bits);
                assert!(place < levels);
                // The entry above the last level is that of all thresholds.
                let found = (place << shift).min(1 << level_bits);
                assert_eq!(
                    found, expected,
                    "{width}, {signed}, {level_bits}, {shift}: {read}"
                );
            }
        }
    }

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
