//! Checks the sampling of lamps: lamps to sample, surfaces to sample them from, and enough bits.

use super::{Polygon, Scatter, ValidScene};
use crate::lights::{Reached, is_parallelogram, strongest};
use crate::scene::{Lights, Sequence};
use crate::syntax::{Path, Problem, Problems, Sampling as Fault};
use glam::DVec3;

/// Maximum number of pairs of a surface's polygon and a lamp's for which a bound is computed.
pub const MOST_PAIRS: usize = 1 << 18;

/// Checks the sampling of lamps. If there is no lamp, or no surface that could use the sampling,
/// removes the sampling with a warning. Cuts lamps into shapes that can be sampled.
pub(super) fn check(valid: &mut ValidScene, problems: &mut Problems) {
    let sampling = &valid.scene.sampling;
    let depths = Path::root().key("sampling").key("depths");
    let asked = |depth: &usize| sampling.light(*depth).is_some();
    let asked: Vec<usize> = (0..sampling.depths.len()).filter(asked).collect();
    let Some(&first) = asked.first() else {
        return;
    };
    if problems.count() > 0 {
        // Another problem may be the cause that nothing emits.
        return;
    }
    let light = |depth: usize| depths.item(depth).key("light");
    let surface = |polygon: &Polygon| &valid.materials[polygon.surface as usize];
    let lamps = valid.polygons.iter().filter(|p| surface(p).emits());
    let mut receivers = valid.polygons.iter();
    let unused = if lamps.count() == 0 {
        Some(Fault::NoLamp)
    } else if receivers.any(|p| surface(p).samples_lights()) {
        None
    } else {
        Some(Fault::NoReceiver)
    };
    if let Some(unused) = unused {
        valid.warnings.push(Problem::new(light(first), unused));
        let sampling = &mut valid.scene.sampling;
        for depth in &mut sampling.depths {
            depth.light = None;
        }
        if sampling.sequence == Sequence::ProductLattice {
            sampling.path_bits = sampling.lattice_bits();
        }
        return;
    }
    cut_lamps(valid);
    let materials = &valid.materials;
    let surface = |polygon: &&Polygon| &materials[polygon.surface as usize];
    let lamps: Vec<&Polygon> = valid
        .polygons
        .iter()
        .filter(|p| surface(p).emits())
        .collect();
    for depth in asked {
        let [bits, _] = valid.scene.sampling.light(depth).unwrap_or_default();
        if lamps.len() > 1 << bits {
            let what = Fault::FewLightBits {
                lamps: lamps.len(),
                bits,
                needed: lamps.len().next_power_of_two().ilog2(),
            };
            problems.push(Problem::new(light(depth).item(0), what));
        }
    }
    if valid.scene.sampling.lights == Lights::NextEvent {
        let matte = |surface: &&Polygon| {
            let scatter = &materials[surface.surface as usize].scatter;
            matches!(scatter, Scatter::Lambertian(_))
        };
        let matte: Vec<&Polygon> = valid.polygons.iter().filter(matte).collect();
        let touched = matte.iter().find(|face| {
            let reached = |lamp: &&Polygon| {
                if matte.len() * lamps.len() > MOST_PAIRS {
                    return Reached::UNBOUNDED;
                }
                strongest([face.outline()].into_iter(), lamp.outline())
            };
            lamps.iter().any(|lamp| reached(lamp).form.is_infinite())
        });
        if let Some(face) = touched {
            let surface = surface(face).name.clone();
            let place = Path::root().key("sampling").key("lights");
            problems.push(Problem::new(place, Fault::LightUnbounded { surface }));
        }
    }
}

/// Cuts each quadrilateral that emits and is no parallelogram into two triangles, since points on a lamp
/// are an affine map of the unit square.
fn cut_lamps(valid: &mut ValidScene) {
    let mut cut = Vec::with_capacity(valid.polygons.len());
    let mut moved = Vec::with_capacity(valid.polygons.len() + 1);
    for polygon in &valid.polygons {
        moved.push(cut.len());
        let emits = valid.materials[polygon.surface as usize].emits();
        if !emits || polygon.corners == 3 || is_parallelogram(polygon.vertices) {
            cut.push(*polygon);
            continue;
        }
        let [a, b, c, d] = polygon.vertices;
        let half = |vertices: [DVec3; 4]| Polygon {
            vertices,
            corners: 3,
            surface: polygon.surface,
        };
        cut.extend([half([a, b, c, c]), half([a, c, d, d])]);
    }
    moved.push(cut.len());
    for first in &mut valid.firsts {
        *first = moved[*first];
    }
    valid.polygons = cut;
}

impl Polygon {
    /// The corners around it: 3 or 4.
    pub fn outline(&self) -> &[DVec3] {
        &self.vertices[..self.corners as usize]
    }
}
