//! The places where a path's vertices may lie, and for each the places that a ray from it may reach:
//! the geometry that the bound on a path's colour uses.
//!
//! A place is a side of a face. A ray that leaves it stays on that side of the face's plane. It
//! meets no face that lies in or behind this plane, and no side of a face that looks away from the
//! place it left: the top of a box is not met from the floor. If there are many faces or any
//! sphere, or if no lamp is sampled, a place is a whole surface, and each place may be reached from each.
//!
//! This is true of the faces as they are written. A ray that slips through between two faces, within
//! the tolerance of their edges, may carry more than the bound: machines then end with an error.

use super::geometry::StageGeometry;
use super::polygon::FaceFrame;
use glam::DVec3;
use qrt_scene::lights::{on_all_cores, strongest_form};

/// Most faces whose sides are distinguished.
const MOST_FACES: usize = 512;
/// Most pairs of a face and a lamp.
const MOST_LIT: usize = 4096;

/// Number of pairs of parts that are compared for all sides of faces and lamps.
const MOST_PARTS: usize = 32_000;
/// Least number of pairs of parts that are compared for one side of a face and one lamp.
const FEWEST_PARTS: usize = 32;

/// The least distance of a corner that is on a side of a plane, in stage units: above rounding.
const SLACK: f64 = 1e-9;

/// The places of a scene.
#[derive(Clone, Debug)]
pub(crate) struct Places {
    /// By place: its surface.
    surfaces: Vec<u32>,
    /// All places, if they are whole surfaces.
    all: Vec<u32>,
    /// If places are sides of faces: by place, true if primary rays may meet it, and the places that
    /// rays from it may meet.
    seen: Option<(Vec<bool>, Vec<Vec<u32>>)>,
}

impl Places {
    /// Places that are whole surfaces, `number` of them.
    pub(crate) fn surfaces(number: usize) -> Self {
        Self {
            surfaces: (0..number as u32).collect(),
            all: (0..number as u32).collect(),
            seen: None,
        }
    }

    /// Places that are sides of faces. Place `2 label` is the front of a face, the next place its
    /// back. `transmits` is true for faces that rays leave on both sides. Primary rays leave
    /// `starts`. If there are too many faces, or too many for `lamps` lamps, the places are whole
    /// surfaces.
    pub(crate) fn sides(
        geometry: &StageGeometry,
        (surface_of, surfaces): (&[u32], usize),
        transmits: &[bool],
        starts: &[DVec3],
        lamps: usize,
    ) -> Self {
        let faces = geometry.corners.len();
        if faces > MOST_FACES || faces * lamps > MOST_LIT || !geometry.balls.is_empty() {
            return Self::surfaces(surfaces);
        }
        // By face and other face: true if a corner of the other is in front of the face, and behind it.
        let of_plane = |face: usize| -> Vec<[bool; 2]> {
            let FaceFrame { normal, centre, .. } = geometry.frame(face);
            let sides = geometry.corners.iter().map(|points| {
                let mut sides = [false; 2];
                for point in points {
                    let rise = normal.dot(*point - centre);
                    sides[0] |= rise > SLACK;
                    sides[1] |= -rise > SLACK;
                }
                sides
            });
            sides.collect()
        };
        let apart = on_all_cores(faces, 64, of_plane).concat();
        let mut next = Vec::with_capacity(2 * faces);
        for own in 0..faces {
            let mut met = [(); 2].map(|()| Vec::with_capacity(faces));
            for face in 0..faces {
                let [front, back] = apart[own * faces + face];
                let leaves = if transmits[own] {
                    [front || back; 2]
                } else {
                    [front, back]
                };
                // The sides of the other face on which the own face has a corner.
                let sides = apart[face * faces + own];
                for (met, leaves) in met.iter_mut().zip(leaves) {
                    for (side, is_met) in (2 * face as u32..).zip(sides) {
                        if leaves && is_met {
                            met.push(side);
                        }
                    }
                }
            }
            next.extend(met);
        }
        // A camera almost on a plane may see the face from either side.
        let first = |place| beyond(geometry, place, starts, -SLACK);
        Self {
            surfaces: (0..2 * faces).map(|place| surface_of[place / 2]).collect(),
            all: Vec::new(),
            seen: Some(((0..2 * faces).map(first).collect(), next)),
        }
    }

