//! Pseudorandom numbers for tests, the same in each run.

/// A linear congruential generator of pseudorandom numbers.
pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    /// Returns a number below `count`, or 0 if `count` is 0.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 33) as usize % count.max(1)
    }
}
