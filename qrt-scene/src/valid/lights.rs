//! Checks the sampling of lamps: lamps to sample, surfaces to sample them from, and enough bits.

use super::{Polygon, Scatter, Surface, ValidScene};
use crate::lights::{LitFace, Reached, is_parallelogram, strongest_of};
use crate::scene::{Lights, Sequence};
use crate::syntax::{Path, Problem, Problems, Sampling as Fault};
use glam::DVec3;

/// Maximum number of pairs of a surface's polygon and a lamp's for which a bound is computed.
pub const MOST_PAIRS: usize = 1 << 18;

/// Checks the sampling of lamps. Removes it if there is no lamp, of which the scene has a warning,
/// or with a warning if no surface could use it. Cuts lamps into shapes that can be sampled.
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
    let any = |holds: fn(&Surface) -> bool| {
        let mut faces = valid.surface_of_faces();
        faces.any(|surface| holds(&valid.materials[surface as usize]))
    };
    let (emits, samples) = (any(Surface::emits), any(Surface::samples_lights));
    if !emits || !samples {
        if emits {
            let unused = Problem::new(light(first), Fault::NoReceiver);
            valid.warnings.push(unused);
        }
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
    let faces = faces(valid);
    let lamps = || faces.iter().filter(|(_, surface)| surface.emits());
    let count = lamps().count();
    for depth in asked {
        let [bits, _] = valid.scene.sampling.light(depth).unwrap_or_default();
        if count > 1 << bits {
            let what = Fault::FewLightBits {
                lamps: count,
                bits,
                needed: count.next_power_of_two().ilog2(),
            };
            problems.push(Problem::new(light(depth).item(0), what));
        }
    }
    if valid.scene.sampling.lights == Lights::NextEvent {
        let matte = faces
            .iter()
            .filter(|(_, surface)| matches!(surface.scatter, Scatter::Lambertian(_)));
        let matte: Vec<&(LitFace<'_>, &Surface)> = matte.collect();
        let touched = matte.iter().find(|(face, _)| {
            let reached = |lamp: LitFace<'_>| {
                if matte.len() * count > MOST_PAIRS {
                    return Reached::UNBOUNDED;
                }
                strongest_of([*face].into_iter(), lamp)
            };
            lamps().any(|(lamp, _)| reached(*lamp).form.is_infinite())
        });
        if let Some((_, surface)) = touched {
            let surface = surface.name.clone();
            let place = Path::root().key("sampling").key("lights");
            problems.push(Problem::new(place, Fault::LightUnbounded { surface }));
        }
    }
}

/// The faces of a scene with their surfaces.
fn faces(valid: &ValidScene) -> Vec<(LitFace<'_>, &Surface)> {
    let mut smooth = valid.smooth.iter().map(|face| face.polygon).peekable();
    let polygons = valid.polygons.iter().enumerate();
    let polygons = polygons.map(move |(number, polygon)| LitFace::Polygon {
        outline: polygon.outline(),
        is_smooth: smooth.next_if_eq(&number).is_some(),
    });
    let balls = valid.balls.iter().map(|ball| LitFace::Sphere {
        centre: ball.centre,
        radius: ball.radius,
    });
    let surfaces = valid.surface_of_faces();
    let surfaces = surfaces.map(|surface| &valid.materials[surface as usize]);
    polygons.chain(balls).zip(surfaces).collect()
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
    for face in &mut valid.smooth {
        face.polygon = moved[face.polygon];
    }
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
