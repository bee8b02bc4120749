//! The corners of polygons, in one list.

use glam::DVec3;
use qrt_scene::valid::Polygon;
use std::ops::Index;

/// The corners of polygons by label, in stage units: 3 or 4 each. Those of a disc are the corners of the square
/// around it.
#[derive(Clone, Debug, PartialEq)]
pub struct Corners {
    points: Vec<DVec3>,
    /// By polygon: the number of corners of it and of all before it.
    ends: Vec<u32>,
}

impl Corners {
    pub(crate) fn new(polygons: &[Polygon], staged: impl Fn(DVec3) -> DVec3) -> Self {
        let number = polygons.iter().map(|polygon| usize::from(polygon.corners));
        let mut points = Vec::with_capacity(number.sum());
        let ends = polygons.iter().map(|polygon| {
            let corners = &polygon.vertices[..usize::from(polygon.corners)];
            points.extend(corners.iter().map(|&corner| staged(corner)));
            points.len() as u32
        });
        let ends = ends.collect();
        Self { points, ends }
    }

    /// Number of polygons.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// True if there are no polygons.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The corners of each polygon.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[DVec3]> {
        (0..self.len()).map(|polygon| &self[polygon])
    }

    /// The corners of `polygon`, or `None` if there is no such polygon.
    pub fn get(&self, polygon: usize) -> Option<&[DVec3]> {
        (polygon < self.len()).then(|| &self[polygon])
    }

    /// The corners of all polygons.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }
}

impl Index<usize> for Corners {
    type Output = [DVec3];

    fn index(&self, polygon: usize) -> &[DVec3] {
        let start = polygon
            .checked_sub(1)
            .map_or(0, |before| self.ends[before] as usize);
        &self.points[start..self.ends[polygon] as usize]
    }
}
