//! Solids: the regions that closed surfaces enclose.
//!
//! A closed surface whose polygons all go around alike gives each point a *winding number*: how
//! often the surface goes around it. Crossing a polygon against its normal raises the number by 1,
//! crossing it along its normal lowers it by 1. For a surface that does not intersect itself the
//! number is 0 outside, and 1 or -1 inside, as the normals point outwards or inwards (the
//! Jordan-Brouwer theorem).

use super::apart::share_corners_alone;
use super::bounds;
use glam::DVec3;
use std::collections::HashMap;

/// Maximum number of pairs of boxes, and of polygons, that are compared to show that a surface does
/// not intersect itself.
const MOST_BOXES: usize = 1 << 26;
const MOST_POLYGONS: usize = 1 << 22;

/// Minimum volume of a solid, relative to the cube of its size.
const FLAT: f64 = 1e-12;

/// Distance from a plane below which a corner lies on it.
const ON_PLANE: f64 = 1e-12;

/// The region enclosed by a closed surface that does not intersect itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// The least corner of the box around it.
    pub low: DVec3,
    /// The greatest corner of the box around it.
    pub high: DVec3,
    /// True if the normals point out of the solid, false if they all point into it.
    pub outwards: bool,
}

impl Solid {
    /// True if the box from `low` to `high` comes nearer than `margin` to the box around the solid.
    pub fn is_near(&self, low: DVec3, high: DVec3, margin: f64) -> bool {
        let apart = (self.low - high).max(low - self.high);
        apart.max_element() <= margin
    }
}

/// Returns the solids that `polygons` enclose. `None` unless they are closed surfaces, each
/// connected by its edges, and each is shown not to intersect itself. Different surfaces may
/// intersect.
pub fn solids(polygons: &[&[DVec3]]) -> Option<Vec<Solid>> {
    let groups = connected(polygons)?;
    groups.iter().map(|group| solid(group)).collect()
}

/// Groups the polygons by connected surface. `None` unless each edge belongs to exactly two of
/// them, which go along it in opposite directions.
fn connected<'a>(polygons: &[&'a [DVec3]]) -> Option<Vec<Vec<&'a [DVec3]>>> {
    // 0 and -0 are one coordinate.
    let key = |corner: DVec3| (corner + DVec3::ZERO).to_array().map(f64::to_bits);
    let mut edges: HashMap<[[u64; 3]; 2], usize> = HashMap::new();
    for (number, polygon) in polygons.iter().enumerate() {
        for (k, &start) in polygon.iter().enumerate() {
            let end = polygon[(k + 1) % polygon.len()];
            if edges.insert([key(start), key(end)], number).is_some() {
                return None;
            }
        }
    }
    let mut group_of = vec![None; polygons.len()];
    let mut groups: Vec<Vec<&[DVec3]>> = Vec::new();
    for first in 0..polygons.len() {
        if group_of[first].is_some() {
            continue;
        }
        let group = groups.len();
        groups.push(Vec::new());
        group_of[first] = Some(group);
        let mut pending = vec![first];
        while let Some(number) = pending.pop() {
            let polygon = polygons[number];
            groups[group].push(polygon);
            for (k, &start) in polygon.iter().enumerate() {
                let end = polygon[(k + 1) % polygon.len()];
                let other = *edges.get(&[key(end), key(start)])?;
                if group_of[other].is_none() {
                    group_of[other] = Some(group);
                    pending.push(other);
                }
            }
        }
    }
    Some(groups)
}

fn solid(surface: &[&[DVec3]]) -> Option<Solid> {
    let corners = || surface.iter().copied().flatten();
    let (low, high) = bounds(corners());
    let size = (high - low).max_element();
    let origin = low.midpoint(high);
    let volume: f64 = surface
        .iter()
        .map(|polygon| volume_under(polygon, origin))
        .sum();
    if volume.abs() <= FLAT * size.powi(3) {
        return None;
    }
    (is_convex(surface) || is_embedded(surface)).then_some(Solid {
        low,
        high,
        outwards: volume > 0.0,
    })
}

/// The volume between a polygon and `origin`, negative where the normal points towards it.
fn volume_under(polygon: &[DVec3], origin: DVec3) -> f64 {
    let [first, rest @ ..] = polygon else {
        return 0.0;
    };
    let triangles = rest.windows(2).map(|pair| {
        let [a, b, c] = [*first, pair[0], pair[1]].map(|corner| corner - origin);
        a.dot(b.cross(c)) / 6.0
    });
    triangles.sum()
}

/// True if all corners are on one side of the plane of every polygon.
fn is_convex(surface: &[&[DVec3]]) -> bool {
    if surface.len().saturating_mul(surface.len()) > MOST_POLYGONS {
        return false;
    }
    surface.iter().all(|polygon| {
        let normal = (polygon[1] - polygon[0]).cross(polygon[2] - polygon[0]);
        let Some(normal) = normal.try_normalize() else {
            return false;
        };
        let height = |corner: &DVec3| normal.dot(*corner - polygon[0]);
        let corners = || surface.iter().copied().flatten();
        corners().all(|corner| height(corner) <= ON_PLANE)
            || corners().all(|corner| height(corner) >= -ON_PLANE)
    })
}

