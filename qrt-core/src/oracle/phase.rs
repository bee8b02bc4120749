//! A scene's oracle as the phase oracle of a pixel.

use super::Oracle;
use qrt_circuit::lower;
use qrt_circuit::quantum::{PhaseOracle, QuantumError};

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
        let widths = whole.registers.iter();
        let bits: u64 = widths.map(|register| u64::from(register.width)).sum();
        if bits > MOST_BITS {
            return PhaseOracle::lowered(whole, &[self.id, self.comparator], &words);
        }
        let compute = self.program.instructions.len();
        let flip = whole.instructions.len() - 2 * compute;
        let parts = lower::parts(&whole, &[compute, compute + flip]);
        let [compute, flip, uncompute] = &parts[..] else {
            return Err(QuantumError::NoIndex);
        };
        let register = |register| {
            let mut inputs = compute.inputs.iter();
            let found = inputs.find(|(id, _)| *id == register);
            found.map_or(&[][..], |(_, qubits)| qubits)
        };
        let superposed = [register(self.id), register(self.comparator)].concat();
        PhaseOracle::new(compute, flip, uncompute, superposed, &words)
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
