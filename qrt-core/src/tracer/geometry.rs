//! Polygons made ready for intersection: planes, the faces on them, and shading frames.
//!
//! Everything is in *stage units*: the geometry's bounding box is centred at the origin and scaled
//! by a power of two so that its largest half extent lies in `(1/2, 1]`. A scene a million units
//! across or at a billion from the origin is traced with the same precision as one at home.

use crate::valid::Polygon;
use glam::DVec3;
use std::collections::HashMap;
use std::ops::Range;

/// The face that a ray meets where it meets none.
pub const NO_FACE: u32 = u32::MAX;

/// The plane that a camera ray leaves: none.
pub const NO_PLANE: u32 = u32::MAX;

/// How far edges reach outwards, in stage units, for rays that start within one unit of the
/// origin: a few ulps, so that neighbours overlap rather than leave cracks.
pub const TOLERANCE: f64 = 1.0 / (1_u64 << 49) as f64;

/// How far a hit is drawn from its face's edge towards the face's centre, as a share of the way:
/// more than the edges' tolerance, less than any picture shows. A ray that starts there stands
/// strictly inside the face, so it cannot slip past a neighbour that meets it at that edge.
pub(crate) const INWARD: f64 = 1.0 / (1_u64 << 32) as f64;

/// Planes nearer than this to each other (in coefficients and offset) are one.
const SAME_PLANE: f64 = 1.0 / (1_u64 << 42) as f64;

/// `c . v`, with a greatest coefficient of 1: coefficients of 0 and 1 cost a circuit nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear(
    /// The coefficients of x, y and z.
    pub [f64; 3],
);

impl Linear {
    /// The form proportional to `normal` whose greatest coefficient is 1.
    fn along(normal: DVec3) -> Self {
        let scaled = normal / normal[largest(normal)];
        // What a rotation by a multiple of 90 degrees leaves behind is not a slope.
        Self(
            scaled
                .to_array()
                .map(|c| if c.abs() < f64::EPSILON { 0.0 } else { c }),
        )
    }

    /// Its value at `v`.
    pub fn at_point(&self, v: DVec3) -> f64 {
        v.dot(DVec3::from_array(self.0))
    }

    /// Is `other` within `tolerance` of it, coefficient by coefficient?
    fn near(&self, other: &Self, tolerance: f64) -> bool {
        self.0
            .iter()
            .zip(&other.0)
            .all(|(a, b)| (a - b).abs() <= tolerance)
    }
}

/// `low <= form <= high`; either may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slab {
    /// The form.
    pub form: Linear,
    /// Its least value inside.
    pub low: f64,
    /// Its greatest value inside.
    pub high: f64,
}

/// A plane `form.p = offset` and the faces on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    /// The plane's direction.
    pub form: Linear,
    /// The plane's place.
    pub offset: f64,
    /// Its faces, in [`Geometry::faces`].
    pub faces: Range<usize>,
}

/// A convex polygon on a plane: the intersection of slabs.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// Its number in the order of the scene.
    pub label: u32,
    /// Pairs of parallel edges share a slab: two for a parallelogram, three for a triangle.
    pub slabs: Vec<Slab>,
}

/// A face's frame: tangents, normal (the front) and centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Unit tangent.
    pub tangent: DVec3,
    /// Unit bitangent.
    pub bitangent: DVec3,
    /// Unit normal, `(v1 - v0) x (v2 - v0)`.
    pub normal: DVec3,
    /// Mean of the corners.
    pub centre: DVec3,
}

/// All polygons of a scene, in stage units.
#[derive(Clone, Debug, PartialEq)]
pub struct Geometry {
    /// Distinct planes, in the order of their first face.
    pub planes: Vec<Plane>,
    /// Faces, grouped by plane, in the order of the scene: where faces of one plane overlap, the
    /// one listed first wins.
    pub faces: Vec<Face>,
    /// Frames by face label.
    pub frames: Vec<Frame>,
    /// The plane of each face label.
    pub plane_of: Vec<u32>,
    /// The corners of each face label, 3 or 4.
    pub corners: Vec<Vec<DVec3>>,
    /// The point of the scene that is the stage's origin.
    pub centre: DVec3,
    /// Stage units per scene unit: a power of two.
    pub scale: f64,
}

impl Geometry {
    /// Lowers `polygons`; `reach` are points (the eye) from which rays start too.
    pub fn new(polygons: &[Polygon], reach: &[DVec3]) -> Self {
        let (centre, scale) = stage_units(polygons);
        let staged = |p: DVec3| (p - centre) * scale;
        let far = reach
            .iter()
            .map(|&p| staged(p).abs().max_element())
            .fold(1.0, f64::max);
        let tolerance = TOLERANCE * far;
        let mut geometry = Self {
            planes: Vec::new(),
            faces: Vec::new(),
            frames: Vec::with_capacity(polygons.len()),
            plane_of: Vec::with_capacity(polygons.len()),
            corners: Vec::with_capacity(polygons.len()),
            centre,
            scale,
        };
        let mut on_plane: Vec<Vec<Face>> = Vec::new();
        let mut known: HashMap<[i64; 4], Vec<u32>> = HashMap::new();
        for (label, polygon) in polygons.iter().enumerate() {
            let corners: Vec<DVec3> = polygon.vertices[..polygon.corners as usize]
                .iter()
                .map(|&v| staged(v))
                .collect();
            let frame = frame(&corners);
            let form = Linear::along(frame.normal);
            let offset =
                corners.iter().map(|&c| form.at_point(c)).sum::<f64>() / corners.len() as f64;
            let plane = geometry.find_plane(form, offset, &mut known, &mut on_plane);
            let slabs = slabs(&corners, frame.normal, frame.centre, tolerance);
            geometry.frames.push(frame);
            geometry.plane_of.push(plane);
            geometry.corners.push(corners);
            let faces = &mut on_plane[plane as usize];
            // A second copy of a face is hidden by the first.
            if !faces.iter().any(|face| face.slabs == slabs) {
                faces.push(Face {
                    label: label as u32,
                    slabs,
                });
            }
        }
        for (plane, faces) in geometry.planes.iter_mut().zip(on_plane) {
            let start = geometry.faces.len();
            geometry.faces.extend(faces);
            plane.faces = start..geometry.faces.len();
        }
        geometry
    }

