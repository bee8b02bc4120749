//! Upper bounds of how strongly a lamp lights a surface, by interval arithmetic: branch and bound
//! over pairs of a part of the surface and a part of the lamp.

use glam::DVec3;
use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashMap};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::{LazyLock, Mutex, PoisonError};

/// Ratio of the bound to an attained value at which parts are no longer cut.
const TIGHT: f64 = 1.05;

/// Maximum number of pairs of parts that are examined.
const MOST_PAIRS: usize = 16_000;

/// Height of a part over the other's plane, and distance, relative to coordinates, below which rounding counts.
const LOW: f64 = 1e-6;

/// Size of touching parts, relative to the whole, below which there is no bound.
const TOUCHING: f64 = 1.0 / 64.0;

/// Maximum number of pairs that are cut to find touching parts before all others.
const MOST_TOUCHING: usize = 256;

/// Upper bounds of a lamp's effect on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reached {
    /// An upper bound of `q / r^4`: infinite if none can be shown.
    pub form: f64,
    /// True unless `r` is shown to be at least the distance that was asked for, wherever `q` is not 0.
    pub is_near: bool,
}

impl Reached {
    /// The bound if nothing is known: infinity.
    pub const UNBOUNDED: Self = Self {
        form: f64::INFINITY,
        is_near: true,
    };

    /// The bounds of a surface that the lamp does not light.
    pub(crate) const NOTHING: Self = Self {
        form: 0.0,
        is_near: false,
    };
}

/// Returns bounds over all points `x` of the polygons `surface` and all points `y` of the polygon
/// `lamp`. Light may arrive on either side of the surface; the lamp emits on its front.
///
/// Corners go around a convex polygon; `(v1 - v0) x (v2 - v0)` is the front. `is_smooth` is true if the
/// surface is shaded by interpolated normals: `n` may then have any direction. A distance below `near` is
/// near.
pub fn strongest(surface: &[&[DVec3]], is_smooth: bool, lamp: &[DVec3], near: f64) -> Reached {
    let most = near.powi(-2);
    Reached {
        form: known(surface, lamp, Bound::of_form(is_smooth), MOST_PAIRS),
        is_near: known(surface, lamp, Bound::Nearness { most }, MOST_PAIRS) > most,
    }
}

/// Returns the bound of `q / r^4` for one polygon, as [`strongest`] does but looser: it examines at most
/// `most_pairs` pairs of parts.
pub fn strongest_form(face: &[DVec3], is_smooth: bool, lamp: &[DVec3], most_pairs: usize) -> f64 {
    known(&[face], lamp, Bound::of_form(is_smooth), most_pairs)
}

/// A quantity that is bounded.
#[derive(Clone, Copy)]
enum Bound {
    Form,
    /// The form where `n` may have any direction.
    SmoothForm,
    /// `1 / r^2`, which only has to be known to exceed `most` or not.
    Nearness {
        most: f64,
    },
}

impl Bound {
    fn of_form(is_smooth: bool) -> Self {
        if is_smooth {
            Self::SmoothForm
        } else {
            Self::Form
        }
    }

    /// A number for each quantity, and the value on whose side it is asked to be.
    fn key(self) -> (u8, u64) {
        match self {
            Self::Form => (0, 0),
            Self::SmoothForm => (1, 0),
            Self::Nearness { most } => (2, most.to_bits()),
        }
    }
}

/// Bounds that have been computed, by 128 bits of a hash of what they are of. A scene's programs, one
/// for each channel and class of pixels, ask for the same ones.
static KNOWN: LazyLock<Mutex<HashMap<[u64; 2], f64>>> = LazyLock::new(Mutex::default);

/// Maximum number of bounds that are kept.
const MOST_KNOWN: usize = 1 << 16;

/// Returns the bound over all pairs of a face and the lamp.
fn known(faces: &[&[DVec3]], lamp: &[DVec3], of: Bound, most_pairs: usize) -> f64 {
    let print = [0_u8, 1].map(|half| {
        let mut hasher = DefaultHasher::new();
        (half, of.key(), most_pairs).hash(&mut hasher);
        for polygon in faces.iter().chain([&lamp]) {
            polygon.len().hash(&mut hasher);
            let numbers = polygon.iter().flat_map(DVec3::to_array);
            numbers.for_each(|number| number.to_bits().hash(&mut hasher));
        }
        hasher.finish()
    });
    let all = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(&most) = all().get(&print) {
        return most;
    }
    let most = match of {
        Bound::Form => supremum(faces, lamp, form, most_pairs, None),
        Bound::SmoothForm => supremum(faces, lamp, smooth_form, most_pairs, None),
        Bound::Nearness { most } => supremum(faces, lamp, nearness, most_pairs, Some(most)),
    };
    let mut all = all();
    if all.len() >= MOST_KNOWN {
        all.clear();
    }
    all.insert(print, most);
    most
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
    fn fan(polygon: &[DVec3]) -> impl Iterator<Item = Self> + '_ {
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
            // Rounded up, so that it stays an upper bound.
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

    /// Returns the least and the greatest height of a corner of `other` over this part's plane.
    fn rises(&self, other: &Self) -> [f64; 2] {
        let along = |corner: DVec3| self.normal.dot(corner - self.centre);
        let [a, b, c] = other.corners.map(along);
        [a.min(b).min(c), a.max(b).max(c)]
    }
}

