//! The face table: a face whose number is in superposition is looked up in a QROM.
//!
//! [`super::StageGeometry`] holds faces as constants, for a machine that tests all of them in turn
//! and folds them into its code. A [`FaceTable`] holds the same faces as rows of tables, for a
//! machine that tests one face whose number is in a register. The intersection is the same: the
//! crossing of a ray and a plane ([`super::cross`]), and the test that it lies within the edges.

use super::crossing::{AxisPermuted, Crossing, cross};
use super::geometry::{Face, NO_FACE, StageGeometry};
use super::intersect::{DiscNumbers, Edges, meets};
use super::polygon::{DiscTest, EdgeTest};
use super::ray::{Hit, NearestSearch, Ray};
use super::{Arith, Stage};
use std::cell::Cell;

/// Faces in the order in which the running nearest tests them. Of equally distant faces, the first
/// is the nearest.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceTable {
    /// The point where all rays start, if there is one, otherwise the origin. The parts of planes
    /// and edges that depend on it are in the tables.
    viewpoint: [f64; 3],
    /// The main axis of the plane of each face.
    axes: Vec<u32>,
    /// The form of the plane of each face, and the plane's offset as seen from the viewpoint.
    planes: Vec<[f64; 3]>,
    slots: Vec<Slot>,
    /// The tests of discs, if there are any.
    discs: Option<DiscColumns>,
    /// For each face, 1 if primary rays start on its plane and so meet it nowhere, else 0.
    starts_on: Vec<u32>,
    /// The label of each face, and after the last [`NO_FACE`].
    labels: Vec<u32>,
    /// True if the scene has spheres, which the table lacks.
    pub lacks_spheres: bool,
}

/// One half-plane edge test of each face, as seen from the viewpoint:
/// `low <= p[main] + slope p[other] <= high`.
#[derive(Clone, Debug, Default, PartialEq)]
struct Slot {
    /// For each face, 1 if the main coordinate is the second of the two, else 0.
    second: Vec<u32>,
    slope: Vec<[f64; 1]>,
    low: Vec<[f64; 1]>,
    high: Vec<[f64; 1]>,
}

/// The test of each face's circle, as seen from the viewpoint: see [`DiscTest`].
#[derive(Clone, Debug, PartialEq)]
struct DiscColumns {
    /// For each face, 1 if it is a disc, else 0.
    is: Vec<u32>,
    /// For each form and face, 1 if the main coordinate is the second of the two, else 0.
    second: [Vec<u32>; 2],
    /// For each form and face, the other coefficient; the form's value at the centre; the scale.
    forms: [Vec<[f64; 3]>; 2],
    square: Vec<[f64; 1]>,
    /// The greatest of all scales.
    most: f64,
}

impl FaceTable {
    /// The faces that rays of `stage`'s camera may meet.
    pub fn new<const C: usize>(stage: &Stage<C>) -> Self {
        let geometry = stage.geometry();
        let camera = &stage.camera;
        let viewpoint = if camera.perspective && stage.lens.is_none() {
            camera.fixed
        } else {
            [0.0; 3]
        };
        let mut listing = Self {
            viewpoint,
            axes: Vec::new(),
            planes: Vec::new(),
            slots: Vec::new(),
            discs: DiscColumns::new(geometry, viewpoint),
            starts_on: Vec::new(),
            labels: Vec::new(),
            lacks_spheres: !geometry.balls.is_empty(),
        };
        let most = geometry
            .faces
            .iter()
            .map(|face| face.edge_tests.len())
            .max();
        listing.slots.resize(most.unwrap_or(0), Slot::default());
        for (number, plane) in (0..).zip(&geometry.planes) {
            let starts = u32::from(stage.starts_on.contains(&number));
            let seen = |k: usize| viewpoint[(plane.axis + k) % 3];
            let [a, b] = plane.form;
            let offset = plane.offset - (seen(0) + a * seen(1) + b * seen(2));
            for face in &geometry.faces[plane.faces.clone()] {
                listing.axes.push(plane.axis as u32);
                listing.starts_on.push(starts);
                listing.planes.push([a, b, offset]);
                listing.labels.push(face.label);
                let edge_tests = face.edge_tests.iter();
                let edge_tests =
                    edge_tests.map(|edge_test| Row::new(edge_test, [seen(1), seen(2)]));
                let mut edge_tests: Vec<Row> = edge_tests.collect();
                // Put similar tests into one slot: a column of equal entries costs nothing.
                edge_tests.sort_by_key(|row| row.second);
                let mut edge_tests = edge_tests.into_iter();
                for slot in &mut listing.slots {
                    slot.push(&edge_tests.next().unwrap_or(Row::OPEN));
                }
            }
        }
        let away = viewpoint.map(f64::abs).into_iter().fold(0.0, f64::max);
        for slot in &mut listing.slots {
            // No point of a face is that far away.
            slot.close(4.0 * (1.0 + away));
        }
        listing.labels.push(NO_FACE);
        listing
    }

