//! The numbers of a path on the real machine, and marks of paths by these numbers.

use super::lanes::{BLOCK, Inputs, Watched};
use qrt_core::oracle::paths::{PathFormats, PathNumber, RayNumber};
use qrt_tracer::Stage;
use std::cell::RefCell;
use std::sync::Arc;

/// Marks the good paths of blocks. It is a trait so that a program that traces only colours does
/// not link its implementation.
pub(super) trait Marker: std::fmt::Debug + Send + Sync {
    /// Creates the records that the tracer fills in.
    fn watched(&self) -> RefCell<Vec<Watched>>;

    /// Returns a function that marks one block after another.
    fn marks(&self) -> Mark<'_>;
}

/// Replaces the colours of a block's first paths by the values that are counted. The `usize` is the
/// number of these paths.
pub(super) type Mark<'a> = Box<dyn FnMut(&Stage<3>, (&Inputs, usize), &mut [[f64; BLOCK]; 3]) + 'a>;

/// Reads the numbers of a path from the tracer's records.
#[derive(Clone, Debug)]
pub(super) struct PathNumbers {
    pub(super) formats: PathFormats,
    pub(super) numbers: Arc<[PathNumber]>,
    /// Material of each face, from 1 on.
    materials: Arc<[u32]>,
}

impl PathNumbers {
    pub(super) fn new(
        scene: &qrt_scene::valid::ValidScene,
        formats: &PathFormats,
        numbers: &[PathNumber],
    ) -> Self {
        Self {
            formats: formats.clone(),
            numbers: numbers.into(),
            materials: scene
                .surface_of_faces()
                .map(|surface| surface + 1)
                .collect(),
        }
    }

    /// Creates the records that the tracer fills in.
    pub(super) fn watched(&self) -> RefCell<Vec<Watched>> {
        RefCell::new(vec![Watched::NONE; self.formats.rays])
    }

    /// Returns a number of path `lane` of a block, in scene units.
    pub(super) fn value(
        &self,
        stage: &Stage<3>,
        (rays, colours): (&[Watched], &[[f64; BLOCK]; 3]),
        number: PathNumber,
        lane: usize,
    ) -> f64 {
        let (depth, number) = match number {
            PathNumber::Colour(channel) => return colours[channel][lane],
            PathNumber::Ray(depth, number) => (depth, number),
        };
        let Some(ray) = rays.get(depth) else {
            return 0.0;
        };
        let of_hit = !matches!(number, RayNumber::Origin(_) | RayNumber::Direction(_));
        let there = if of_hit {
            ray.found[lane]
        } else {
            ray.goes[lane]
        };
        if there == 0.0 {
            return 0.0;
        }
        let face = ray.face[lane] as usize;
        match number {
            RayNumber::Origin(axis) => {
                let point = [0, 1, 2].map(|k: usize| ray.origin[k][lane]);
                self.formats.point(point)[axis]
            }
            RayNumber::Direction(axis) => ray.direction[axis][lane],
            RayNumber::Found => 1.0,
            RayNumber::Distance => self.formats.distance(ray.distance[lane]),
            RayNumber::Face => (face + 1) as f64,
            RayNumber::Material => f64::from(self.materials[face]),
            RayNumber::Normal(axis) => stage.normal(face)[axis],
            RayNumber::Front => {
                let told = ray.front[lane];
                let normal = stage.normal(face);
                let terms = (0..3).map(|k| ray.direction[k][lane] * normal[k]);
                let cos_theta: f64 = terms.sum();
                if told < 0.0 {
                    f64::from(cos_theta < 0.0)
                } else {
                    told
                }
            }
        }
    }

    /// Returns all numbers of path `lane` of a block, in scene units.
    pub(super) fn values(
        &self,
        stage: &Stage<3>,
        block: (&[Watched], &[[f64; BLOCK]; 3]),
        lane: usize,
    ) -> Vec<f64> {
        let numbers = self.numbers.iter();
        numbers
            .map(|&number| self.value(stage, block, number, lane))
            .collect()
    }
}
