//! Where a path's vertices may lie, and which of these places a ray may go to from which: what the
//! bound on a path's colour knows of the geometry.
//!
//! A place is a side of a face. A ray that leaves it stays on that side of the face's plane, so it
//! meets no face that lies in or behind this plane, nor a side of a face that looks away from the
//! place it left: the top of a box is not met from the floor. Where there are many faces, or where
//! no lamp is sampled, a place is all that is of one surface, and each may be met from each.
//!
//! This is so of the faces as they are written. A ray that slips through between two faces, within
//! the tolerance of their edges, may carry more than the bound: machines end with an error then.

use super::geometry::Geometry;
use crate::lights::strongest_form;
use glam::DVec3;

/// The most faces whose sides are told apart, and the most pairs of a face and a lamp.
const MOST_FACES: usize = 512;
const MOST_LIT: usize = 4096;

/// Pairs of parts that are looked at for all sides of faces and lamps, and for each at least.
const MOST_PARTS: usize = 32_000;
const FEWEST_PARTS: usize = 32;

/// How far a corner must be from a plane to be on a side of it, in stage units: above rounding.
const SLACK: f64 = 1e-9;

/// The places of a scene.
#[derive(Clone, Debug)]
pub(crate) struct Places {
    /// By place: its surface.
    surfaces: Vec<u32>,
    /// Where places are sides of faces: by place, whether primary rays may meet it, and the places
    /// that rays may meet which leave it.
    seen: Option<(Vec<bool>, Vec<Vec<u32>>)>,
}

impl Places {
    /// All that is of one surface is one place.
    pub(crate) fn surfaces(number: usize) -> Self {
        Self {
            surfaces: (0..number as u32).collect(),
            seen: None,
        }
    }

    /// Sides of faces: place `2 label` is the front of a face, the next its back; `transmits` tells
    /// of each face whether rays leave it on both sides. Primary rays leave `starts`. All that is of
    /// one surface, of so many, where there are too many faces, or too many for `lamps` lamps.
    pub(crate) fn sides(
        geometry: &Geometry,
        (surface_of, surfaces): (&[u32], usize),
        transmits: &[bool],
        starts: &[DVec3],
        lamps: usize,
    ) -> Self {
        let faces = geometry.corners.len();
        if faces > MOST_FACES || faces * lamps > MOST_LIT {
            return Self::surfaces(surfaces);
        }
        let outlines = &geometry.corners;
        let sides = 0..2 * outlines.len();
        let from = |place: usize| -> Vec<u32> {
            let leaves = |points: &[DVec3]| {
                let across = transmits[place / 2] && before(geometry, place ^ 1, points);
                across || before(geometry, place, points)
            };
            let meets = |to: &usize| {
                leaves(&outlines[to / 2]) && before(geometry, *to, &outlines[place / 2])
            };
            let met = sides.clone().filter(meets);
            met.map(|place| place as u32).collect()
        };
        // A camera almost on a plane may see the face from either side.
        let first = |place| beyond(geometry, place, starts, -SLACK);
        Self {
            surfaces: sides.clone().map(|place| surface_of[place / 2]).collect(),
            seen: Some((
                sides.clone().map(first).collect(),
                sides.clone().map(from).collect(),
            )),
        }
    }

    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        self.surfaces.len()
    }

    /// The surface of a place.
    pub(crate) fn surface(&self, place: usize) -> u32 {
        self.surfaces[place]
    }

    /// Those that primary rays meet.
    pub(crate) fn first(&self) -> impl Iterator<Item = usize> {
        (0..self.len()).filter(|&place| self.seen.as_ref().is_none_or(|(first, _)| first[place]))
    }

    /// Those that rays meet which leave `place`.
    pub(crate) fn next(&self, place: usize) -> impl Iterator<Item = usize> {
        let listed = self.seen.as_ref().map(|(_, next)| &next[place]);
        let all = if listed.is_some() { 0 } else { self.len() };
        let listed = listed.into_iter().flatten().map(|&next| next as usize);
        listed.chain(0..all)
    }

    /// Whether a face of this surface is in the place, on one side or on both.
    pub(crate) fn holds(&self, place: usize, (face, surface): (u32, u32)) -> bool {
        match self.seen {
            Some(_) => place / 2 == face as usize,
            None => self.surfaces[place] == surface,
        }
    }

    /// An upper bound of `q / r^4` for what one of so many lamps lights of each place, where it is
    /// known by surface.
    pub(crate) fn lit_by(
        &self,
        geometry: &Geometry,
        (lamp, lamps): (u32, usize),
        by_surface: impl Fn(u32) -> f64,
    ) -> Vec<f64> {
        let lamp = &*geometry.corners[lamp as usize];
        let parts = (MOST_PARTS / (self.len() * lamps)).max(FEWEST_PARTS);
        let of = |place: usize| {
            let known = by_surface(self.surfaces[place]);
            if self.seen.is_none() || known == 0.0 {
                known
            } else if before(geometry, place, lamp) {
                known.min(strongest_form(&geometry.corners[place / 2], lamp, parts))
            } else {
                0.0
            }
        };
        (0..self.len()).map(of).collect()
    }
}

/// Whether one of the points is before this side of a face.
fn before(geometry: &Geometry, place: usize, points: &[DVec3]) -> bool {
    beyond(geometry, place, points, SLACK)
}

/// Whether one of the points is further than `least` from the plane, towards this side of the face.
fn beyond(geometry: &Geometry, place: usize, points: &[DVec3], least: f64) -> bool {
    let frame = &geometry.frames[place / 2];
    let side = if place.is_multiple_of(2) { 1.0 } else { -1.0 };
    let rise = |point: &DVec3| side * frame.normal.dot(*point - frame.centre);
    points.iter().any(|point| rise(point) > least)
}
