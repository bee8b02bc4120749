//! The search of spheres, for numbers of a few bits.
//!
//! Let `d` be the unit direction of a ray, `p` the point of its line nearest to the origin, `c` the centre
//! and `r` the radius. With `b = c.d` and `q = |c - p|^2 - r^2`, the line meets the sphere if
//! `h^2 = b^2 - d.d q` is above 0, at `b - h` and `b + h` from `p`.
//!
//! - All products of two numbers of the ray are shared by all spheres: `p`, `d.d p` and `d.d p.p`. A
//!   sphere adds products with its constants, and one square.
//! - The point `p` is near to every sphere that the line meets, however far the ray starts. So `b` is
//!   small, and its rounding error times `2 b` too.
//! - Numbers are multiplied by `G = 2^g`, one to two times `1 / r`, and squares by `G^2`, so that `h` has as
//!   many bits as the number of a large sphere.
//! - A direction of fixed-point numbers is not of unit length. With `e = d.d - 1`, `d.d p` is `p + e p`.
//!   Without it one of a hundred rays near a small sphere's edge misses it wrongly.
//! - Centres are rounded as far as that moves no more hits than the ray's own numbers do, and `G c` has the
//!   same bits in all its products: products with few constants of few bits share most of their sums.
//! - An error of `G b` or of `G p` comes into `G^2 h^2` times `2 G b`, and one of `e` times `(G b)^2`. So
//!   `G p` has about one guard bit for each bit that `G b` has before its point, `G b` two fewer, and `e` two
//!   for each. Products of very small spheres have room for fewer.
//! - Convex bodies that are disjoint divide a line into disjoint intervals, so the nearest of disjoint
//!   spheres is the one with the least `b`. Spheres are in groups of disjoint ones, with one root a
//!   group.
//! - A ray that leaves a sphere outwards does not meet it again.

use super::Running;
use crate::ball::StageBall;
use crate::ball_ray::hides;
use crate::geometry::{NO_FACE, StageGeometry};
use crate::ray::{Ray, Start};
use crate::vector::Vector;
use crate::{Arith, TracerPart};
use glam::DVec3;
use qrt_scene::lights::polygon_distance;

/// Most distance of `p` from the origin in each coordinate, in stage units: no line that is farther away
/// meets a sphere.
const REACH: f64 = 2.0;

/// The greatest `e`, in units in the last place.
const SLACK: f64 = 64.0;

/// Bits that a product of two numbers may have.
const MOST_BITS: i32 = 60;

/// The unit of `G^2 (c.c - r^2)` where it is multiplied by `e`, which is small.
const STEP_OF_SQUARE: f64 = 1.0 / 16.0;

/// Numbers of bits below the unit in the last place.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Finer {
    /// Those of `G p`.
    foot: i32,
    /// Those of `G b`.
    along: i32,
    /// Those of `e`: an even number.
    excess: i32,
}

impl Finer {
    /// The bits where `G b` is at most `most`, with `G = 2^steps`, within the widths of products.
    fn new(most: f64, steps: i32, ulp: f64) -> Self {
        let whole = most.log2().round().max(0.0) as i32;
        let fraction = -ulp.log2().round() as i32;
        let room = (MOST_BITS / 2 - fraction - steps - 2).max(0);
        let foot = (whole - 1).clamp(0, room);
        // `e` multiplies `p`, and the square of `G p`: about `2 (steps + foot) + 12` bits.
        let beside_number = MOST_BITS - 2 * (fraction + 1);
        let beside_square = MOST_BITS - 12 - 2 * (steps + foot);
        Self {
            foot,
            along: (whole - 3).clamp(0, room),
            excess: (2 * whole).clamp(0, beside_number.min(beside_square).max(LEAST_EXCESS)),
        }
    }
}

/// Bits of `e` that a fraction of many bits leaves room for.
const LEAST_EXCESS: i32 = 8;

/// Spheres that are disjoint, and of one size within a factor of two.
#[derive(Clone, Debug, PartialEq)]
struct Group {
    /// `g`
    steps: i32,
    /// True if rays may start inside.
    from_inside: bool,
    /// True if rays to lamps may end inside.
    to_inside: bool,
    balls: Vec<StageBall>,
}

impl Group {
    /// A bound of `G |b|`.
    fn most_along(&self) -> f64 {
        let centres = self.balls.iter().map(|ball| ball.centre.length());
        (centres.fold(0.0, f64::max) + 0.01) * 1.01 * scale(self.steps)
    }

    fn finer(&self, ulp: f64) -> Finer {
        Finer::new(self.most_along(), self.steps, ulp)
    }
}

