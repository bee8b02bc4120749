//! Cuts a picture into tiles. The tiles do not affect the picture.

use super::Portion;
use crate::checkpoint::Tile;

/// The number of paths of a tile, about: 10 to 100 ms of work.
const PATHS: u64 = 1 << 17;
/// Pixels of the largest tile: with few paths of a pixel, estimating takes longer than tracing.
const PIXELS: u64 = 256;
/// The smallest number of tiles of each portion of a picture, if it has enough pixels. With this
/// number, portions take about the same time.
const TILES: u64 = 64;

/// A rectangle of the film, cut into tiles that are numbered row by row, and the portion of the
/// tiles to render.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tiles {
    crop: [u32; 4],
    size: [u32; 2],
    portion: Portion,
    /// Number of columns by which a row of tiles is rotated relative to the row above it.
    turn: u64,
}

impl Tiles {
    /// Cuts `crop` (x, y, width, height) into tiles of `size`; if `None`, into tiles of a size that
    /// suits the number of paths of a pixel and the number of portions.
    pub(super) fn new(
        crop: [u32; 4],
        size: Option<[u32; 2]>,
        paths: u64,
        portion: Portion,
    ) -> Self {
        let count = u64::from(portion.count());
        let mut tiles = Self {
            crop,
            size: size.map_or([1, 1], |size| size.map(|side| side.max(1))),
            portion,
            turn: 0,
        };
        if size.is_none() {
            let mut bits = (PATHS / paths.max(1)).clamp(1, PIXELS).ilog2();
            loop {
                tiles.size = [1 << bits.div_ceil(2), 1 << (bits / 2)];
                if count == 1 || bits == 0 || tiles.all() >= count.saturating_mul(TILES) {
                    break;
                }
                bits -= 1;
            }
        }
        // From one row to the next, a portion's tiles shift by the golden section of the number of
        // portions.
        let columns = u64::from(tiles.columns_rows()[0].max(1));
        let step = libm::round(count as f64 * 0.382) as u64;
        tiles.turn = (columns + count - step) % count % columns;
        tiles
    }

    /// Cuts all of `crop` into tiles, as [`Tiles::new`].
    pub(super) fn whole(crop: [u32; 4], size: Option<[u32; 2]>, paths: u64) -> Self {
        Self::new(crop, size, paths, Portion::WHOLE)
    }

    /// Number of tiles of all portions.
    fn all(&self) -> u64 {
        let [columns, rows] = self.columns_rows();
        u64::from(columns) * u64::from(rows)
    }

    /// Number of tiles of the portion.
    pub(super) fn count(&self) -> u64 {
        let (index, count) = (self.portion.index(), self.portion.count());
        let before = u64::from(count - 1 - index);
        (self.all() + before) / u64::from(count)
    }

    /// Number of pixels of the portion.
    pub(super) fn area(&self) -> u64 {
        let [_, _, width, height] = self.crop;
        if self.portion == Portion::WHOLE {
            return u64::from(width) * u64::from(height);
        }
        let areas = (0..self.count()).map(|number| {
            let [_, _, width, height] = self.rectangle(number);
            u64::from(width) * u64::from(height)
        });
        areas.sum()
    }

    fn columns_rows(&self) -> [u32; 2] {
        let [_, _, width, height] = self.crop;
        [width.div_ceil(self.size[0]), height.div_ceil(self.size[1])]
    }

    /// Returns the rectangle of tile `number` of the portion: x, y, width, height on the film.
    pub(super) fn rectangle(&self, number: u64) -> [u32; 4] {
        let [x, y, width, height] = self.crop;
        let columns = u64::from(self.columns_rows()[0].max(1));
        let place = number * u64::from(self.portion.count()) + u64::from(self.portion.index());
        let row = place / columns;
        let column = (place + row % columns * self.turn) % columns;
        let left = column as u32 * self.size[0];
        let top = row as u32 * self.size[1];
        // The tile's corner is within the crop, so the subtractions cannot overflow.
        let (right, bottom) = (width - left, height - top);
        [
            x + left,
            y + top,
            right.min(self.size[0]),
            bottom.min(self.size[1]),
        ]
    }
}

/// Iterates over the pixels of a rectangle, row by row, as [x, y].
pub(super) fn pixels([x, y, width, height]: [u32; 4]) -> impl Iterator<Item = [u32; 2]> {
    (y..y + height).flat_map(move |y| (x..x + width).map(move |x| [x, y]))
}

/// Iterates over the ranges of `tile`'s rows in a picture of `crop`.
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

    fn portions(count: u32) -> impl Iterator<Item = Portion> {
        (0..count).map(move |index| Portion::new(index, count).unwrap())
    }

    #[test]
    fn every_pixel_is_in_one_tile_of_one_portion() {
        for crop in [[0, 0, 1, 1], [3, 5, 17, 9], [0, 0, 64, 64], [2, 0, 1, 40]] {
            for (size, paths) in [
                (Some([1, 1]), 1),
                (Some([5, 3]), 1),
                (None, 1),
                (None, 1 << 12),
            ] {
                for count in [1, 2, 3, 4, 7, 16, 153, 500] {
                    let mut seen = Vec::new();
                    for portion in portions(count) {
                        let tiles = Tiles::new(crop, size, paths, portion);
                        let before = seen.len();
                        seen.extend((0..tiles.count()).flat_map(|n| pixels(tiles.rectangle(n))));
                        assert_eq!((seen.len() - before) as u64, tiles.area());
                    }
                    seen.sort_unstable_by_key(|[x, y]| [*y, *x]);
                    assert_eq!(seen, pixels(crop).collect::<Vec<_>>(), "{crop:?} {count}");
                }
            }
        }
    }

    #[test]
    fn more_paths_make_smaller_tiles() {
        let area = |paths| {
            let tiles = Tiles::new([0, 0, 99, 99], None, paths, Portion::WHOLE);
            let [_, _, width, height] = tiles.rectangle(0);
            width * height
        };
        assert_eq!([1, 1 << 12, 1 << 17, 1 << 40].map(area), [256, 32, 1, 1]);
    }

    /// Checks that no portion costs more than 15 % above the mean of all if pixels cost more
    /// towards one side, or only within a disc.
    #[test]
    fn portions_cost_about_as_much_wherever_the_picture_is_costly() {
        type Cost = fn(f64, f64) -> f64;
        let costs: [Cost; 5] = [
            |_, _| 1.0,
            |x, _| x,
            |_, y| y,
            |x, y| f64::from(u8::from(x > 0.5)) + 0.1 * y,
            |x, y| f64::from(u8::from((x - 0.4).hypot(y - 0.6) < 0.3)),
        ];
        for side in [64, 100, 128, 250] {
            for count in [2, 3, 4, 5, 8, 13, 16, 31, 32] {
                for cost in costs {
                    let of = |[x, y]: [u32; 2]| {
                        let part = |at: u32| (f64::from(at) + 0.5) / f64::from(side);
                        cost(part(x), part(y))
                    };
                    let each: Vec<f64> = portions(count)
                        .map(|portion| {
                            let tiles = Tiles::new([0, 0, side, side], None, 1 << 12, portion);
                            let tiles = (0..tiles.count()).map(|n| tiles.rectangle(n));
                            tiles.flat_map(pixels).map(of).sum()
                        })
                        .collect();
                    let mean = each.iter().sum::<f64>() / f64::from(count);
                    let most = each.iter().fold(0.0, |most, &cost| f64::max(most, cost));
                    assert!(most < 1.15 * mean, "{side} {count}: {:.3}", most / mean);
                }
            }
        }
    }
}
