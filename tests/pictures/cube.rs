//! The cube [-1, 1]^3, as a room.

/// Its six walls, with fronts inwards: four corners each.
pub(crate) const WALLS: [[usize; 4]; 6] = [
    [0, 2, 6, 4],
    [1, 5, 7, 3],
    [0, 4, 5, 1],
    [2, 3, 7, 6],
    [0, 1, 3, 2],
    [4, 6, 7, 5],
];

/// Returns the corner with bit k of `code` as its k-th coordinate.
pub(crate) fn corner(code: usize) -> [f64; 3] {
    std::array::from_fn(|k| if code >> k & 1 == 1 { 1.0 } else { -1.0 })
}