/// The search of spheres, for rays with one kind of start.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct BallPlan {
    groups: Vec<Group>,
    /// The greatest distance of a start from the origin.
    farthest: f64,
    ulp: f64,
}

impl BallPlan {
    /// The search of rays that start at `eyes` or between them, or on surfaces. By face label,
    /// `transmits` is true if rays may go on beyond the face. Nearer than an `ulp`, a point may be on
    /// either side.
    pub(super) fn new(
        geometry: &StageGeometry,
        eyes: &[DVec3],
        transmits: &[bool],
        start: Start,
        ulp: f64,
    ) -> Self {
        let farthest = match start {
            Start::Surface => geometry.radius(),
            Start::Camera => eyes.iter().map(|eye| eye.length()).fold(0.0, f64::max),
        };
        let mut plan = Self {
            groups: Vec::new(),
            farthest,
            ulp,
        };
        for (place, ball) in geometry.balls.iter().enumerate() {
            let others = || {
                let others = geometry.balls.iter().enumerate();
                others
                    .filter(move |(other, _)| *other != place)
                    .map(|(_, other)| other)
            };
            // Points of another sphere's surface are inside.
            let is_entered = |other: &StageBall| {
                let apart = ball.centre.distance(other.centre);
                (apart - other.radius).abs() < ball.radius - ulp
            };
            let cuts =
                |outline: &[DVec3]| polygon_distance(outline, ball.centre) < ball.radius - ulp;
            let seen_from_inside = ball_holds(ball, eyes, ulp);
            let from_inside = seen_from_inside
                || start == Start::Surface
                    && (transmits[ball.label as usize]
                        || others().any(is_entered)
                        || geometry.corners.iter().any(cuts));
            let shines = |label: u32| {
                let mut faces = geometry.faces.iter();
                faces.any(|face| face.label == label && face.emits)
            };
            let to_inside = others().any(|other| other.emitter.is_some() && is_entered(other))
                || (0..)
                    .zip(geometry.corners.iter())
                    .any(|(n, corners)| cuts(corners) && shines(n));
            let steps = 1 - ball.radius.log2().ceil() as i32;
            let fits = |group: &&mut Group| {
                (group.steps, group.from_inside, group.to_inside) == (steps, from_inside, to_inside)
                    && group.balls.iter().all(|other| {
                        let apart = ball.centre.distance(other.centre);
                        apart >= ball.radius + other.radius - ulp
                    })
            };
            if let Some(group) = plan.groups.iter_mut().find(fits) {
                group.balls.push(*ball);
                continue;
            }
            plan.groups.push(Group {
                steps,
                from_inside,
                to_inside,
                balls: vec![*ball],
            });
        }
        plan
    }

    /// Updates `nearest` with all spheres.
    pub(super) fn nearest<A: Arith>(&self, cx: &mut A, ray: &Ray<A>, nearest: &mut Running<A>) {
        if self.groups.is_empty() {
            return;
        }
        let shared = self.shared(cx, ray.origin, ray.direction);
        for group in &self.groups {
            let (found, here) = self.nearest_of(cx, group, &shared, ray);
            let hit = math!(cx, found && here.distance < nearest.distance);
            nearest.replace(cx, hit, &here);
        }
    }

    /// Returns whether the ray meets a sphere of the group, and the nearest hit.
    fn nearest_of<A: Arith>(
        &self,
        cx: &mut A,
        group: &Group,
        shared: &Shared<A>,
        ray: &Ray<A>,
    ) -> (A::Bool, Running<A>) {
        let scaled = shared.scaled(cx, group.steps, group.finer(self.ulp));
        let far = group.most_along() + self.ulp;
        let mut along = cx.real(far);
        let mut square = cx.real(0.0);
        let mut face = cx.index(NO_FACE);
        let mut inside = cx.truth(false);
        for ball in &group.balls {
            cx.enter(TracerPart::Ball(ball.label as usize));
            let line = scaled.line(cx, ball, group.most_along());
            let left = cx.is(ray.from, ball.number);
            let (ahead, meets) = (scaled.starts_before(cx, &line), line.meets(cx));
            let (nearer, starts_inside) = if group.from_inside {
                let starts_inside = scaled.starts_inside(cx, &line, left, ahead);
                let meets = math!(cx, left || meets);
                let before = math!(cx, line.along < along && !inside);
                let from_outside = math!(cx, (ahead && !left) && before);
                (
                    math!(cx, meets && (starts_inside || from_outside)),
                    starts_inside,
                )
            } else {
                let meets = math!(cx, (meets && ahead) && !left);
                (math!(cx, meets && line.along < along), cx.truth(false))
            };
            // Where it counts it is at most the square of `G r`, which is at most 2.
            let own = math!(cx, known(line.square, 0.0, 4.25));
            let label = cx.index(ball.label);
            along = cx.select(nearer, line.along, along);
            square = cx.select(nearer, own, square);
            face = cx.select_index(nearer, label, face);
            inside = cx.select_truth(nearer, starts_inside, inside);
            cx.leave();
        }
        let root = math!(cx, sqrt(max(square, 0.0)));
        let distance = math!(cx, select(inside, along + root, along - root));
        let distance = math!(cx, max(distance - scaled.start, 0.0));
        let distance = cx.scale(distance, scale(-group.steps));
        let none = cx.is(face, NO_FACE);
        let found = math!(cx, scaled.near && !none);
        let front = cx.not(inside);
        let here = Running {
            distance,
            face,
            front,
        };
        (found, here)
    }

