//! Cuts polygons into triangles: a fan if convex, else by ear clipping.

use glam::{DVec2, DVec3};
use qrt_syntax::MeshFile;

/// Maximum number of corners of a face that is not convex: ear clipping takes up to their cube.
const MAX_CONCAVE: usize = 256;

/// Maximum of twice an area, relative to the square of the longest edge, that counts as rounding.
const NO_AREA: f64 = 1e-14;

/// Returns the triangles of a polygon of three or more corners, wound as it is, as indices into
/// `corners`; each has an area. A corner that repeats the one before it is dropped.
pub(super) fn triangles(corners: &[DVec3]) -> Result<Vec<[usize; 3]>, MeshFile> {
    let Some(kept) = distinct(corners) else {
        return triangles_of_distinct(corners);
    };
    let distinct: Vec<DVec3> = kept.iter().map(|&corner| corners[corner]).collect();
    let triangles = triangles_of_distinct(&distinct)?.into_iter();
    Ok(triangles.map(|t| t.map(|corner| kept[corner])).collect())
}

/// Returns the triangles of a polygon in which no corner repeats the one before it.
fn triangles_of_distinct(corners: &[DVec3]) -> Result<Vec<[usize; 3]>, MeshFile> {
    if let [a, b, c] = *corners {
        return if has_area([a, b, c])? {
            Ok(vec![[0, 1, 2]])
        } else {
            Err(MeshFile::NoArea)
        };
    }
    if corners.len() < 3 {
        return Err(MeshFile::NoArea);
    }
    let flat = flatten(corners)?;
    let fan: Vec<[usize; 3]> = (1..corners.len() - 1).map(|i| [0, i, i + 1]).collect();
    let place = |triangle: &[usize; 3]| triangle.map(|i| corners[i]);
    let convex = is_convex(&flat) && fan.iter().all(|t| matches!(has_area(place(t)), Ok(true)));
    if convex {
        Ok(fan)
    } else if corners.len() <= MAX_CONCAVE {
        ears(&flat)
    } else {
        Err(MeshFile::ManyCorners { most: MAX_CONCAVE })
    }
}

/// Returns the corners of an outline that do not repeat the one before them: edges without length do
/// not change it. `None` if these are all corners.
fn distinct(corners: &[DVec3]) -> Option<Vec<usize>> {
    let closes = corners.first() == corners.last();
    if !(closes || corners.windows(2).any(|pair| pair[0] == pair[1])) {
        return None;
    }
    let mut kept: Vec<usize> = (0..corners.len()).collect();
    kept.dedup_by_key(|corner| corners[*corner].to_array());
    let at = |corner: Option<&usize>| corner.map(|&corner| corners[corner]);
    if kept.len() > 1 && at(kept.first()) == at(kept.last()) {
        kept.pop();
    }
    Some(kept)
}

fn has_area([a, b, c]: [DVec3; 3]) -> Result<bool, MeshFile> {
    let (ab, ac, bc) = (b - a, c - a, c - b);
    let twice = ab.cross(ac).length();
    let edges = [ab, ac, bc].map(DVec3::length_squared);
    let longest = edges.into_iter().fold(0.0, f64::max);
    if !(twice.is_finite() && longest.is_finite()) {
        return Err(MeshFile::Overlarge);
    }
    Ok(twice > NO_AREA * longest)
}

/// Projects the polygon along the axis nearest to its (Newell) normal, counterclockwise.
fn flatten(corners: &[DVec3]) -> Result<Vec<DVec2>, MeshFile> {
    let mut normal = DVec3::ZERO;
    let mut longest: f64 = 0.0;
    for (i, b) in corners.iter().enumerate().skip(1) {
        let c = corners[(i + 1) % corners.len()];
        normal += (*b - corners[0]).cross(c - corners[0]);
        longest = longest
            .max((c - *b).length_squared())
            .max((*b - corners[0]).length_squared());
    }
    if !(normal.is_finite() && longest.is_finite()) {
        return Err(MeshFile::Overlarge);
    }
    let axis = normal.abs().max_position();
    if normal[axis].abs() <= NO_AREA * longest {
        return Err(MeshFile::NoArea);
    }
    let project = |p: &DVec3| {
        let side = normal[axis].signum();
        DVec2::new(p[(axis + 1) % 3] * side, p[(axis + 2) % 3])
    };
    Ok(corners.iter().map(project).collect())
}

/// Twice the area of a triangle, positive if it is counterclockwise.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// True if the outline has no right turn and goes around once: a star has only left turns, too, but
/// goes around twice.
fn is_convex(flat: &[DVec2]) -> bool {
    let n = flat.len();
    let at = |i: usize| flat[i % n];
    let left_only = (0..n).all(|i| turn(at(i), at(i + 1), at(i + 2)) >= 0.0);
    let once = (1..n - 1).all(|i| turn(flat[0], flat[i], flat[i + 1]) >= 0.0);
    left_only && once
}

fn ears(flat: &[DVec2]) -> Result<Vec<[usize; 3]>, MeshFile> {
    let mut left: Vec<usize> = (0..flat.len()).collect();
    let mut triangles = Vec::with_capacity(flat.len() - 2);
    while left.len() > 2 {
        let n = left.len();
        let ear = (0..n).find_map(|i| {
            let triangle = [left[(i + n - 1) % n], left[i], left[(i + 1) % n]];
            is_ear(flat, &left, triangle).then_some((i, triangle))
        });
        let Some((i, triangle)) = ear else {
            return Err(MeshFile::Crossing);
        };
        triangles.push(triangle);
        left.remove(i);
    }
    Ok(triangles)
}

/// True if `triangle` is a left turn of some area, with no other corner in it.
fn is_ear(flat: &[DVec2], left: &[usize], triangle: [usize; 3]) -> bool {
    let [a, b, c] = triangle.map(|i| flat[i]);
    let longest = (b - a).length_squared().max((c - b).length_squared());
    if turn(a, b, c) <= NO_AREA * longest.max((c - a).length_squared()) {
        return false;
    }
    left.iter().all(|i| {
        let p = flat[*i];
        // Corners that meet (a hole's bridge) are not inside each other.
        triangle.contains(i)
            || [a, b, c].contains(&p)
            || turn(a, b, p) < 0.0
            || turn(b, c, p) < 0.0
            || turn(c, a, p) < 0.0
    })
}

#[cfg(test)]
mod tests;
