//! Assignment of a block's lanes to pixels.

/// Neighbouring lanes of one pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelLanes<'a> {
    /// Number of lanes that belong to the pixel.
    pub lanes: usize,
    /// The pixel's classical parameters: one value each, in the program's order.
    pub parameters: &'a [u64],
}