/// Returns the greatest heights over both planes and the least distance, if light goes from a part
/// of the lamp to a part of the surface.
fn seen(face: &Triangle, lamp: &Triangle) -> Option<[f64; 3]> {
    let size = face.radius + lamp.radius;
    let slack = 1e-12 * size;
    let [below, above] = face.rises(lamp);
    let [behind, before] = lamp.rises(face);
    let rise = above.max(-below);
    // Parts whose planes are equal up to rounding do not light each other.
    if rise <= slack || before <= slack {
        return None;
    }
    // Lower bounds of the distance: by the spheres, by the boxes, and by each part's plane.
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
    let apart = (n / r).min(1.0) * (m / r).min(1.0) / (r * r);
    apart.min(by_tangents(face, lamp, false))
}

fn smooth_form(face: &Triangle, lamp: &Triangle) -> f64 {
    let Some([_, m, r]) = seen(face, lamp) else {
        return 0.0;
    };
    if r == 0.0 {
        return f64::INFINITY;
    }
    let apart = (m / r).min(1.0) / (r * r);
    apart.min(by_tangents(face, lamp, true))
}

/// Returns a bound of the form whose excess falls with the square of the parts' sizes: infinity if it does not hold.
///
/// With `d = y - x`, the heights `n.d` over the surface's plane and `-m.d` over the lamp's are linear in the two
/// points, and so is `s = u.d` for a fixed unit vector `u`: here that between the centres, where the heights are
/// `h` and `g`. Let `p` and `q` be the heights' changes from there, relative to `h` and `g`. As `ln` is below its
/// tangents and `r >= s`,
///
/// ```text
/// ln(n.d (-m.d) / r^4) <= ln h + ln g + p + q - 4 ln s
/// ```
///
/// The right side is convex, so it is greatest at corners of the two parts. Without `n`, it is
/// `ln g + q - 3 ln s`.
fn by_tangents(face: &Triangle, lamp: &Triangle, is_smooth: bool) -> f64 {
    if face.radius + lamp.radius == 0.0 {
        // Points, whose form is exact.
        return f64::INFINITY;
    }
    let between = lamp.centre - face.centre;
    let distance = between.length();
    let towards = between / distance;
    let above = face.normal.dot(between);
    let before = -lamp.normal.dot(between);
    // Heights and distances that rounding could change by more than the search's slack have no bound here.
    let all = face.corners.iter().chain(&lamp.corners);
    let size = all.fold(0.0, |most: f64, corner| {
        most.max(corner.abs().max_element())
    });
    let least = LOW * (size + distance);
    if before <= least || (!is_smooth && above.abs() <= least) {
        return f64::INFINITY;
    }
    let on_lamp = lamp.corners.map(|corner| {
        let step = corner - lamp.centre;
        let rise = if is_smooth {
            0.0
        } else {
            face.normal.dot(step) / above
        };
        (rise, towards.dot(step))
    });
    // Beyond the surface's plane, the height grows again.
    if on_lamp.iter().any(|&(rise, _)| rise <= -1.0) {
        return f64::INFINITY;
    }
    let on_face = face.corners.map(|corner| {
        let step = corner - face.centre;
        (lamp.normal.dot(step) / before, towards.dot(step))
    });
    let power = if is_smooth { 3.0 } else { 4.0 };
    let mut most = f64::NEG_INFINITY;
    for (p, ahead) in on_lamp {
        for (q, back) in on_face {
            let along = distance + ahead - back;
            if along <= least {
                return f64::INFINITY;
            }
            most = most.max(p + q - power * along.ln());
        }
    }
    let heights = if is_smooth {
        before
    } else {
        above.abs() * before
    };
    heights * most.exp()
}

fn nearness(face: &Triangle, lamp: &Triangle) -> f64 {
    match seen(face, lamp) {
        None => 0.0,
        Some([.., r]) => 1.0 / (r * r),
    }
}

/// Triangles that are cut into parts, each once: most parts belong to many pairs.
#[derive(Default)]
struct Parts {
    all: Vec<Triangle>,
    /// By triangle: the first of its four parts; 0 if it is not cut yet.
    quarters: Vec<u32>,
}

impl Parts {
    fn push(&mut self, part: Triangle) -> u32 {
        self.all.push(part);
        self.quarters.push(0);
        (self.all.len() - 1) as u32
    }