    /// True where `hidden` is, or where a sphere stands between the start of `ray` and its end on lamp
    /// number `lamp`, one length of its direction away.
    pub(super) fn occluded<A: Arith>(
        &self,
        cx: &mut A,
        ray: &Ray<A>,
        lamp: A::Index,
        mut hidden: A::Bool,
    ) -> A::Bool {
        if self.groups.is_empty() {
            return hidden;
        }
        let length = cx.length(ray.direction);
        let mut unit = ray.direction;
        for component in &mut unit {
            *component = math!(cx, div(*component, length, 1.0));
        }
        let shared = self.shared(cx, ray.origin, unit);
        for group in &self.groups {
            let scaled = shared.scaled(cx, group.steps, group.finer(self.ulp));
            let end = cx.scale(length, scale(group.steps));
            let end = math!(cx, scaled.start + end);
            for ball in &group.balls {
                cx.enter(TracerPart::Ball(ball.label as usize));
                let line = scaled.line(cx, ball, group.most_along());
                let left = cx.is(ray.from, ball.number);
                let (ahead, meets) = (scaled.starts_before(cx, &line), line.meets(cx));
                let crosses = if group.from_inside || group.to_inside {
                    let inside = scaled.starts_inside(cx, &line, left, ahead);
                    let root = math!(cx, sqrt(max(known(line.square, 0.0, 4.25), 0.0)));
                    let along = line.along;
                    let met = math!(cx, select(inside, along + root, along - root));
                    let meets = math!(cx, (left || meets) && met < end);
                    math!(cx, meets && (inside || ahead && !left))
                } else {
                    // Both ends are outside, so the middle of a crossing is between them.
                    let between = math!(cx, ahead && line.along < end);
                    math!(cx, (meets && between) && !left)
                };
                hidden = hides(cx, ball, lamp, crosses, hidden);
                cx.leave();
            }
        }
        hidden
    }

    /// The numbers of a ray that all spheres share.
    fn shared<A: Arith>(&self, cx: &mut A, origin: Vector<A>, direction: Vector<A>) -> Shared<A> {
        let groups = || self.groups.iter();
        let steps = groups().map(|group| group.steps).max().unwrap_or(0);
        let most = groups().map(Group::most_along).fold(0.0, f64::max);
        let finer = Finer::new(most, steps, self.ulp);
        let steps = steps + finer.foot;
        let (up, fine) = (scale(steps), scale(finer.excess / 2));
        let coarse = scale(-finer.excess);
        let mut excess = cx.real(-scale(finer.excess));
        let mut along = cx.real(0.0);
        let mut foot = origin;
        for axis in 0..3 {
            let component = cx.scale(direction[axis], fine);
            excess = math!(cx, excess + component * component);
            foot[axis] = cx.scale(origin[axis], up);
            along = math!(cx, along + foot[axis] * direction[axis]);
        }
        let slack = SLACK * scale(finer.excess) * self.ulp;
        let excess = math!(cx, known(excess, -slack, slack));
        let grown = |cx: &mut A, number: A::Real| {
            let more = math!(cx, scale(number * excess, coarse));
            math!(cx, number + more)
        };
        let far = self.farthest * 1.01 * up;
        let along = math!(cx, known(along, -far, far));
        // Over `d.d`, up to the square of `e`.
        let less = math!(cx, scale(along * excess, coarse));
        let along = math!(cx, along - less);
        let mut near = cx.truth(true);
        for axis in 0..3 {
            let moved = math!(cx, foot[axis] - along * direction[axis]);
            let most = self.farthest.min(REACH) * 1.01 * up;
            if self.farthest > REACH {
                let (low, high) = (cx.real(-most), cx.real(most));
                near = math!(cx, near && (low <= moved && moved <= high));
            }
            foot[axis] = cx.known(moved, -most, most);
        }
        let mut square = cx.real(0.0);
        for part in foot {
            square = math!(cx, square + part * part);
        }
        Shared {
            direction,
            foot: [grown(cx, foot[0]), grown(cx, foot[1]), grown(cx, foot[2])],
            square: grown(cx, square),
            start: along,
            near,
            excess,
            steps,
            finer,
            step: 2.0 * self.ulp,
        }
    }
}

