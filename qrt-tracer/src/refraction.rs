//! The factor by which refractions through the glass of a scene make radiance denser.
//!
//! A refraction scales radiance by the squared ratio of the indices: by `1 / ior^2` against the normal of a
//! face, by `ior^2` along it. Around a closed surface these are the steps of its winding number
//! ([`qrt_scene::polygons::Solid`]), so the product of all of a path's refractions there depends on the path's
//! ends alone. With `w` the number at its last vertex and `v` at the camera, it is `ior^(2 (v - w))`. The
//! possible positions of the camera and of the last vertex therefore give a bound for each solid.
//!
//! This requires that each crossing is traced. Faces that overlap on one plane are crossed as one, and the
//! first of the list decides how. Scenes in which glass overlaps glass, except in slivers, are rejected
//! ([`qrt_scene::valid`]). If there are slivers, or if another material that transmits lies on glass, no
//! refraction has a known bound.

use super::geometry::{Face, StageGeometry};
use glam::DVec3;
use qrt_scene::polygons::{Overlap, SAME_PLANE, Solid, first_overlap, solids};
use qrt_scene::valid::{Scatter, Surface};

/// Boxes nearer than this, in stage units, may have points in common.
const MARGIN: f64 = 1e-9;

/// Most solids whose boxes are compared; more are assumed to have points in common.
const MOST_SOLIDS: usize = 4096;

/// Bounds on the refractions of all paths.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Refraction {
    /// By surface: true if it is glass of which all faces are those of solids.
    known: Vec<bool>,
    most: f64,
}

/// A solid of glass, with the greatest factors that a path's colour gains from it.
struct Piece {
    solid: Solid,
    /// Factor of a path that starts outside and ends within.
    entered: f64,
    /// Factor of a path that starts within and ends outside.
    left: f64,
}

impl Refraction {
    /// Bounds for the faces of `geometry`. `surface_of` contains their surfaces, by label. Rays of the
    /// camera leave `starts`, or the area between them.
    pub(super) fn new(
        geometry: &StageGeometry,
        surfaces: &[&Surface],
        surface_of: &[u32],
        starts: &[DVec3],
    ) -> Self {
        let mut known = vec![false; surfaces.len()];
        let outlines = |wanted: &dyn Fn(usize) -> bool| -> Vec<&[DVec3]> {
            let labels = geometry.faces.iter().map(|face| face.label as usize);
            let labels = labels.filter(|&label| wanted(surface_of[label] as usize));
            labels.map(|label| &geometry.corners[label]).collect()
        };
        let ior = |surface: usize| match &surfaces[surface].scatter {
            Scatter::Dielectric(glass) => Some(glass.ior),
            _ => None,
        };
        let glassy = (0..surfaces.len()).any(|surface| ior(surface).is_some());
        let crossed = outlines(&|surface| glassy && surfaces[surface].transmits());
        if first_overlap(&crossed, SAME_PLANE) != Overlap::None {
            return Self { known, most: 1.0 };
        }
        let mut pieces = Vec::new();
        for (number, known) in known.iter_mut().enumerate() {
            let Some(ior) = ior(number) else {
                continue;
            };
            // A solid is bounded by polygons alone: the squares around discs bound none.
            let is_round = |face: &Face| face.disc.is_some();
            let mine = |face: &&Face| surface_of[face.label as usize] as usize == number;
            if geometry.faces.iter().filter(mine).any(is_round) {
                continue;
            }
            let Some(solids) = solids(&outlines(&|surface| surface == number)) else {
                continue;
            };
            *known = true;
            let square = ior * ior;
            let balls = geometry.balls.iter();
            let balls = balls.filter(|ball| surface_of[ball.label as usize] as usize == number);
            let balls = balls.map(|ball| Solid {
                low: ball.centre - ball.radius,
                high: ball.centre + ball.radius,
                outwards: true,
            });
            pieces.extend(solids.into_iter().chain(balls).map(|solid| {
                let inwards = if solid.outwards { 1.0 / square } else { square };
                Piece {
                    solid,
                    entered: inwards.max(1.0),
                    left: (1.0 / inwards).max(1.0),
                }
            }));
        }
        let most = most_left(&pieces, starts) * most_entered(&pieces);
        Self { known, most }
    }

    /// True if the refractions at surface number `surface` are in [`Refraction::most`].
    pub(super) fn is_of(&self, surface: u32) -> bool {
        self.known[surface as usize]
    }

    /// True if the refractions at some surface are in [`Refraction::most`].
    pub(super) fn is_of_any(&self) -> bool {
        self.known.contains(&true)
    }

    /// The greatest product of the weights of all refractions of a path, at surfaces with a known bound.
    pub(super) fn most(&self) -> f64 {
        self.most
    }
}

/// The greatest product of the gains of paths that start within solids.
fn most_left(pieces: &[Piece], starts: &[DVec3]) -> f64 {
    let low = starts.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = starts.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let around = pieces
        .iter()
        .filter(|piece| piece.solid.is_near(low, high, MARGIN));
    around.map(|piece| piece.left).product()
}

/// The greatest product of the gains of paths that end within solids. It is over solids whose boxes are
/// connected, since no point is within others as well.
fn most_entered(pieces: &[Piece]) -> f64 {
    let gaining: Vec<&Piece> = pieces.iter().filter(|piece| piece.entered > 1.0).collect();
    if gaining.len() > MOST_SOLIDS {
        return gaining.iter().map(|piece| piece.entered).product();
    }
    let mut seen = vec![false; gaining.len()];
    let mut most: f64 = 1.0;
    for first in 0..gaining.len() {
        let mut product = 1.0;
        let mut pending = vec![first];
        while let Some(number) = pending.pop() {
            if std::mem::replace(&mut seen[number], true) {
                continue;
            }
            let Piece { solid, entered, .. } = gaining[number];
            product *= entered;
            let near = |&other: &usize| {
                !seen[other] && gaining[other].solid.is_near(solid.low, solid.high, MARGIN)
            };
            pending.extend((0..gaining.len()).filter(near));
        }
        most = most.max(product);
    }
    most
}
