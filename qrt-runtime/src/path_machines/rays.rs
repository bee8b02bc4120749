//! Nearest hits of single rays, from the same search that a machine's tracer uses.

use super::Real;
use super::bvh::{Faces, Indexed};
use super::lanes::{BLOCK, Inputs, Lanes, lanes, slots};
use super::real::WIDTH;
use pulp::WithSimd;
use qrt_tracer::{Arith, NO_FACE, NearestSearch, Ray, Start};

/// A ray in stage units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SingleRay {
    /// The point at which the ray starts, in stage units.
    pub origin: [f64; 3],
    /// The direction in which the ray goes, of any length.
    pub direction: [f64; 3],
    /// The plane that the ray leaves and does not meet; [`qrt_tracer::NO_PLANE`] for none.
    pub from: u32,
    /// The kind of place at which the ray starts. Neighbouring rays from the camera are searched
    /// for together; the kind does not change the hit.
    pub start: Start,
}

/// The nearest hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    /// The label of the face.
    pub face: u32,
    /// Distance of the face, in lengths of the ray's direction.
    pub distance: f64,
}

impl Real {
    /// Finds the nearest hit of each of `rays`.
    pub fn nearest(&self, rays: &[SingleRay]) -> Vec<Option<Met>> {
        let mut met = Vec::with_capacity(rays.len());
        let inputs = Inputs {
            indices: Vec::new(),
            column: [0.0; BLOCK],
            row: [0.0; BLOCK],
            watched: None,
        };
        self.dispatch(NearestOf {
            real: self,
            inputs: &inputs,
            rays,
            met: &mut met,
        });
        met
    }
}

struct NearestOf<'a> {
    real: &'a Real,
    inputs: &'a Inputs,
    rays: &'a [SingleRay],
    met: &'a mut Vec<Option<Met>>,
}

impl WithSimd for NearestOf<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let geometry = self.real.stage().geometry();
        let faces = match self.real.boxes() {
            Some(bvh) => Faces::Many(Indexed::new(geometry, bvh)),
            None => Faces::Few(geometry),
        };
        let mut cx = Lanes::<S, WIDTH> {
            simd,
            inputs: self.inputs,
            first: 0,
        };
        let alike = self.rays.chunk_by(|a, b| a.start == b.start);
        for rays in alike.flat_map(|rays| rays.chunks(Lanes::<S, WIDTH>::COUNT)) {
            let mut origin = [cx.real(0.0); 3];
            let mut direction = [cx.real(0.0); 3];
            let mut from = cx.index(0);
            let mut wanted = cx.index(0);
            for (lane, ray) in rays.iter().enumerate() {
                for axis in 0..3 {
                    slots::<_, f64>(&mut origin[axis])[lane] = ray.origin[axis];
                    slots::<_, f64>(&mut direction[axis])[lane] = ray.direction[axis];
                }
                slots::<_, u64>(&mut from)[lane] = u64::from(ray.from);
                slots::<_, u64>(&mut wanted)[lane] = 1;
            }
            let ray = Ray {
                origin,
                direction,
                from,
                t_max: f64::INFINITY,
                start: rays[0].start,
            };
            let wanted = cx.is(wanted, 1);
            let hit = faces.nearest(&mut cx, &ray, wanted);
            let none = cx.index(NO_FACE);
            let face = cx.select_index(hit.found, hit.face, none);
            let found = lanes::<_, u64>(&face)
                .iter()
                .zip(lanes::<_, f64>(&hit.distance));
            self.met
                .extend(found.take(rays.len()).map(|(&face, &distance)| {
                    (face != u64::from(NO_FACE)).then_some(Met {
                        face: face as u32,
                        distance,
                    })
                }));
        }
    }
}
