//! How strongly a lamp may light a surface, by interval arithmetic: branch and bound over pairs of
//! a part of the surface and a part of the lamp.

use glam::DVec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Parts are cut until the bound is this near to a value that is taken.
const TIGHT: f64 = 1.05;

/// Pairs of parts that are looked at, at most.
const MOST_PAIRS: usize = 16_000;

/// Where parts so small, against what they are parts of, still touch, there is no bound.
const TOUCHING: f64 = 1.0 / 64.0;

/// What a lamp does to a surface at most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reached {
    /// An upper bound of `q / r^4`: infinite if none can be shown.
    pub form: f64,
    /// An upper bound of `1 / r^2` where `q` is not 0: infinite if none can be shown.
    pub nearness: f64,
}

impl Reached {
    /// The bound of whatever nothing is known about: infinity.
    pub const UNBOUNDED: Self = Self {
        form: f64::INFINITY,
        nearness: f64::INFINITY,
    };
}

/// A bound, over all points `x` of the polygons `surface`, on either side of which light may
/// arrive, and all points `y` of the polygon `lamp`, whose front emits.
///
/// Corners go around a convex polygon; `(v1 - v0) x (v2 - v0)` is the front.
pub fn strongest<'a>(surface: impl Iterator<Item = &'a [DVec3]>, lamp: &[DVec3]) -> Reached {
    let lamp: Vec<Triangle> = Triangle::of(lamp).collect();
    let faces: Vec<Triangle> = surface.flat_map(Triangle::of).collect();
    let pairs = || {
        let of = |face: &Triangle| lamp.iter().map(|lamp| (*face, *lamp)).collect::<Vec<_>>();
        faces.iter().flat_map(of)
    };
    Reached {
        form: supremum(pairs(), form, MOST_PAIRS),
        nearness: supremum(pairs(), nearness, MOST_PAIRS),
    }
}

/// The same bound of `q / r^4` for one polygon, looser: of so many pairs of parts.
pub fn strongest_form(face: &[DVec3], lamp: &[DVec3], most_pairs: usize) -> f64 {
    let of = |face: Triangle| Triangle::of(lamp).map(move |lamp| (face, lamp));
    supremum(Triangle::of(face).flat_map(of), form, most_pairs)
}

/// A triangle of a surface or a lamp.
#[derive(Clone, Copy)]
struct Triangle {
    corners: [DVec3; 3],
    normal: DVec3,
    centre: DVec3,
    radius: f64,
    /// The box around it.
    low: DVec3,
    high: DVec3,
}

impl Triangle {
    fn of(polygon: &[DVec3]) -> impl Iterator<Item = Self> + '_ {
        (2..polygon.len()).map(|k| Self::new([polygon[0], polygon[k - 1], polygon[k]], None))
    }

    fn new(corners: [DVec3; 3], normal: Option<DVec3>) -> Self {
        let [a, b, c] = corners;
        let centre = (a + b + c) / 3.0;
        let far = |corner: DVec3| (corner - centre).length();
        Self {
            corners,
            normal: normal.unwrap_or_else(|| (b - a).cross(c - a).normalize_or_zero()),
            centre,
            // Above what rounding takes from it.
            radius: far(a).max(far(b)).max(far(c)) * (1.0 + 1e-12),
            low: a.min(b).min(c),
            high: a.max(b).max(c),
        }
    }

    fn quarters(&self) -> [Self; 4] {
        let [a, b, c] = self.corners;
        let (ab, bc, ca) = ((a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5);
        let part = |corners| Self::new(corners, Some(self.normal));
        [
            part([a, ab, ca]),
            part([ab, b, bc]),
            part([ca, bc, c]),
            part([ab, bc, ca]),
        ]
    }

    /// The least and the greatest rise of a corner of `other` over this part's plane.
    fn rises(&self, other: &Self) -> [f64; 2] {
        let along = |corner: DVec3| self.normal.dot(corner - self.centre);
        let [a, b, c] = other.corners.map(along);
        [a.min(b).min(c), a.max(b).max(c)]
    }
}

