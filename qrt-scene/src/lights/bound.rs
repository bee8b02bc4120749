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

/// Size of touching parts, relative to the whole, below which there is no bound.
const TOUCHING: f64 = 1.0 / 64.0;

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
    pub const NOTHING: Self = Self {
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
    let lamp: Vec<Triangle> = Triangle::fan(lamp).collect();
    let pairs = faces.iter().flat_map(|face| Triangle::fan(face));
    let pairs = pairs.flat_map(|face| lamp.iter().map(move |lamp| [face, *lamp]));
    let most = match of {
        Bound::Form => supremum(pairs, form, most_pairs, None),
        Bound::SmoothForm => supremum(pairs, smooth_form, most_pairs, None),
        Bound::Nearness { most } => supremum(pairs, nearness, most_pairs, Some(most)),
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
    (n / r).min(1.0) * (m / r).min(1.0) / (r * r)
}

fn smooth_form(face: &Triangle, lamp: &Triangle) -> f64 {
    let Some([_, m, r]) = seen(face, lamp) else {
        return 0.0;
    };
    if r == 0.0 {
        return f64::INFINITY;
    }
    (m / r).min(1.0) / (r * r)
}

fn nearness(face: &Triangle, lamp: &Triangle) -> f64 {
    match seen(face, lamp) {
        None => 0.0,
        Some([.., r]) => 1.0 / (r * r),
    }
}

/// A pair of parts, which a store holds at `slot`.
struct Pair {
    most: f64,
    size: f64,
    slot: u32,
}

impl Pair {
    fn new(most: f64, [face, lamp]: &[Triangle; 2], slot: u32) -> Self {
        Self {
            most,
            size: face.radius + lamp.radius,
            slot,
        }
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
        by_bound.then(self.size.total_cmp(&other.size))
    }
}

/// Pairs of parts that are still to be looked at. The heap orders references to them: a pair is too
/// large to be moved again and again.
struct Pairs {
    heap: BinaryHeap<Pair>,
    parts: Vec<[Triangle; 2]>,
    free: Vec<u32>,
}

impl Pairs {
    fn push(&mut self, most: f64, parts: &[Triangle; 2]) {
        let slot = if let Some(slot) = self.free.pop() {
            self.parts[slot as usize] = *parts;
            slot
        } else {
            self.parts.push(*parts);
            (self.parts.len() - 1) as u32
        };
        self.heap.push(Pair::new(most, parts, slot));
    }

    fn pop(&mut self) -> Option<(Pair, [Triangle; 2])> {
        let pair = self.heap.pop()?;
        self.free.push(pair.slot);
        let parts = self.parts[pair.slot as usize];
        Some((pair, parts))
    }
}

/// Returns an upper bound over all pairs; `bound` gives that of one pair. With `asked`, the bound is only as
/// tight as it takes to tell whether the supremum exceeds this value.
fn supremum(
    pairs: impl Iterator<Item = [Triangle; 2]>,
    bound: impl Fn(&Triangle, &Triangle) -> f64,
    most_pairs: usize,
    asked: Option<f64>,
) -> f64 {
    let pairs = pairs.map(|pair| (bound(&pair[0], &pair[1]), pair));
    let (bounds, parts): (Vec<f64>, Vec<[Triangle; 2]>) =
        pairs.filter(|(most, _)| *most > 0.0).unzip();
    let numbered = (0..).zip(bounds.iter().zip(&parts));
    let mut open = Pairs {
        heap: numbered
            .map(|(slot, (&most, parts))| Pair::new(most, parts, slot))
            .collect(),
        parts,
        free: Vec::new(),
    };
    let whole = open.heap.iter().map(|pair| pair.size).fold(0.0, f64::max);
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
        let Some((pair, [face, lamp])) = open.pop() else {
            return dropped * (1.0 + 1e-9);
        };
        let middle = bound(&point(&face), &point(&lamp));
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
        let cut_face = face.radius >= lamp.radius;
        let larger = if cut_face { &face } else { &lamp };
        for part in larger.quarters() {
            let [face, lamp] = if cut_face { [part, lamp] } else { [face, part] };
            let most = bound(&face, &lamp);
            if most <= TIGHT * taken {
                dropped = dropped.max(most);
            } else {
                open.push(most, &[face, lamp]);
            }
        }
    }
    let kept = open.heap.peek().map_or(0.0, |pair| pair.most);
    kept.max(dropped) * (1.0 + 1e-9)
}
