//! Lamps: polygons that emit and cones of directions, how points on them are sampled, and how strongly one may light a
//! surface.
//!
//! At a vertex `x` with the unit normal `n`, a point `y` on a lamp of area `A` and unit normal `m`
//! counts by the geometry term
//!
//! ```text
//! G = A q / (pi r^4),    q = max(0, n.d) max(0, -m.d),    d = y - x,    r = |d|
//! ```
//!
//! which [`strongest`] bounds over all points of a surface and a lamp.

mod ball;
mod bound;
mod cone;

pub use ball::{LitFace, polygon_distance, strongest_of};
pub use bound::{Reached, strongest, strongest_form};
pub use cone::Cone;

use glam::DVec3;
use qrt_circuit::Cores;
use std::f64::consts::PI;

/// Returns `of` each number below `count`, computed on all cores: bounds of light take most of the time in which a lit
/// scene is made ready. A thread takes `at_a_time` numbers at a time.
pub fn on_all_cores<T: Send>(
    count: usize,
    at_a_time: usize,
    of: impl Fn(usize) -> T + Sync,
) -> Vec<T> {
    let numbers: Vec<usize> = (0..count).collect();
    Cores::All.map(&numbers, at_a_time, |&number| of(number))
}

/// Maximum deviation of a parallelogram's corners, relative to its size.
const PARALLEL: f64 = 1e-9;

/// A flat face that emits: a parallelogram, a triangle, which is half of one, or a disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// The corner where `edges` start; the centre of a disc.
    pub corner: DVec3,
    /// The point of `(u, v)` is `corner + u edges[0] + v edges[1]`. For a disc, whose edges are two radii, it is
    /// `corner + sqrt(u) (cos(2 pi v) edges[0] + sin(2 pi v) edges[1])`.
    pub edges: [DVec3; 2],
    /// True if points with `u + v > 1` are folded back to `(1 - u, 1 - v)`.
    pub triangle: bool,
    /// True for a disc.
    pub disc: bool,
    /// The unit normal of the side that emits.
    pub normal: DVec3,
    /// The lamp's area.
    pub area: f64,
}

impl Lamp {
    /// Creates the lamp of `corners`, which emits on its front; `None` if they form neither a
    /// parallelogram nor a triangle.
    pub fn new(corners: &[DVec3]) -> Option<Self> {
        let (a, b, last) = match *corners {
            [a, b, c] => (a, b, c),
            [a, b, c, d] if is_parallelogram([a, b, c, d]) => (a, b, d),
            _ => return None,
        };
        let triangle = corners.len() == 3;
        let edges = [b - a, last - a];
        let across = edges[0].cross(edges[1]);
        let share = if triangle { 0.5 } else { 1.0 };
        Some(Self {
            corner: a,
            edges,
            triangle,
            disc: false,
            normal: across.normalize(),
            area: share * across.length(),
        })
    }

    /// Creates the lamp of the disc in a square with these corners.
    pub fn disc([a, b, c, d]: [DVec3; 4]) -> Self {
        // Means over opposite edges: rounding of single corners nearly cancels.
        let edges = [(b - a + c - d) * 0.25, (d - a + c - b) * 0.25];
        let across = edges[0].cross(edges[1]);
        Self {
            corner: (a + b + c + d) * 0.25,
            edges,
            triangle: false,
            disc: true,
            normal: across.normalize(),
            area: PI * across.length(),
        }
    }
}

/// True if a planar quad is a parallelogram, which can be sampled by its edges alone.
pub(crate) fn is_parallelogram([a, b, c, d]: [DVec3; 4]) -> bool {
    let size = (c - a).length().max((d - b).length());
    ((a + c) - (b + d)).length() <= PARALLEL * size
}

/// Gives each lamp columns of a table of `2^bits` in proportion to its power, at least one. `None`
/// if there are no lamps, or more lamps than columns.
///
/// ```
/// assert_eq!(qrt_scene::lights::columns(&[3.0, 1.0, 1e-9], 3), Some(vec![5, 2, 1]));
/// assert_eq!(qrt_scene::lights::columns(&[1.0; 3], 1), None);
/// ```
pub fn columns(powers: &[f64], bits: u32) -> Option<Vec<u32>> {
    let all = 1_u32 << bits;
    if powers.is_empty() || powers.len() > all as usize {
        return None;
    }
    let total: f64 = powers.iter().sum();
    // Round each share down, but to at least one column. Then give columns to the lamps that
    // rounding took most from, or take some from those that it gave most to.
    let exact = |power: f64| f64::from(all) * power / total;
    let mut given: Vec<u32> = Vec::with_capacity(powers.len());
    for &power in powers {
        given.push((exact(power).floor() as u32).max(1));
    }
    let lack = |given: &[u32], k: usize| exact(powers[k]) - f64::from(given[k]);
    let by_lack = |given: &[u32], most: bool| {
        let order = |&a: &usize, &b: &usize| lack(given, a).total_cmp(&lack(given, b));
        if most {
            (0..powers.len()).max_by(|a, b| order(a, b).then(b.cmp(a)))
        } else {
            let more = |&k: &usize| given[k] > 1;
            (0..powers.len()).filter(more).min_by(|a, b| order(a, b))
        }
    };
    let mut sum: u32 = given.iter().sum();
    while sum != all {
        let next = by_lack(&given, sum < all)?;
        if sum < all {
            given[next] += 1;
            sum += 1;
        } else {
            given[next] -= 1;
            sum -= 1;
        }
    }
    Some(given)
}

#[cfg(test)]
mod tests;
