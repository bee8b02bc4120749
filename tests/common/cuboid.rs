//! Boxes along the axes.

/// The corners of each side, counter-clockwise as seen from outside: bit k of a number is set at the high
/// end of axis k.
const SIDES: [[usize; 4]; 6] = [
    [0, 2, 3, 1],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 4, 6, 2],
    [1, 3, 7, 5],
];

/// Returns the corners of each side of the box from `low` to `high`, whose fronts face outwards or inwards.
pub(crate) fn sides<T: Copy>(low: [T; 3], high: [T; 3], inwards: bool) -> [[[T; 3]; 4]; 6] {
    let corner = |n: usize| [0, 1, 2].map(|k| [low, high][n >> k & 1][k]);
    SIDES.map(|side| {
        let mut corners = side.map(corner);
        if inwards {
            corners.reverse();
        }
        corners
    })
}
