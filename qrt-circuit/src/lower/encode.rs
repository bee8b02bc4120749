//! Priority encoders with several outputs.
//!
//! The top bit of a target is 1 once a bit has been found for it. A bit that arrives where the target is taken passes
//! on to the next target: one AND for each bit and target, into garbage. Where the target is free, the bit and the
//! passed bit differ: CNOTs from both set the top bit.
//!
//! At each place, a CNOT from the top bit changes each lower bit in which the entry of the place and the next entry
//! differ; 0 follows the last entry. From the found place on, the differences add up to its entry. If entries count
//! upwards, neighbours differ in two bits on average.

use super::{Lowering, Qubit, Wire};

impl Lowering {
    pub(super) fn encode(&mut self, bits: &[Wire], entries: &[u64], targets: &[Vec<Qubit>]) {
        let tops = targets.iter().map_while(|target| target.split_last());
        let tops: Vec<(Qubit, &[Qubit])> = tops.map(|(&top, low)| (top, low)).collect();
        for (place, bit) in bits.iter().enumerate() {
            let mut arrives = *bit;
            for (number, &(taken, low)) in tops.iter().enumerate() {
                // Each earlier bit has taken one target at most.
                let passes = if place > number {
                    let passed = self.garbage_bit();
                    self.and(arrives, Wire::qubit(taken), passed);
                    Wire::qubit(passed)
                } else {
                    Wire::ZERO
                };
                self.copy_two(arrives, passes, taken);
                let after = entries.get(place + 1).copied().unwrap_or(0);
                for (index, t) in low.iter().enumerate() {
                    if (entries[place] ^ after) >> index & 1 == 1 {
                        self.copy(Wire::qubit(taken), *t);
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
