//! Finds overlaps of polygons on one plane.

use super::overlap::overlap;
use super::{SAME_PLANE, bounds, main_axis};
use glam::DVec3;
use std::collections::HashMap;

/// Maximum number of comparisons of polygons whose boxes meet.
const MOST_COMPARED: usize = 1 << 22;
/// Maximum number of comparisons of boxes.
const MOST_BOXES: usize = 1 << 26;

/// The result of a search for polygons that overlap on one plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overlap {
    /// There is none.
    None,
    /// The numbers of two polygons that overlap.
    Of([usize; 2]),
    /// None is found within the effort limits.
    Unknown,
}

/// A polygon of some plane.
struct Outline<'a> {
    number: usize,
    corners: &'a [DVec3],
    low: DVec3,
    high: DVec3,
}

/// The unit normal, whose component along the main axis is positive, and the offset along it.
fn place(polygon: &[DVec3]) -> Option<[f64; 4]> {
    let normal = (polygon[1] - polygon[0]).cross(polygon[2] - polygon[0]);
    let normal = normal.try_normalize()?;
    let normal = normal * normal[main_axis(normal)].signum();
    Some([normal.x, normal.y, normal.z, normal.dot(polygon[0])])
}

/// Groups polygons by plane, each with the plane's main axis.
fn by_plane<'a>(polygons: &[&'a [DVec3]]) -> Vec<(usize, Vec<Outline<'a>>)> {
    // Buckets are wide against the rounding within one plane. A plane at a bucket's edge is also
    // looked up in the bucket beyond it.
    let bucket_width = 16.0 * SAME_PLANE;
    let mut buckets: HashMap<[i64; 4], usize> = HashMap::new();
    let mut planes = Vec::new();
    for (number, &corners) in polygons.iter().enumerate() {
        let Some(place) = place(corners) else {
            continue;
        };
        let bucket =
            |slack: f64| place.map(|value| ((value + slack) / bucket_width).floor() as i64);
        let ends = [bucket(-4.0 * SAME_PLANE), bucket(4.0 * SAME_PLANE)];
        let key = |code: usize| std::array::from_fn(|k| ends[code >> k & 1][k]);
        let known = (0..16).find_map(|code| buckets.get(&key(code)).copied());
        let plane = known.unwrap_or(planes.len());
        if known.is_none() {
            buckets.insert(bucket(0.0), plane);
            planes.push((
                main_axis(DVec3::new(place[0], place[1], place[2])),
                Vec::new(),
            ));
        }
        let (low, high) = bounds(corners.iter());
        planes[plane].1.push(Outline {
            number,
            corners,
            low,
            high,
        });
    }
    planes
}

/// Finds two polygons that lie on one plane and have a region in common that is wider than `width`.
pub fn first_overlap(polygons: &[&[DVec3]], width: f64) -> Overlap {
    let (mut compared, mut boxes) = (0, 0);
    let mut found: Option<[usize; 2]> = None;
    for (axis, mut outlines) in by_plane(polygons) {
        let [along, across] = [1, 2].map(|k| (axis + k) % 3);
        outlines.sort_by(|a, b| a.low[along].total_cmp(&b.low[along]));
        let mut open: Vec<&Outline<'_>> = Vec::new();
        for outline in &outlines {
            open.retain(|other| other.high[along] > outline.low[along]);
            boxes += open.len();
            for other in &open {
                let apart = other.high[across] <= outline.low[across]
                    || outline.high[across] <= other.low[across];
                if apart {
                    continue;
                }
                compared += 1;
                if overlap(outline.corners, other.corners, width) {
                    let (a, b) = (outline.number, other.number);
                    let pair = [a.min(b), a.max(b)];
                    found = Some(found.map_or(pair, |first| first.min(pair)));
                }
            }
            if compared > MOST_COMPARED || boxes > MOST_BOXES {
                return found.map_or(Overlap::Unknown, Overlap::Of);
            }
            open.push(outline);
        }
    }
    found.map_or(Overlap::None, Overlap::Of)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, z: f64, slope: f64) -> Vec<DVec3> {
        let corner = |u: f64, v: f64| DVec3::new(x + u, y + v, z + slope * (x + u));
        vec![
            corner(0.0, 0.0),
            corner(1.0, 0.0),
            corner(1.0, 1.0),
            corner(0.0, 1.0),
        ]
    }

    fn found(all: &[Vec<DVec3>]) -> Overlap {
        first_overlap(
            &all.iter().map(Vec::as_slice).collect::<Vec<_>>(),
            SAME_PLANE,
        )
    }

    #[test]
    fn the_first_overlap_on_a_plane_is_found() {
        for slope in [0.0, 0.3, -1.0] {
            let at = |x, y, z| square(x, y, z, slope);
            // Side by side, one above the other, across each other.
            let apart = [
                at(0.0, 0.0, 0.0),
                at(1.0, 0.0, 0.0),
                at(0.0, 0.0, 0.1),
                square(0.0, 0.0, 0.5, slope + 0.1),
            ];
            assert_eq!(found(&apart), Overlap::None, "{slope}");
            let mut turned = at(0.5, 0.5, 0.0);
            turned.reverse();
            let over = [&apart[..], &[turned, at(0.0, 0.0, 0.0)]].concat();
            assert_eq!(found(&over), Overlap::Of([0, 4]), "{slope}");
            // Rounding moves a plane's coefficients.
            let near = [at(0.0, 0.0, 0.2), at(0.25, 0.0, 0.2 + 1e-14)];
            assert_eq!(found(&near), Overlap::Of([0, 1]), "{slope}");
            // A sliver counts if it is wider than `width`.
            let sliver = [at(0.0, 0.0, 0.0), at(1.0 - 1e-8, 0.0, 0.0)];
            let sliver: Vec<&[DVec3]> = sliver.iter().map(Vec::as_slice).collect();
            assert_eq!(
                first_overlap(&sliver, SAME_PLANE),
                Overlap::Of([0, 1]),
                "{slope}"
            );
            assert_eq!(first_overlap(&sliver, 1e-6), Overlap::None, "{slope}");
        }
    }

    /// Both normals are (1, -1, 0) up to rounding, which alone decides the greatest component.
    #[test]
    fn a_plane_at_45_degrees_is_one_plane() {
        let at = |x: f64| {
            [[x, 0.0], [-0.5, 0.0], [-0.5, 1.0], [x, 1.0]].map(|[x, z]| DVec3::new(x, x + 0.1, z))
        };
        let (a, b) = (at(-0.9), at(-0.8));
        assert_eq!(first_overlap(&[&a, &b], SAME_PLANE), Overlap::Of([0, 1]));
    }

    /// Squares of a slanted plane, side by side; then with one more over the last.
    #[test]
    fn a_hundred_thousand_polygons_side_by_side_are_compared_to_the_end() {
        let mut all: Vec<Vec<DVec3>> = (0..320 * 320)
            .map(|n| {
                let (x, y) = (f64::from(n % 320), f64::from(n / 320));
                square(x, y, 0.0, 0.5)
                    .iter()
                    .map(|corner| *corner / 512.0)
                    .collect()
            })
            .collect();
        assert_eq!(found(&all), Overlap::None);
        let last = all.len();
        all.push(all[last - 1].clone());
        assert_eq!(found(&all), Overlap::Of([last - 1, last]));
    }
}
