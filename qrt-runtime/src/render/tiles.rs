//! How a picture is cut into tiles. Nothing in a picture depends on it.

use crate::checkpoint::Tile;

/// Paths that a tile is cut to have about: some 10 to 100 ms of work.
const PATHS: u64 = 1 << 17;
/// Pixels of the largest tile: with few paths a pixel, estimating takes longer than tracing.
const PIXELS: u64 = 256;

/// A rectangle of the film cut into tiles, numbered row by row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tiles {
    crop: [u32; 4],
    size: [u32; 2],
}

impl Tiles {
    /// `crop` (x, y, width, height) in tiles of `size`, or of a size that suits the number of
    /// paths a pixel.
    pub(super) fn new(crop: [u32; 4], size: Option<[u32; 2]>, paths: u64) -> Self {
        let size = size.unwrap_or_else(|| {
            let bits = (PATHS / paths.max(1)).clamp(1, PIXELS).ilog2();
            [1 << bits.div_ceil(2), 1 << (bits / 2)]
        });
        Self {
            crop,
            size: size.map(|side| side.max(1)),
        }
    }

    /// How many there are.
    pub(super) fn count(&self) -> u64 {
        let [columns, rows] = self.columns_rows();
        u64::from(columns) * u64::from(rows)
    }

    fn columns_rows(&self) -> [u32; 2] {
        let [_, _, width, height] = self.crop;
        [width.div_ceil(self.size[0]), height.div_ceil(self.size[1])]
    }

    /// Tile `number`: x, y, width, height on the film.
    pub(super) fn rectangle(&self, number: u64) -> [u32; 4] {
        let [x, y, width, height] = self.crop;
        let columns = u64::from(self.columns_rows()[0].max(1));
        // Both below the crop's sides, so that nothing is cut off.
        let left = (number % columns) as u32 * self.size[0];
        let top = (number / columns) as u32 * self.size[1];
        let (right, bottom) = (width - left, height - top);
        [
            x + left,
            y + top,
            right.min(self.size[0]),
            bottom.min(self.size[1]),
        ]
    }
}

/// The pixels of a rectangle, row by row, as [x, y].
pub(super) fn pixels([x, y, width, height]: [u32; 4]) -> impl Iterator<Item = [u32; 2]> {
    (y..y + height).flat_map(move |y| (x..x + width).map(move |x| [x, y]))
}

/// Where the pixels of `tile` are in a picture of `crop`, row by row.
pub(super) fn rows(tile: &Tile, crop: [u32; 4]) -> impl Iterator<Item = std::ops::Range<usize>> {
    let (left, top) = ((tile.x - crop[0]) as usize, (tile.y - crop[1]) as usize);
    let (width, height) = (tile.width as usize, tile.height as usize);
    let whole = crop[2] as usize;
    (0..height).map(move |row| {
        let first = (top + row) * whole + left;
        first..first + width
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_is_in_one_tile() {
        for crop in [[0, 0, 1, 1], [3, 5, 17, 9], [0, 0, 64, 64]] {
            for (size, paths) in [
                (Some([1, 1]), 1),
                (Some([5, 3]), 1),
                (None, 1),
                (None, 1 << 12),
            ] {
                let tiles = Tiles::new(crop, size, paths);
                let mut seen: Vec<[u32; 2]> = (0..tiles.count())
                    .flat_map(|n| pixels(tiles.rectangle(n)))
                    .collect();
                seen.sort_unstable_by_key(|[x, y]| [*y, *x]);
                assert_eq!(seen, pixels(crop).collect::<Vec<_>>());
            }
        }
    }

    #[test]
    fn more_paths_make_smaller_tiles() {
        let area = |paths| {
            let [_, _, width, height] = Tiles::new([0, 0, 99, 99], None, paths).rectangle(0);
            width * height
        };
        assert_eq!([1, 1 << 12, 1 << 17, 1 << 40].map(area), [256, 32, 1, 1]);
    }
}