    fn quarters(&mut self, number: u32) -> [u32; 4] {
        let mut first = self.quarters[number as usize];
        if first == 0 {
            first = self.all.len() as u32;
            for part in self.all[number as usize].quarters() {
                self.push(part);
            }
            self.quarters[number as usize] = first;
        }
        [0, 1, 2, 3].map(|part| first + part)
    }

    /// The parts of a pair.
    fn both(&self, pair: [u32; 2]) -> [&Triangle; 2] {
        pair.map(|part| &self.all[part as usize])
    }

    /// Cuts the larger part of a pair, and returns the four pairs with its quarters.
    fn cut(&mut self, [face, lamp]: [u32; 2]) -> [[u32; 2]; 4] {
        let [one, other] = self.both([face, lamp]);
        if one.radius >= other.radius {
            self.quarters(face).map(|face| [face, lamp])
        } else {
            self.quarters(lamp).map(|lamp| [face, lamp])
        }
    }
}

/// A pair of a part of the surface and a part of the lamp.
struct Pair {
    most: f64,
    size: f64,
    face: u32,
    lamp: u32,
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
        by_bound.then(self.size.total_cmp(&other.size))
    }
}

/// True if smaller parts of one of the `unbounded` pairs, whose sizes are below `least` together, have no bound either.
///
/// The search of all pairs would end there, too, but it cuts the largest pairs first. False if `most_pairs` pairs do not
/// show it.
fn touch(
    parts: &mut Parts,
    mut unbounded: Vec<[u32; 2]>,
    bound: &impl Fn(&Triangle, &Triangle) -> f64,
    least: f64,
    most_pairs: usize,
) -> bool {
    for _ in 0..most_pairs {
        let Some(pair) = unbounded.pop() else {
            return false;
        };
        let [one, other] = parts.both(pair);
        if one.radius + other.radius < least {
            return true;
        }
        for pair in parts.cut(pair) {
            let [one, other] = parts.both(pair);
            if bound(one, other).is_infinite() {
                unbounded.push(pair);
            }
        }
    }
    false
}

/// Returns an upper bound over all pairs of a face and the lamp; `bound` gives that of one pair of triangles.
/// With `asked`, the bound is only as tight as it takes to tell whether the supremum exceeds this value.
fn supremum(
    faces: &[&[DVec3]],
    lamp: &[DVec3],
    bound: impl Fn(&Triangle, &Triangle) -> f64,
    most_pairs: usize,
    asked: Option<f64>,
) -> f64 {
    let mut parts = Parts::default();
    let lamps: Vec<u32> = Triangle::fan(lamp).map(|part| parts.push(part)).collect();
    let mut pairs: Vec<Pair> = Vec::new();
    for part in faces.iter().flat_map(|face| Triangle::fan(face)) {
        let face = parts.push(part);
        pairs.extend(lamps.iter().filter_map(|&lamp| {
            let other = &parts.all[lamp as usize];
            let most = bound(&part, other);
            let size = part.radius + other.radius;
            (most > 0.0).then_some(Pair {
                most,
                size,
                face,
                lamp,
            })
        }));
    }
    let whole = pairs.iter().map(|pair| pair.size).fold(0.0, f64::max);
    let unbounded = pairs.iter().filter(|pair| pair.most.is_infinite());
    let unbounded = unbounded.map(|pair| [pair.face, pair.lamp]).collect();
    let first = most_pairs.min(MOST_TOUCHING);
    if touch(&mut parts, unbounded, &bound, TOUCHING * whole, first) {
        return f64::INFINITY;
    }
    let mut open = BinaryHeap::from(pairs);
    let point = |part: &Triangle| Triangle {
        radius: 0.0,
        corners: [part.centre; 3],
        low: part.centre,
        high: part.centre,
        ..*part
    };
    let mut taken: f64 = 0.0;
    // The greatest bound of the parts that are not kept, since they end the search when they are reached.
    let mut dropped: f64 = 0.0;
    for _ in 0..most_pairs {
        let Some(pair) = open.pop() else {
            return dropped * (1.0 + 1e-9);
        };
        let [face, lamp] = parts.both([pair.face, pair.lamp]);
        let middle = bound(&point(face), &point(lamp));
        if middle.is_finite() {
            taken = taken.max(middle);
        }
        if pair.most.is_infinite() && pair.size < TOUCHING * whole {
            return pair.most;
        }
        let is_told = asked.is_some_and(|asked| taken > asked || pair.most <= asked);
        if is_told || pair.most <= TIGHT * taken {
            return pair.most.max(dropped) * (1.0 + 1e-9);
        }
        for [face, lamp] in parts.cut([pair.face, pair.lamp]) {
            let [one, other] = parts.both([face, lamp]);
            let most = bound(one, other);
            if most <= TIGHT * taken {
                dropped = dropped.max(most);
            } else {
                let size = one.radius + other.radius;
                open.push(Pair {
                    most,
                    size,
                    face,
                    lamp,
                });
            }
        }
    }
    let kept = open.peek().map_or(0.0, |pair| pair.most);
    kept.max(dropped) * (1.0 + 1e-9)
}