    /// Number of faces of the table.
    pub fn len(&self) -> usize {
        self.axes.len()
    }

    /// True if the table has no faces.
    pub fn is_empty(&self) -> bool {
        self.axes.is_empty()
    }

    /// The label in the scene of each face, and after the last [`NO_FACE`].
    pub fn labels(&self) -> &[u32] {
        &self.labels
    }

    /// Returns whether a ray of the camera meets face number `face`, and at which distance. A
    /// number beyond the last face meets nothing.
    #[inline(always)]
    pub fn meet<A: Arith>(&self, cx: &mut A, ray: &Ray<A>, face: A::Index) -> (A::Bool, A::Real) {
        let crossing = self.cross(cx, ray, face);
        let meets = meets(cx, &crossing, &Looked { list: self, face });
        let starts = cx.entry(&self.starts_on, face);
        let starts = cx.is(starts, 1);
        let listed = cx.below(face, self.len() as u32);
        (math!(cx, (meets && !starts) && listed), crossing.distance)
    }

    /// The hit of a ray of the camera on face number `face`; none if `face` is the number of faces.
    #[inline(always)]
    fn hit<A: Arith>(&self, cx: &mut A, ray: &Ray<A>, face: A::Index, wanted: A::Bool) -> Hit<A> {
        let crossing = self.cross(cx, ray, face);
        let label = cx.entry(&self.labels, face);
        Hit::new(cx, crossing.distance, label, wanted)
    }

    #[inline(always)]
    fn cross<A: Arith>(&self, cx: &mut A, ray: &Ray<A>, face: A::Index) -> Crossing<A> {
        let seen = Ray {
            origin: vector!(cx, ray.origin - constant(self.viewpoint)),
            ..*ray
        };
        let axis = cx.entry(&self.axes, face);
        let turned = AxisPermuted::looked_up(cx, &seen, axis);
        let [a, b, offset] = cx.rows(&self.planes, face);
        cross(cx, [a, b], offset, &turned)
    }
}

/// The edges of a face whose number is in a register.
struct Looked<'a, A: Arith> {
    list: &'a FaceTable,
    face: A::Index,
}

impl<A: Arith> Edges<A> for Looked<'_, A> {
    #[inline(always)]
    fn hold(&self, cx: &mut A, [first, second]: [A::Real; 2]) -> A::Bool {
        let mut inside = cx.truth(true);
        for slot in &self.list.slots {
            let swap = cx.entry(&slot.second, self.face);
            let swap = cx.is(swap, 1);
            let main = cx.select(swap, second, first);
            let other = cx.select(swap, first, second);
            let [slope] = cx.rows(&slot.slope, self.face);
            let value = math!(cx, main + other * slope);
            if slot.low.iter().any(|[low]| low.is_finite()) {
                let above = cx.at_least(value, &slot.low, self.face);
                inside = cx.and(inside, above);
            }
            if slot.high.iter().any(|[high]| high.is_finite()) {
                let below = cx.at_most(value, &slot.high, self.face);
                inside = cx.and(inside, below);
            }
        }
        if let Some(discs) = &self.list.discs {
            let within = discs.hold(cx, self.face, [first, second]);
            inside = cx.and(inside, within);
        }
        inside
    }
}

/// Finds nearest intersections, of which the first ray's is an input: a face's number in a
/// [`FaceTable`], or the number of its faces for none. The hits of the other rays are searched.
///
/// It serves one trace: the first call takes the input.
pub struct PrimaryHitGiven<'a, A: Arith, N> {
    list: &'a FaceTable,
    first: Cell<Option<A::Index>>,
    others: &'a N,
}

impl<'a, A: Arith, N: NearestSearch<A>> PrimaryHitGiven<'a, A, N> {
    /// Creates it for rays of which the first meets face number `first`. `others` finds the other
    /// hits.
    pub fn new(list: &'a FaceTable, first: A::Index, others: &'a N) -> Self {
        Self {
            list,
            first: Cell::new(Some(first)),
            others,
        }
    }
}

