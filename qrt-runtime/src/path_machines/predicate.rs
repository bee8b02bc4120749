//! Predicates on the real machine: the tracer's numbers in 64-bit floating point, each rounded to
//! the nearest of its register's format, and the predicate's program on these.

use super::lanes::{BLOCK, Inputs, Watched};
use qrt_core::oracle::paths::{PathFormats, PathNumber, RayNumber};
use qrt_core::oracle::{Marks, Predicate};
use qrt_core::tracer::Stage;
use qrt_machines::FixedMachine;
use qrt_machines::PixelLanes;
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

/// A predicate on paths: its numbers, its program, and its marks.
#[derive(Clone, Debug)]
pub(super) struct Asked {
    numbers: PathNumbers,
    program: FixedMachine,
    marks: Marks,
}

/// Reads the numbers of a path from the tracer's records.
#[derive(Clone, Debug)]
pub(super) struct PathNumbers {
    formats: PathFormats,
    numbers: Arc<[PathNumber]>,
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
    fn value(
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

impl Asked {
    pub(super) fn new(predicate: &Predicate, marks: Marks) -> Self {
        Self {
            numbers: PathNumbers::new(predicate.scene(), predicate.formats(), predicate.numbers()),
            program: FixedMachine::new(predicate.program(), &[predicate.good()]),
            marks,
        }
    }

    /// Replaces the colours of the first `count` paths of a block by the values that are counted.
    /// For [`Marks::Paths`] the value is 1 where the predicate holds and 0 elsewhere; for
    /// [`Marks::Light`] it is the colour where the predicate holds and 0 elsewhere. It is NaN where
    /// a number of the path does not fit its register, which is a defect.
    fn mark(
        &self,
        stage: &Stage<3>,
        lanes: &mut qrt_machines::FixedLanes,
        (inputs, count): (&Inputs, usize),
        colours: &mut [[f64; BLOCK]; 3],
    ) {
        let Some(watched) = &inputs.watched else {
            return;
        };
        let rays = watched.borrow();
        let mut unheld = [false; BLOCK];
        let mut columns = Vec::new();
        for &number in &*self.numbers.numbers {
            let format = self.numbers.formats.format(number);
            let column = (0..count).map(|lane| {
                let value = self.numbers.value(stage, (&rays, colours), number, lane);
                let bits = format.bits(value);
                unheld[lane] |= bits.is_none();
                bits.unwrap_or(0)
            });
            columns.push(column.collect::<Vec<u64>>());
        }
        let columns: Vec<&[u64]> = columns.iter().map(Vec::as_slice).collect();
        let span = PixelLanes {
            lanes: count,
            parameters: &[],
        };
        let mut good = [0_i64; BLOCK];
        let outputs = &mut [&mut good[..count]];
        self.program.run(lanes, &columns, &[span], outputs);
        for (lane, good) in good[..count].iter().enumerate() {
            for colour in &mut *colours {
                colour[lane] = match (self.marks, good) {
                    _ if unheld[lane] => f64::NAN,
                    (_, 0) => 0.0,
                    (Marks::Paths, _) => 1.0,
                    (Marks::Light, _) => colour[lane],
                };
            }
        }
        drop(rays);
        watched.borrow_mut().fill(Watched::NONE);
    }
}

impl Marker for Asked {
    fn watched(&self) -> RefCell<Vec<Watched>> {
        self.numbers.watched()
    }

    fn marks(&self) -> Mark<'_> {
        let mut lanes = self.program.lanes();
        Box::new(move |stage, block, colours| self.mark(stage, &mut lanes, block, colours))
    }
}

const _: () = assert!(BLOCK <= FixedMachine::LANES);
