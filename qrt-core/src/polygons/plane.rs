//! Polygons on one plane, of which two overlap.

use super::SAME_PLANE;
use super::overlap::overlap;
use glam::DVec3;
use std::collections::HashMap;

/// Pairs of polygons of one plane that are compared at most.
const MOST_COMPARED: usize = 1 << 24;

/// The unit normal, in the half space where its greatest component is positive, and the offset along it.
fn place(polygon: &[DVec3]) -> Option<[f64; 4]> {
    let normal = (polygon[1] - polygon[0]).cross(polygon[2] - polygon[0]);
    let normal = normal.try_normalize()?;
    let greatest = normal.abs().max_position();
    let normal = normal * normal[greatest].signum();
    Some([normal.x, normal.y, normal.z, normal.dot(polygon[0])])
}

/// The first two of the polygons, by number, that lie on one plane and have a region in common that is
/// wider than `width`.
pub(crate) fn first_overlap(polygons: &[&[DVec3]], width: f64) -> Option<[usize; 2]> {
    // Wide against what planes of one may differ by; a plane at a bucket's edge is looked for in the
    // bucket beyond it, too.
    let bucket_width = 16.0 * SAME_PLANE;
    let mut buckets: HashMap<[i64; 4], Vec<usize>> = HashMap::new();
    let mut found: Option<[usize; 2]> = None;
    let mut compared = 0;
    for (number, polygon) in polygons.iter().enumerate() {
        let Some(place) = place(polygon) else {
            continue;
        };
        let bucket =
            |slack: f64| place.map(|value| ((value + slack) / bucket_width).floor() as i64);
        let (low, high) = (bucket(-4.0 * SAME_PLANE), bucket(4.0 * SAME_PLANE));
        let mut others: Vec<usize> = (0..16_usize)
            .map(|code| std::array::from_fn(|k| if code >> k & 1 == 0 { low[k] } else { high[k] }))
            .filter_map(|key: [i64; 4]| buckets.get(&key))
            .flatten()
            .copied()
            .collect();
        others.sort_unstable();
        others.dedup();
        for other in others {
            compared += 1;
            if compared > MOST_COMPARED {
                return found;
            }
            if overlap(polygon, polygons[other], width) {
                let pair = [other, number];
                found = Some(found.map_or(pair, |first| first.min(pair)));
                break;
            }
        }
        buckets.entry(bucket(0.0)).or_default().push(number);
    }
    found
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

    fn found(all: &[Vec<DVec3>]) -> Option<[usize; 2]> {
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
            assert_eq!(found(&apart), None, "{slope}");
            let mut turned = at(0.5, 0.5, 0.0);
            turned.reverse();
            let over = [&apart[..], &[turned, at(0.0, 0.0, 0.0)]].concat();
            assert_eq!(found(&over), Some([0, 4]), "{slope}");
            // A plane's coefficients that rounding moves.
            let near = [at(0.0, 0.0, 0.2), at(0.25, 0.0, 0.2 + 1e-14)];
            assert_eq!(found(&near), Some([0, 1]), "{slope}");
            // A sliver is as wide as is asked about.
            let sliver = [at(0.0, 0.0, 0.0), at(1.0 - 1e-8, 0.0, 0.0)];
            let sliver: Vec<&[DVec3]> = sliver.iter().map(Vec::as_slice).collect();
            assert_eq!(first_overlap(&sliver, SAME_PLANE), Some([0, 1]), "{slope}");
            assert_eq!(first_overlap(&sliver, 1e-6), None, "{slope}");
        }
    }
}
