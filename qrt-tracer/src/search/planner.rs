//! The facts about a stage that decide how rays are searched.

use crate::convex::Edges;
use crate::geometry::StageGeometry;
use glam::DVec3;
use qrt_scene::lights::Cone;

/// The facts from which the searches of rays are planned.
pub(super) struct Planner<'a> {
    pub(super) geometry: &'a StageGeometry,
    pub(super) edges: &'a Edges,
    /// The points where the camera's rays start, or the corners of the area that they start from.
    pub(super) eyes: &'a [DVec3],
    /// By face label: true if rays may go on beyond the face.
    pub(super) transmits: &'a [bool],
    /// The direction of all rays of an orthographic camera.
    pub(super) parallel: Option<DVec3>,
    /// By face label: its surface.
    pub(super) surface_of: &'a [u32],
    /// The directions of the sun.
    pub(super) sun: Option<Cone>,
    /// An eye within this distance of a plane may be on either side, or on the plane.
    pub(super) ulp: f64,
}

impl Planner<'_> {
    /// The least and the greatest corner of the box around the eyes.
    pub(super) fn eye_box(&self) -> [DVec3; 2] {
        let eyes = || self.eyes.iter().copied();
        [
            eyes().fold(DVec3::INFINITY, DVec3::min),
            eyes().fold(DVec3::NEG_INFINITY, DVec3::max),
        ]
    }
}