impl<A: Arith, N: NearestSearch<A>> NearestSearch<A> for PrimaryHitGiven<'_, A, N> {
    #[inline(always)]
    fn nearest(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A> {
        match self.first.take() {
            Some(face) => self.list.hit(cx, ray, face, wanted),
            None => self.others.nearest(cx, ray, wanted),
        }
    }

    #[inline(always)]
    fn emitter(&self, cx: &mut A, ray: &Ray<A>, wanted: A::Bool) -> Hit<A> {
        match self.first.take() {
            Some(face) => self.list.hit(cx, ray, face, wanted),
            None => self.others.emitter(cx, ray, wanted),
        }
    }

    #[inline(always)]
    fn occluded(&self, cx: &mut A, ray: &Ray<A>, lamp: A::Index, wanted: A::Bool) -> A::Bool {
        self.others.occluded(cx, ray, lamp, wanted)
    }
}

/// A face's row of a [`Slot`].
struct Row {
    second: u32,
    slope: f64,
    low: f64,
    high: f64,
}

impl Row {
    /// The test that every point passes.
    const OPEN: Self = Self {
        second: 0,
        slope: 0.0,
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };

    /// The row of `edge_test`. `seen` is the viewpoint's place on the plane's two other axes.
    fn new(edge_test: &EdgeTest, seen: [f64; 2]) -> Self {
        let [a, b] = edge_test.form;
        let away = a * seen[0] + b * seen[1];
        // The coefficient with the greater magnitude is 1.
        let second = a != 1.0;
        Self {
            second: u32::from(second),
            slope: if second { a } else { b },
            low: edge_test.low - away,
            high: edge_test.high - away,
        }
    }
}

impl DiscColumns {
    /// The columns of all faces; none if no face is a disc.
    fn new(geometry: &StageGeometry, viewpoint: [f64; 3]) -> Option<Self> {
        let mut columns = Self {
            is: Vec::new(),
            second: [Vec::new(), Vec::new()],
            forms: [Vec::new(), Vec::new()],
            square: Vec::new(),
            most: 0.0,
        };
        for plane in &geometry.planes {
            let seen = [1, 2].map(|k| viewpoint[(plane.axis + k) % 3]);
            for face in &geometry.faces[plane.faces.clone()] {
                columns.push(face, seen);
            }
        }
        columns.is.contains(&1).then_some(columns)
    }

    fn push(&mut self, face: &Face, seen: [f64; 2]) {
        let open = DiscTest {
            centre: [0.0; 2],
            scale: [0.0; 2],
            square: 0.0,
        };
        let disc = face.disc.as_deref().unwrap_or(&open);
        for k in 0..2 {
            let row = face
                .disc
                .as_ref()
                .map_or(Row::OPEN, |_| Row::new(&face.edge_tests[k], seen));
            let away = if face.disc.is_some() {
                let [a, b] = face.edge_tests[k].form;
                a * seen[0] + b * seen[1]
            } else {
                0.0
            };
            self.second[k].push(row.second);
            self.forms[k].push([row.slope, disc.centre[k] - away, disc.scale[k]]);
            self.most = self.most.max(disc.scale[k]);
        }
        self.is.push(u32::from(face.disc.is_some()));
        self.square.push([disc.square]);
    }

    /// True if face number `face` is no disc, or if the point is within its circle.
    #[inline(always)]
    fn hold<A: Arith>(&self, cx: &mut A, face: A::Index, [first, second]: [A::Real; 2]) -> A::Bool {
        let zero = cx.real(0.0);
        let [square] = cx.rows(&self.square, face);
        let mut numbers = DiscNumbers::<A> {
            centre: [zero; 2],
            scale: [zero; 2],
            square,
            most: self.most,
        };
        let values = [0, 1].map(|k| {
            let swap = cx.entry(&self.second[k], face);
            let swap = cx.is(swap, 1);
            let main = cx.select(swap, second, first);
            let other = cx.select(swap, first, second);
            let [slope, centre, scale] = cx.rows(&self.forms[k], face);
            (numbers.centre[k], numbers.scale[k]) = (centre, scale);
            math!(cx, main + other * slope)
        });
        let within = numbers.hold(cx, values);
        let is = cx.entry(&self.is, face);
        let is = cx.is(is, 1);
        math!(cx, within || !is)
    }
}

impl Slot {
    fn push(&mut self, row: &Row) {
        self.second.push(row.second);
        self.slope.push([row.slope]);
        self.low.push([row.low]);
        self.high.push([row.high]);
    }

    /// Gives every face a finite bound, in a column in which some faces have one.
    fn close(&mut self, far: f64) {
        for (column, sign) in [(&mut self.low, -1.0), (&mut self.high, 1.0)] {
            if column.iter().any(|[bound]| bound.is_finite()) {
                for [bound] in column {
                    if bound.is_infinite() {
                        *bound = sign * far;
                    }
                }
            }
        }
    }
}