    /// Number of places.
    pub(crate) fn len(&self) -> usize {
        self.surfaces.len()
    }

    /// The surface of a place.
    pub(crate) fn surface(&self, place: usize) -> u32 {
        self.surfaces[place]
    }

    /// The places that primary rays may meet.
    pub(crate) fn first(&self) -> impl Iterator<Item = usize> {
        (0..self.len()).filter(|&place| self.seen.as_ref().is_none_or(|(first, _)| first[place]))
    }

    /// The places that rays from `place` may meet, in order.
    pub(crate) fn next(&self, place: usize) -> &[u32] {
        match &self.seen {
            Some((_, next)) => &next[place],
            None => &self.all,
        }
    }

    /// True if a face of this surface is in the place, on one side or on both.
    pub(crate) fn holds(&self, place: usize, (face, surface): (u32, u32)) -> bool {
        match self.seen {
            Some(_) => place / 2 == face as usize,
            None => self.surfaces[place] == surface,
        }
    }

    /// A number by place: `of_side` for a face and the sign of its side, or else `by_surface`.
    pub(crate) fn by_side(
        &self,
        of_side: impl Fn(usize, f64) -> f64,
        by_surface: impl Fn(u32) -> f64,
    ) -> Vec<f64> {
        let of = |place: usize| match self.seen {
            Some(_) => of_side(place / 2, side(place)),
            None => by_surface(self.surfaces[place]),
        };
        (0..self.len()).map(of).collect()
    }

    /// Upper bounds of `q / r^4` by lamp and place, for the light of the faces `lamps`.
    /// `is_smooth` is true for faces with interpolated normals. `by_surface` gives the bound of a surface for a lamp's
    /// number, or `None` if the surface samples no lamps: its places have no bound.
    pub(crate) fn lit_by(
        &self,
        geometry: &StageGeometry,
        lamps: &[u32],
        is_smooth: impl Fn(u32) -> bool + Sync,
        by_surface: impl Fn(u32, usize) -> Option<f64> + Sync,
    ) -> Vec<Vec<f64>> {
        let places = self.len();
        if places == 0 || lamps.is_empty() {
            return vec![Vec::new(); lamps.len()];
        }
        let parts = (MOST_PARTS / (places * lamps.len())).max(FEWEST_PARTS);
        let of = |pair: usize| {
            let (number, place) = (pair / places, pair % places);
            let Some(known) = by_surface(self.surfaces[place], number) else {
                return f64::INFINITY;
            };
            if self.seen.is_none() || known == 0.0 {
                return known;
            }
            // Where places are sides, lamps are polygons.
            let lamp = &geometry.corners[lamps[number] as usize];
            if before(geometry, place, lamp) {
                let (face, smooth) = (place / 2, is_smooth(place as u32 / 2));
                known.min(strongest_form(&geometry.corners[face], smooth, lamp, parts))
            } else {
                0.0
            }
        };
        let count = lamps.len() * places;
        let all = if self.seen.is_some() {
            on_all_cores(count, 8, of)
        } else {
            (0..count).map(of).collect()
        };
        all.chunks(places).map(<[f64]>::to_vec).collect()
    }
}

/// True if one of the points is in front of this side of a face.
fn before(geometry: &StageGeometry, place: usize, points: &[DVec3]) -> bool {
    beyond(geometry, place, points, SLACK)
}

/// True if one of the points is farther than `least` from the plane, towards this side of the face.
fn beyond(geometry: &StageGeometry, place: usize, points: &[DVec3], least: f64) -> bool {
    let FaceFrame { normal, centre, .. } = geometry.frame(place / 2);
    let rise = |point: &DVec3| side(place) * normal.dot(*point - centre);
    points.iter().any(|point| rise(point) > least)
}

/// 1 for the front of a face, -1 for its back.
fn side(place: usize) -> f64 {
    if place.is_multiple_of(2) { 1.0 } else { -1.0 }
}
