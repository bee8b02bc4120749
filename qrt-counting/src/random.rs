//! Random numbers, and the guarantees of a seed.
//!
//! # Seed policy
//!
//! Every random number that qrt uses is a pure function of
//! `(seed, pixel x, pixel y, channel, position)`. It does not depend on threads, tiles, crops or
//! other draws. A [`Stream`] holds the first four; shots read it in order, starting at position 0.
//! The same seed gives the same picture on every machine and for any number of threads, within one
//! minor version of qrt. If a release changes the position at which a draw is read, its changelog
//! says so.
//!
//! The generator is Philox4x32-10 (Salmon, Moraes, Dror & Shaw, *Parallel random numbers: as easy
//! as 1, 2, 3*, SC 2011): a keyed bijection of 128-bit counters that passes `BigCrush`. The key is
//! the seed; the counter is `[block (low), y, x, channel + 256 * block (high)]`, so that no two
//! streams of one seed ever share a counter. The draws of a path read the part of its pixel's
//! stream that begins at block `path 2^16`. A separate stream, with 128 added to the channel, draws
//! the paths to which the measured indices belong.

const MULTIPLIERS: [u32; 2] = [0xD251_1F53, 0xCD9E_8D57];
const WEYL: [u32; 2] = [0x9E37_79B9, 0xBB67_AE85];

/// A bit that no channel's number has set. It distinguishes a separate stream from the channel's
/// own.
const BESIDE: u8 = 0x80;

fn wide(a: u32, b: u32) -> (u32, u32) {
    let product = u64::from(a) * u64::from(b);
    ((product >> 32) as u32, product as u32)
}

fn philox4x32(mut counter: [u32; 4], mut key: [u32; 2]) -> [u32; 4] {
    for _ in 0..10 {
        let (high0, low0) = wide(MULTIPLIERS[0], counter[0]);
        let (high1, low1) = wide(MULTIPLIERS[1], counter[2]);
        counter = [
            high1 ^ counter[1] ^ key[0],
            low1,
            high0 ^ counter[3] ^ key[1],
            low0,
        ];
        key = [key[0].wrapping_add(WEYL[0]), key[1].wrapping_add(WEYL[1])];
    }
    counter
}

/// The random numbers of one pixel and channel. See the [module](self) for the seed policy.
///
/// ```
/// use qrt_counting::random::Stream;
/// let mut here = Stream::new(7, 3, 5, 0);
/// let mut again = Stream::new(7, 3, 5, 0);
/// assert_eq!(here.next_u64(), again.next_u64());
/// ```
#[derive(Clone, Debug)]
pub struct Stream {
    key: [u32; 2],
    x: u32,
    y: u32,
    channel: u8,
    block: u64,
    spare: Option<u64>,
}

impl Stream {
    /// The stream of pixel (`x`, `y`) and `channel` (0 red, 1 green, 2 blue) under `seed`.
    pub fn new(seed: u64, x: u32, y: u32, channel: u8) -> Self {
        Self {
            key: [seed as u32, (seed >> 32) as u32],
            x,
            y,
            channel,
            block: 0,
            spare: None,
        }
    }

    /// The part of the stream that belongs to `path` alone: 2^17 draws, for path indices below
    /// 2^40.
    pub fn of_path(seed: u64, x: u32, y: u32, channel: u8, path: u64) -> Self {
        Self {
            block: path << 16,
            ..Self::new(seed, x, y, channel)
        }
    }

    /// Returns another stream of the same pixel and channel, at the same position. Draws from it do
    /// not change the draws from this stream.
    pub(crate) fn beside(&self) -> Self {
        Self {
            channel: self.channel ^ BESIDE,
            spare: None,
            ..self.clone()
        }
    }

    /// The next 64 random bits of the stream.
    pub fn next_u64(&mut self) -> u64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        // 2^56 blocks: a stream read at 10^9 numbers a second repeats after four years.
        let high = (self.block >> 32) as u32;
        let last = u32::from(self.channel) | (high << 8);
        let words = philox4x32([self.block as u32, self.y, self.x, last], self.key);
        self.block = self.block.wrapping_add(1);
        self.spare = Some(u64::from(words[2]) | (u64::from(words[3]) << 32));
        u64::from(words[0]) | (u64::from(words[1]) << 32)
    }

    /// Returns a uniform number in [0, 1), a multiple of 2^-53.
    pub fn uniform(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
    }

    /// Returns a uniform number in `0..limit`, to one part in 2^64 / `limit`; 0 if `limit` is 0.
    pub fn below(&mut self, limit: u64) -> u64 {
        ((u128::from(self.next_u64()) * u128::from(limit)) >> 64) as u64
    }

    /// Returns a uniform number in (0, 1] that has 53 significant bits however small it is (down to
    /// 2^-75). The inverse of a heavy-tailed distribution needs this precision where its tail is
    /// thinnest.
    pub fn fine_uniform(&mut self) -> f64 {
        const SCALE: f64 = 1.0 / 18_446_744_073_709_551_616.0;
        let high = self.next_u64();
        let low = self.next_u64();
        (high as f64 + (low as f64 + 0.5) * SCALE) * SCALE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The known answers that ship with Random123, the generator's reference implementation.
    #[test]
    fn philox_gives_the_published_answers() {
        assert_eq!(
            philox4x32([0; 4], [0; 2]),
            [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]
        );
        assert_eq!(
            philox4x32([u32::MAX; 4], [u32::MAX; 2]),
            [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]
        );
        assert_eq!(
            philox4x32(
                [0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344],
                [0xa409_3822, 0x299f_31d0]
            ),
            [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1]
        );
    }

    #[test]
    fn streams_of_different_pixels_channels_and_seeds_differ() {
        let mut firsts = std::collections::HashSet::new();
        for seed in 0..4 {
            for x in 0..8 {
                for y in 0..8 {
                    for channel in 0..3 {
                        let mut stream = Stream::new(seed, x, y, channel);
                        assert!(firsts.insert((stream.next_u64(), stream.next_u64())));
                    }
                }
            }
        }
    }

    #[test]
    fn uniforms_stay_in_range_and_have_the_right_moments() {
        let mut stream = Stream::new(1, 0, 0, 0);
        let count = 200_000;
        let (mut sum, mut square) = (0.0, 0.0);
        for _ in 0..count {
            let u = stream.uniform();
            let fine = stream.fine_uniform();
            assert!((0.0..1.0).contains(&u));
            assert!(fine > 0.0 && fine <= 1.0);
            sum += u - fine;
            square += u * u;
        }
        // Standard errors: sqrt(1/6/n) and sqrt(4/45/n).
        let n = f64::from(count);
        assert!((sum / n).abs() < 5.0 * (1.0 / 6.0 / n).sqrt());
        assert!((square / n - 1.0 / 3.0).abs() < 5.0 * (4.0 / 45.0 / n).sqrt());
    }
}
