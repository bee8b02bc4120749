//! A scene's oracle as the phase oracle of a pixel.

use super::Oracle;
use qrt_circuit::lower;
use qrt_circuit::quantum::{PhaseOracle, QuantumError};

impl Oracle {
    /// The circuit of channel number `channel` of [`Oracle::channels`] in pixel (column, row): its
    /// qubits in superposition are the path index and, above it, the comparator.
    ///
    /// # Errors
    /// No such channel.
    pub fn phase(
        &self,
        channel: usize,
        seed: u64,
        pixel: [u32; 2],
    ) -> Result<PhaseOracle, QuantumError> {
        if channel >= self.channels.len() {
            return Err(QuantumError::NoChannel(channel));
        }
        let compute = self.program.instructions.len();
        let whole = self.whole(channel);
        let flip = whole.instructions.len() - 2 * compute;
        let parts = lower::parts(&whole, &[compute, compute + flip]);
        let [compute, flip, uncompute] = &parts[..] else {
            return Err(QuantumError::NoIds);
        };
        let words = self.words(seed, pixel);
        let register = |register| {
            let mut inputs = compute.inputs.iter();
            let found = inputs.find(|(id, _)| *id == register);
            found.map_or(&[][..], |(_, qubits)| qubits)
        };
        let superposed = [register(self.id), register(self.comparator)].concat();
        PhaseOracle::new(compute, flip, uncompute, superposed, &words)
    }
}
