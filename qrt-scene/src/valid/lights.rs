//! Checks the sampling of lamps: lamps to sample, surfaces to sample them from, and enough bits.

use super::{Polygon, Scatter, Surface, ValidScene};
use crate::lights::{LitFace, Reached, is_parallelogram, strongest_of};
use crate::sampling::MAX_DIMENSIONS;
use crate::scene::{LightPoint, Lights, Sampling, Sequence};
use glam::DVec3;
use qrt_syntax::{Path, Problem, Problems, Sampling as Fault};
use std::borrow::Cow;
use std::f64::consts::TAU;

/// Maximum number of pairs of a surface's polygon and a lamp's for which a bound is computed.
pub const MOST_PAIRS: usize = 1 << 18;

/// Number of bits of each coordinate of a point on a lamp, if the scene does not say, and the greatest.
const BITS: u32 = 8;
const MOST_BITS: u32 = 16;

/// Decides about points on lamps that are `auto`, and checks the others. Removes those of which no
/// surface would make use: with a warning if they are written, and if there is a lamp, for a scene without
/// one has a warning of its own. Cuts lamps into shapes that can be sampled.
pub(super) fn check(valid: &mut ValidScene, problems: &mut Problems) {
    let sampling = &valid.scene.sampling;
    if sampling.lights == Lights::None || problems.count() > 0 {
        // Another problem may be the cause that nothing emits.
        return;
    }
    let is_asked = sampling.lights != Lights::Auto;
    let depths = Path::root().key("sampling").key("depths");
    let light = |depth: usize| depths.item(depth).key("light");
    let written = (0..sampling.depths.len()).find(|&depth| sampling.light(depth).is_some());
    let any = |holds: fn(&Surface) -> bool| {
        let mut faces = valid.surface_of_faces();
        faces.any(|surface| holds(&valid.materials[surface as usize]))
    };
    let emits = any(Surface::emits) || valid.sun().is_some();
    let samples = any(Surface::samples_lights);
    if !emits || !samples {
        let asked = is_asked.then(|| Path::root().key("sampling").key("lights"));
        if let Some(place) = written.map(light).or(asked).filter(|_| emits) {
            let unused = Problem::new(place, Fault::NoReceiver);
            valid.warnings.push(unused);
        }
        let sampling = &mut valid.scene.sampling;
        for depth in &mut sampling.depths {
            // As if it was not written.
            if let LightPoint::Bits(_) = depth.light {
                depth.light = LightPoint::Auto;
            }
        }
        if sampling.sequence == Sequence::ProductLattice {
            sampling.path_bits = sampling.lattice_bits();
        }
        return;
    }
    let count = count_lamps(valid);
    let needed = count.next_power_of_two().ilog2();
    let sampling = &mut valid.scene.sampling;
    decide(sampling, needed);
    let mut asked = Vec::new();
    for depth in 0..sampling.depths.len() {
        let Some([bits, _]) = sampling.light(depth) else {
            continue;
        };
        asked.push(depth);
        if bits < needed {
            let lamps = count;
            let what = Fault::FewLightBits {
                lamps,
                bits,
                needed,
            };
            problems.push(Problem::new(light(depth).item(0), what));
        }
    }
    if asked.is_empty() {
        if is_asked {
            let cause = no_points(sampling, needed);
            let place = Path::root().key("sampling").key("lights");
            let unused = Problem::new(place, Fault::NoPoints { cause });
            valid.warnings.push(unused);
        }
        return;
    }
    cut_lamps(valid);
    let faces = faces(valid);
    let lamps = || faces.iter().filter(|(_, surface)| surface.emits());
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
                strongest_of([*face].into_iter(), lamp, 0.0)
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

/// Replaces `auto` for each ray by the bits of its point on a lamp, of which at least `needed` choose the
/// lamp, or by none.
fn decide(sampling: &mut Sampling, needed: u32) {
    let squares = sampling.squares().count();
    let mut left = match sampling.sequence {
        Sequence::DigitalNet if needed <= MOST_BITS => MAX_DIMENSIONS / 2 - squares,
        _ => 0,
    };
    for (depth, sampled) in sampling.depths.iter_mut().enumerate() {
        if sampled.light == LightPoint::Auto {
            let is_sampled = depth > 0 && left > 0;
            left -= usize::from(is_sampled);
            sampled.light = if is_sampled {
                LightPoint::Bits([needed.max(BITS), BITS])
            } else {
                LightPoint::None
            };
        }
    }
}

/// Returns the reason why no ray has a point on a lamp, of which `needed` bits would choose the lamp.
fn no_points(sampling: &Sampling, needed: u32) -> &'static str {
    if sampling.depths.len() < 2 {
        "the primary ray alone leaves no surface"
    } else if sampling.sequence == Sequence::ProductLattice {
        "under `product-lattice` no ray samples a lamp unless its `light` is written"
    } else if needed > MOST_BITS {
        "more than 65,536 lamps cannot be sampled"
    } else {
        "each ray says `light: none`"
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

/// Number of shapes of lamps, after those that are cut, and with the sun.
fn count_lamps(valid: &ValidScene) -> usize {
    let emits = |surface: u32| valid.materials[surface as usize].emits();
    let polygons = valid.polygons.iter().filter(|face| emits(face.surface));
    let polygons = polygons.map(|face| 1 + usize::from(is_cut(valid, face)));
    let balls = valid.balls.iter().filter(|ball| emits(ball.surface));
    polygons.sum::<usize>() + balls.count() + usize::from(valid.sun().is_some())
}

/// True if `polygon` emits and cannot be sampled in one piece.
fn is_cut(valid: &ValidScene, polygon: &Polygon) -> bool {
    let emits = valid.materials[polygon.surface as usize].emits();
    emits && polygon.corners == 4 && !polygon.disc && !is_parallelogram(polygon.vertices)
}

/// Cuts each quadrilateral that emits and is no parallelogram into two triangles, since points on a lamp
/// are an affine map of the unit square.
fn cut_lamps(valid: &mut ValidScene) {
    let mut cut = Vec::with_capacity(valid.polygons.len());
    let mut moved = Vec::with_capacity(valid.polygons.len() + 1);
    for polygon in &valid.polygons {
        moved.push(cut.len());
        if !is_cut(valid, polygon) {
            cut.push(*polygon);
            continue;
        }
        let [a, b, c, d] = polygon.vertices;
        let half = |vertices: [DVec3; 4]| Polygon {
            vertices,
            corners: 3,
            disc: false,
            surface: polygon.surface,
        };
        cut.extend([half([a, b, c, c]), half([a, c, d, d])]);
    }
    moved.push(cut.len());
    for face in &mut valid.smooth {
        face.polygon = moved[face.polygon];
    }
    for face in &mut valid.coloured {
        face.polygon = moved[face.polygon];
    }
    for first in &mut valid.firsts {
        *first = moved[*first];
    }
    valid.polygons = cut;
}

impl Polygon {
    /// The corners around it: 3 or 4. Those of a disc are the corners of the square around it.
    pub fn outline(&self) -> &[DVec3] {
        &self.vertices[..self.corners as usize]
    }

    /// Corners of a convex region within it: its own, or corners on a disc's outline.
    pub(crate) fn inner_outline(&self) -> Cow<'_, [DVec3]> {
        /// Number of corners on a disc's outline: the region lacks 0.2 % of the disc's area.
        const ON_CIRCLE: u32 = 64;
        if !self.disc {
            return Cow::Borrowed(self.outline());
        }
        let [a, b, c, d] = self.vertices;
        let (centre, first, second) = ((a + c) * 0.5, (b - a) * 0.5, (d - a) * 0.5);
        let corner = |k: u32| {
            let (sin, cos) = libm::sincos(TAU * f64::from(k) / f64::from(ON_CIRCLE));
            centre + first * cos + second * sin
        };
        Cow::Owned((0..ON_CIRCLE).map(corner).collect())
    }
}
