//! Priority encoders with several outputs.
//!
//! The top bit of a target is 1 once a bit has been found for it. A bit that arrives where the target
//! is taken passes on to the next target: one AND for each bit and target, into garbage. Where the
//! target is free, the bit and the passed bit differ: CNOTs from both add the entry.

use super::{Lowering, Qubit, Wire};

impl Lowering {
    pub(super) fn encode(&mut self, bits: &[Wire], entries: &[u64], targets: &[Vec<Qubit>]) {
        for (place, (bit, entry)) in bits.iter().zip(entries).enumerate() {
            let mut arrives = *bit;
            for (number, target) in targets.iter().enumerate() {
                let Some(&taken) = target.last() else {
                    return;
                };
                // Each earlier bit has taken one target at most.
                let passes = if place > number {
                    let passed = self.garbage_bit();
                    self.and(arrives, Wire::qubit(taken), passed);
                    Wire::qubit(passed)
                } else {
                    Wire::ZERO
                };
                for (index, t) in target.iter().enumerate() {
                    if entry >> index & 1 == 1 {
                        self.copy_two(arrives, passes, *t);
                    }
                }
                arrives = passes;
                if arrives == Wire::ZERO {
                    break;
                }
            }
        }
    }
}
