//! Which pixels the lanes of a block belong to.

/// Neighbouring lanes of one pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span<'a> {
    /// How many lanes belong to the pixel.
    pub lanes: usize,
    /// The pixel's classical parameters: [`qrt_core::compile::PixelWord::value`] of each.
    pub parameters: &'a [u64],
}
