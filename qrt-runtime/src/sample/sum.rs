//! Sums over the paths of a pixel, in an order that path indices alone decide.
//!
//! Floating-point sums depend on their order. The order here is: path indices are cut into blocks
//! of 256; within a block, eight sums take every eighth path index and are then added in pairs;
//! blocks are added in order. So the sum doesn't depend on the lengths of the slices that are
//! added, and its rounding error grows with the number of blocks, not of paths.

const LANES: usize = 8;
const BLOCK: usize = 256;

/// A sum of colours, which are added in the order of their path indices.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sum {
    /// The sum of the complete blocks.
    total: f64,
    /// The sums of the current block.
    lanes: [f64; LANES],
    /// Number of path indices in the current block.
    filled: usize,
}

impl Sum {
    /// Adds the next colours.
    pub fn add(&mut self, mut colours: &[f64]) {
        while !colours.is_empty() {
            let (now, later) = colours.split_at(colours.len().min(BLOCK - self.filled));
            let lane = self.filled % LANES;
            let (first, rest) = now.split_at(now.len().min((LANES - lane) % LANES));
            for (sum, colour) in self.lanes[lane..].iter_mut().zip(first) {
                *sum += colour;
            }
            for colours in rest.chunks(LANES) {
                for (sum, colour) in self.lanes.iter_mut().zip(colours) {
                    *sum += colour;
                }
            }
            self.filled += now.len();
            if self.filled == BLOCK {
                self.total = self.value();
                self.lanes = [0.0; LANES];
                self.filled = 0;
            }
            colours = later;
        }
    }

    /// The sum so far.
    pub fn value(&self) -> f64 {
        let [a, b, c, d, e, f, g, h] = self.lanes;
        self.total + (((a + e) + (c + g)) + ((b + f) + (d + h)))
    }

    /// Number of words of an encoded sum.
    pub(crate) const WORDS: usize = LANES + 2;

    /// Encodes the state of the sum, so that it can be continued later.
    pub(crate) fn encode(&self) -> [u64; Self::WORDS] {
        let mut words = [self.filled as u64; Self::WORDS];
        words[0] = self.total.to_bits();
        for (word, lane) in words[1..].iter_mut().zip(self.lanes) {
            *word = lane.to_bits();
        }
        words
    }

    /// Decodes a sum from words; `None` if they are not those of a sum.
    pub(crate) fn decode(words: &[u64; Self::WORDS]) -> Option<Self> {
        let [total, lanes @ .., filled] = *words;
        Some(Self {
            total: f64::from_bits(total),
            lanes: lanes.map(f64::from_bits),
            filled: usize::try_from(filled).ok().filter(|n| *n < BLOCK)?,
        })
    }

    /// Adds a sum over later path indices. Sums may be appended only at block boundaries.
    pub(crate) fn append(&mut self, later: &Self) {
        self.total = self.value() + later.value();
        self.lanes = [0.0; LANES];
        self.filled = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn how_the_colours_are_handed_over_does_not_matter(
            colours in proptest::collection::vec(0.0..1e3_f64, 0..1500),
            cuts in proptest::collection::vec(1..400_usize, 1..40),
        ) {
            let mut whole = Sum::default();
            whole.add(&colours);
            let mut pieces = Sum::default();
            let mut rest = colours.as_slice();
            for &cut in cuts.iter().cycle() {
                if rest.is_empty() {
                    break;
                }
                let (now, later) = rest.split_at(cut.min(rest.len()));
                pieces.add(now);
                rest = later;
            }
            prop_assert_eq!(whole.value().to_bits(), pieces.value().to_bits());
        }
    }

    #[test]
    fn sums_of_whole_numbers_are_exact_also_in_parts() {
        let colours: Vec<f64> = (0..100_000).map(f64::from).collect();
        let mut whole = Sum::default();
        whole.add(&colours);
        assert_eq!(whole.value(), 4_999_950_000.0);
        let (mut low, mut high) = (Sum::default(), Sum::default());
        low.add(&colours[..51_200]);
        high.add(&colours[51_200..]);
        low.append(&high);
        assert_eq!(low.value(), 4_999_950_000.0);
    }

    #[test]
    fn rounding_stays_far_below_what_a_picture_shows() {
        // A plain sum of these values has a relative error of 4e-11.
        let mut sum = Sum::default();
        for _ in 0..1 << 12 {
            sum.add(&[0.1; 256]);
        }
        let exact = 0.1 * f64::from(1 << 20);
        assert!((sum.value() - exact).abs() < 1e-13 * exact);
    }
}