/// True if no two polygons have more in common than corners and edges that both have.
fn is_embedded(surface: &[&[DVec3]]) -> bool {
    let (low, high) = bounds(surface.iter().copied().flatten());
    let extent = high - low;
    let axis = (0..3)
        .max_by(|&a, &b| extent[a].total_cmp(&extent[b]))
        .unwrap_or(0);
    let mut boxes: Vec<(DVec3, DVec3, &[DVec3])> = surface
        .iter()
        .map(|polygon| {
            let (low, high) = bounds(polygon.iter());
            (low, high, *polygon)
        })
        .collect();
    boxes.sort_by(|a, b| a.0[axis].total_cmp(&b.0[axis]));
    let (mut compared, mut tried) = (0, 0);
    for (number, (low, high, polygon)) in boxes.iter().enumerate() {
        for (other_low, other_high, other) in &boxes[number + 1..] {
            if other_low[axis] > high[axis] {
                break;
            }
            compared += 1;
            if compared > MOST_BOXES {
                return false;
            }
            if low.cmpgt(*other_high).any() || other_low.cmpgt(*high).any() {
                continue;
            }
            tried += 1;
            if tried > MOST_POLYGONS || !share_corners_alone(polygon, other) {
                return false;
            }
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box with its fronts outwards.
    fn cuboid(low: [f64; 3], high: [f64; 3]) -> Vec<Vec<DVec3>> {
        let ends = [low, high];
        let corner = |n: usize| DVec3::from_array([0, 1, 2].map(|k| ends[n >> k & 1][k]));
        let faces = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        faces.map(|face| face.map(corner).to_vec()).to_vec()
    }

    fn turned(faces: Vec<Vec<DVec3>>) -> Vec<Vec<DVec3>> {
        let turn = |face: Vec<DVec3>| face.into_iter().rev().collect();
        faces.into_iter().map(turn).collect()
    }

    /// Returns a closed tube with a square section around the z axis. `radius` is that of its
    /// middle.
    fn torus(rings: usize, radius: f64) -> Vec<Vec<DVec3>> {
        let corner = |ring: usize, k: usize| {
            let (sin, cos) =
                (std::f64::consts::TAU * (ring % rings) as f64 / rings as f64).sin_cos();
            let [out, up] = [[0.1, 0.1], [-0.1, 0.1], [-0.1, -0.1], [0.1, -0.1]][k % 4];
            DVec3::new((radius + out) * cos, (radius + out) * sin, up)
        };
        let face = |n: usize| {
            let (ring, k) = (n / 4, n % 4);
            let [a, b] = [ring, ring + 1];
            vec![
                corner(a, k),
                corner(b, k),
                corner(b, k + 1),
                corner(a, k + 1),
            ]
        };
        (0..4 * rings).map(face).collect()
    }

    fn found(faces: &[Vec<DVec3>]) -> Option<Vec<bool>> {
        let outlines: Vec<&[DVec3]> = faces.iter().map(Vec::as_slice).collect();
        let solids = solids(&outlines)?;
        Some(solids.iter().map(|solid| solid.outwards).collect())
    }

    #[test]
    fn closed_surfaces_are_found_with_the_side_of_their_normals() {
        let cube = || cuboid([0.0; 3], [1.0; 3]);
        assert_eq!(found(&cube()), Some(vec![true]));
        assert_eq!(found(&turned(cube())), Some(vec![false]));
        // Nested and overlapping ones are solids of their own.
        let inner = turned(cuboid([0.2; 3], [0.4; 3]));
        let beside = cuboid([0.5; 3], [1.5; 3]);
        let all = [cube(), inner, beside].concat();
        assert_eq!(found(&all), Some(vec![true, false, true]));
        let ring = torus(24, 0.6);
        let around = found(&ring).unwrap();
        assert_eq!(around.len(), 1);
        assert_eq!(found(&turned(ring)), Some(vec![!around[0]]));
    }

    #[test]
    fn what_is_open_turned_doubled_or_meets_itself_is_none() {
        let cube = || cuboid([0.0; 3], [1.0; 3]);
        assert_eq!(found(&cube()[1..]), None);
        let mut one_turned = cube();
        one_turned[2].reverse();
        assert_eq!(found(&one_turned), None);
        assert_eq!(found(&[cube(), cube()].concat()), None);
        // A pane without thickness.
        let pane = cube()[0].clone();
        assert_eq!(
            found(&[vec![pane.clone()], turned(vec![pane])].concat()),
            None
        );
        // A tube that is wider than its ring.
        assert_eq!(found(&torus(24, 0.05)), None);
        // A prism over a bow tie.
        let bow = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        let at = |k: usize, z: f64| DVec3::new(bow[k % 4][0], bow[k % 4][1], z);
        let mut prism: Vec<Vec<DVec3>> = (0..4)
            .map(|k| vec![at(k, 0.0), at(k + 1, 0.0), at(k + 1, 1.0), at(k, 1.0)])
            .collect();
        for (a, b, c) in [(0, 1, 2), (0, 2, 3)] {
            prism.push(vec![at(a, 1.0), at(b, 1.0), at(c, 1.0)]);
            prism.push(vec![at(c, 0.0), at(b, 0.0), at(a, 0.0)]);
        }
        assert_eq!(found(&prism), None);
        assert_eq!(found(&[]), Some(vec![]));
    }
}
