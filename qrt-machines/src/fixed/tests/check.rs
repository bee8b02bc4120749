//! Compares programs with their definition.

use super::maker::{Maker, PARAMETERS};
use crate::fixed::compile::negative;
use crate::fixed::contents_by_definition;
use crate::{FixedMachine, InstructionSet, PixelLanes};
use qrt_circuit::{RegisterId, Word};

impl Maker {
    /// Compares registers' contents with their definition, in every instruction set.
    pub(super) fn check(self, states: &[u64], others: &[u64]) {
        let all = 0..self.program.registers.len() as u32;
        let all: Vec<RegisterId> = all.map(RegisterId).collect();
        self.check_only(states, others, &all);
    }

    /// As [`Maker::check`], but only for some registers.
    pub(super) fn check_only(self, states: &[u64], others: &[u64], registers: &[RegisterId]) {
        let program = self.program;
        let mut dice = self.dice;
        let whole = |register: &RegisterId| Word {
            register: *register,
            offset: 0,
            width: program.width(*register),
            signed: negative(program.registers[register.index()].ty),
            shift: 0,
        };
        let outputs: Vec<Word> = registers.iter().map(whole).collect();
        let bits = self.widest.min(40);
        let pixels: Vec<[u64; PARAMETERS]> = (0..2)
            .map(|_| std::array::from_fn(|_| dice.word() >> (64 - bits)))
            .collect();
        let half = states.len() / 2;
        let spans = [(half, &pixels[0]), (states.len() - half, &pixels[1])];
        let spans = spans.map(|(lanes, parameters)| PixelLanes { lanes, parameters });
        let expected = states.iter().zip(others).enumerate();
        let expected: Vec<_> = expected
            .map(|(lane, (id, other))| {
                contents_by_definition(&program, &[*id, *other], &pixels[usize::from(lane >= half)])
            })
            .collect();
        // All registers, and then a few, so that the compiler leaves out steps, fuses steps and
        // reuses slots.
        let few: Vec<Word> = outputs
            .iter()
            .copied()
            .filter(|_| dice.below(6) == 0)
            .collect();
        let sets = InstructionSet::available().into_iter();
        for (set, outputs) in sets.flat_map(|set| [(set, &outputs), (set, &few)]) {
            let machine = FixedMachine::new(&program, outputs).with_instructions(set);
            let mut lanes = machine.lanes();
            let mut values = vec![vec![0; states.len()]; outputs.len()];
            let mut slices: Vec<&mut [i64]> = values.iter_mut().map(Vec::as_mut_slice).collect();
            machine.run(&mut lanes, &[states, others], &spans, &mut slices);
            let mut signs = vec![false; states.len()];
            machine.signs(&mut lanes, &[states, others], &spans, &mut signs);
            for (lane, expected) in expected.iter().enumerate() {
                for (output, values) in outputs.iter().zip(&values) {
                    let register = output.register.index();
                    assert_eq!(
                        values[lane],
                        output.read(expected.registers[register]),
                        "r{register} in lane {lane}, {set:?}: {:?}",
                        program.ops
                    );
                }
                assert_eq!(signs[lane], expected.negative, "lane {lane}, {set:?}");
            }
        }
    }
}