/// Whether light goes from a part of the lamp to a part of the surface, and how: the greatest rises
/// over both planes, and the least distance.
fn seen(face: &Triangle, lamp: &Triangle) -> Option<[f64; 3]> {
    let size = face.radius + lamp.radius;
    let slack = 1e-12 * size;
    let [below, above] = face.rises(lamp);
    let [behind, before] = lamp.rises(face);
    let rise = above.max(-below);
    // Planes that are one up to rounding light nothing of each other.
    if rise <= slack || before <= slack {
        return None;
    }
    // Apart by their spheres, by their boxes, and each by the other's plane.
    let apart = (face.centre - lamp.centre).length() - size;
    let by_planes = below.max(-above).max(behind);
    let between = (face.low - lamp.high).max(lamp.low - face.high);
    let by_boxes = between.max(DVec3::ZERO).length() * (1.0 - 1e-12);
    Some([rise, before, apart.max(by_planes).max(by_boxes)])
}

fn form(face: &Triangle, lamp: &Triangle) -> f64 {
    let Some([n, m, r]) = seen(face, lamp) else {
        return 0.0;
    };
    if r == 0.0 {
        return f64::INFINITY;
    }
    (n / r).min(1.0) * (m / r).min(1.0) / (r * r)
}

fn nearness(face: &Triangle, lamp: &Triangle) -> f64 {
    match seen(face, lamp) {
        None => 0.0,
        Some([.., r]) => 1.0 / (r * r),
    }
}

struct Pair {
    most: f64,
    face: Triangle,
    lamp: Triangle,
}

impl Pair {
    fn size(&self) -> f64 {
        self.face.radius + self.lamp.radius
    }
}

impl PartialEq for Pair {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Pair {}
impl PartialOrd for Pair {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Pair {
    fn cmp(&self, other: &Self) -> Ordering {
        // Of two without a bound, the larger is cut first.
        let by_bound = self.most.total_cmp(&other.most);
        by_bound.then(self.size().total_cmp(&other.size()))
    }
}

/// An upper bound over all pairs, which `bound` gives for each.
fn supremum(
    pairs: impl Iterator<Item = (Triangle, Triangle)>,
    bound: fn(&Triangle, &Triangle) -> f64,
    most_pairs: usize,
) -> f64 {
    let mut heap: BinaryHeap<Pair> = pairs
        .map(|(face, lamp)| Pair {
            most: bound(&face, &lamp),
            face,
            lamp,
        })
        .filter(|pair| pair.most > 0.0)
        .collect();
    let whole = heap.iter().map(Pair::size).fold(0.0, f64::max);
    let point = |part: &Triangle| Triangle {
        radius: 0.0,
        corners: [part.centre; 3],
        low: part.centre,
        high: part.centre,
        ..*part
    };
    let mut taken: f64 = 0.0;
    for _ in 0..most_pairs {
        let Some(pair) = heap.pop() else {
            return 0.0;
        };
        let middle = bound(&point(&pair.face), &point(&pair.lamp));
        if middle.is_finite() {
            taken = taken.max(middle);
        }
        if pair.most.is_infinite() && pair.size() < TOUCHING * whole {
            return pair.most;
        }
        if pair.most <= TIGHT * taken {
            return pair.most * (1.0 + 1e-9);
        }
        let cut_face = pair.face.radius >= pair.lamp.radius;
        let larger = if cut_face { &pair.face } else { &pair.lamp };
        for part in larger.quarters() {
            let (face, lamp) = if cut_face {
                (part, pair.lamp)
            } else {
                (pair.face, part)
            };
            let most = bound(&face, &lamp);
            if most > 0.0 {
                heap.push(Pair { most, face, lamp });
            }
        }
    }
    heap.peek().map_or(0.0, |pair| pair.most * (1.0 + 1e-9))
}