    fn find_plane(
        &mut self,
        form: Linear,
        offset: f64,
        known: &mut HashMap<[i64; 4], Vec<u32>>,
        on_plane: &mut Vec<Vec<Face>>,
    ) -> u32 {
        // Buckets far wider than the tolerance; a plane near a bucket's edge is looked for in the
        // bucket beyond it, too.
        let width = SAME_PLANE * 1024.0;
        let keys = |shift: f64| {
            let [x, y, z] = form.0;
            [x, y, z, offset].map(|c| ((c + shift) / width).floor() as i64)
        };
        let same = |plane: &Plane| {
            plane.form.near(&form, SAME_PLANE) && (plane.offset - offset).abs() <= SAME_PLANE
        };
        let (below, above) = (keys(-SAME_PLANE), keys(SAME_PLANE));
        for code in 0..16_usize {
            let key = std::array::from_fn(|k| {
                if code >> k & 1 == 0 {
                    below[k]
                } else {
                    above[k]
                }
            });
            let found = known.get(&key).and_then(|planes| {
                planes
                    .iter()
                    .copied()
                    .find(|&plane| same(&self.planes[plane as usize]))
            });
            if let Some(plane) = found {
                return plane;
            }
        }
        let plane = self.planes.len() as u32;
        self.planes.push(Plane {
            form,
            offset,
            faces: 0..0,
        });
        on_plane.push(Vec::new());
        known.entry(keys(0.0)).or_default().push(plane);
        plane
    }
}

fn stage_units(polygons: &[Polygon]) -> (DVec3, f64) {
    let mut low = DVec3::INFINITY;
    let mut high = DVec3::NEG_INFINITY;
    for vertex in polygons.iter().flat_map(|polygon| &polygon.vertices) {
        low = low.min(*vertex);
        high = high.max(*vertex);
    }
    let centre = low * 0.5 + high * 0.5;
    let extent = (high * 0.5 - low * 0.5).max_element();
    if polygons.is_empty() || extent <= 0.0 {
        return (DVec3::ZERO, 1.0);
    }
    // extent = m 2^e with m in [1/2, 1): 2^-e takes it to [1/2, 1).
    let (_, exponent) = libm::frexp(extent);
    (centre, libm::ldexp(1.0, -exponent))
}

fn frame(corners: &[DVec3]) -> Frame {
    let (a, b, c) = (corners[0], corners[1], corners[2]);
    // For a quad the diagonals give the same direction and no corner is preferred.
    let normal = match corners.get(3) {
        Some(&d) => (c - a).cross(d - b),
        None => (b - a).cross(c - a),
    };
    let unit = normal.normalize();
    let axis = largest(unit);
    let normal = DVec3::from_array(Linear::along(unit).0).normalize() * unit[axis].signum();
    // A tangent along a coordinate axis where the plane allows it: fewer products.
    let away = match axis {
        0 => DVec3::Y,
        1 => DVec3::Z,
        _ => DVec3::X,
    };
    let tangent = (away - normal * normal.dot(away)).normalize();
    let centre = corners.iter().sum::<DVec3>() / corners.len() as f64;
    Frame {
        tangent,
        bitangent: normal.cross(tangent),
        normal,
        centre,
    }
}

fn largest(v: DVec3) -> usize {
    let v = v.abs();
    if v.x >= v.y && v.x >= v.z {
        0
    } else if v.y >= v.z {
        1
    } else {
        2
    }
}

/// The edges as slabs. Edges are tested in the plane's projection along its main axis.
fn slabs(corners: &[DVec3], normal: DVec3, centre: DVec3, tolerance: f64) -> Vec<Slab> {
    let main = largest(normal);
    let mut slabs: Vec<Slab> = Vec::with_capacity(3);
    for (i, &start) in corners.iter().enumerate() {
        let end = corners[(i + 1) % corners.len()];
        let mut across = (end - start).cross(DVec3::AXES[main]);
        across[main] = 0.0;
        let form = Linear::along(across);
        let edge = 0.5 * (form.at_point(start) + form.at_point(end));
        let spread = 0.5 * (form.at_point(start) - form.at_point(end)).abs();
        let reach = form.0.iter().map(|c| c.abs()).sum::<f64>() * tolerance + spread;
        let (low, high) = if form.at_point(centre) >= edge {
            (edge - reach, f64::INFINITY)
        } else {
            (f64::NEG_INFINITY, edge + reach)
        };
        match slabs
            .iter_mut()
            .find(|slab| slab.form.near(&form, tolerance))
        {
            Some(slab) => {
                slab.low = slab.low.max(low);
                slab.high = slab.high.min(high);
            }
            None => slabs.push(Slab { form, low, high }),
        }
    }
    slabs
}