/// `2^steps`
fn scale(steps: i32) -> f64 {
    2.0_f64.powi(steps)
}

/// True if a point of the box around `eyes` is inside the sphere, or nearly.
fn ball_holds(ball: &StageBall, eyes: &[DVec3], ulp: f64) -> bool {
    let low = eyes.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = eyes.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    !eyes.is_empty() && ball.outside(ball.centre.clamp(low, high)) < ulp
}

/// The numbers of a ray that all spheres share, times powers of a `G`.
struct Shared<A: Arith> {
    direction: Vector<A>,
    /// `G d.d p`
    foot: Vector<A>,
    /// `G^2 d.d p.p`
    square: A::Real,
    /// `G` times the place of the ray's start on the line, from `p`.
    start: A::Real,
    /// False if the line is so far away that it meets no sphere.
    near: A::Bool,
    /// `e`, times a power of two.
    excess: A::Real,
    /// `g`
    steps: i32,
    finer: Finer,
    /// The unit to which `G c` is rounded. The ray's own rounding moves a hit further than that.
    step: f64,
}

impl<A: Arith> Shared<A> {
    /// The numbers of spheres with `G = 2^steps`, which is at most the `G` of all. The foot keeps the finer
    /// bits that these spheres need.
    fn scaled(&self, cx: &mut A, steps: i32, finer: Finer) -> Self {
        let factor = scale(steps - self.steps);
        let up = scale(steps + finer.foot - self.steps);
        let [x, y, z] = self.foot;
        Self {
            direction: self.direction,
            foot: [cx.scale(x, up), cx.scale(y, up), cx.scale(z, up)],
            square: cx.scale(self.square, factor * factor),
            start: cx.scale(self.start, factor),
            near: self.near,
            excess: self.excess,
            steps,
            finer: Finer {
                excess: self.finer.excess,
                ..finer
            },
            step: self.step,
        }
    }

    /// The line of the ray beside a sphere. `most` bounds `G |b|`.
    fn line(&self, cx: &mut A, ball: &StageBall, most: f64) -> Line<A> {
        let up = scale(self.steps);
        let centre = ball.centre * up;
        let centre = (centre / self.step).round() * self.step;
        let c = centre.to_array();
        let constant = centre.length_squared() - (ball.radius * up).powi(2);
        let coarse = (constant / STEP_OF_SQUARE).round() * STEP_OF_SQUARE;
        let fine = scale(self.finer.along);
        let [x, y, z] = [0, 1, 2].map(|k| cx.scale(self.direction[k], c[k] * fine));
        let along = math!(cx, known(x + y + z, -most * fine, most * fine));
        let square = math!(cx, scale(along * along, scale(-2 * self.finer.along)));
        let along = cx.scale(along, 1.0 / fine);
        let twice = scale(1 - self.finer.foot);
        let [x, y, z] = [0, 1, 2].map(|k| cx.scale(self.foot[k], c[k] * twice));
        let excess = cx.scale(self.excess, coarse * scale(-self.finer.excess));
        let power = math!(cx, (self.square - (x + y + z)) + (excess + real(constant)));
        Line {
            along,
            square: math!(cx, square - power),
        }
    }

    /// True if the ray starts before the middle of the crossing.
    fn starts_before(&self, cx: &mut A, line: &Line<A>) -> A::Bool {
        math!(cx, self.start < line.along)
    }

    /// True if the ray starts inside, or on the sphere and goes `ahead` into it.
    fn starts_inside(&self, cx: &mut A, line: &Line<A>, left: A::Bool, ahead: A::Bool) -> A::Bool {
        let away = math!(cx, line.along - self.start);
        let within = math!(cx, away * away < line.square);
        cx.select_truth(left, ahead, within)
    }
}

/// A line beside a sphere.
struct Line<A: Arith> {
    /// `G b`
    along: A::Real,
    /// `G^2 h^2`
    square: A::Real,
}

impl<A: Arith> Line<A> {
    /// True if the line meets the sphere. (A sign is a bit; a comparison of 0 with a number is a
    /// subtraction.)
    fn meets(&self, cx: &mut A) -> A::Bool {
        let misses = math!(cx, self.square < 0.0);
        cx.not(misses)
    }
}
