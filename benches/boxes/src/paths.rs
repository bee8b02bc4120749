//! Rays of a scene's paths, one path at a time, in plain numbers.

use qrt::tracer::trace;
use qrt::tracer::{Arith, Coordinate, Hit, NO_FACE, NearestSearch, Ray, Sampled, Start};
use qrt::runtime::path_machines::{Real, SingleRay};
use qrt::syntax::expr::Function;
use qrt::scene::sampling::{PathPoints, cell_centre};
use qrt::scene::valid::ValidScene;
use std::cell::RefCell;

/// Rays in the order of the paths.
#[derive(Default)]
pub struct Rays {
    /// Rays from the camera.
    pub primary: Vec<SingleRay>,
    /// Rays from a surface.
    pub bounced: Vec<SingleRay>,
}

/// Returns the rays of all paths of a square film.
pub fn rays(scene: &ValidScene, real: &Real, side: u32) -> Rays {
    let points = PathPoints::new(&scene.scene().sampling).expect("a valid scene's sequence exists");
    let recorder = Recorder {
        real,
        rays: RefCell::default(),
    };
    for number in 0..side * side {
        for id in 0..real.paths() {
            let mut path = Path {
                points: &points,
                pixel: [number % side, number / side],
                id,
            };
            trace(&mut path, real.stage(), &recorder);
        }
    }
    recorder.rays.into_inner()
}

/// Records every ray for which the tracer requests the nearest hit.
struct Recorder<'a> {
    real: &'a Real,
    rays: RefCell<Rays>,
}

impl<'p> NearestSearch<Path<'p>> for Recorder<'_> {
    fn nearest(&self, cx: &mut Path<'p>, ray: &Ray<Path<'p>>, wanted: bool) -> Hit<Path<'p>> {
        if !wanted {
            return Hit::new(cx, f64::MAX, NO_FACE, wanted);
        }
        let single = SingleRay {
            origin: ray.origin,
            direction: ray.direction,
            from: ray.from,
            start: ray.start,
        };
        let mut rays = self.rays.borrow_mut();
        match ray.start {
            Start::Camera => rays.primary.push(single),
            Start::Surface => rays.bounced.push(single),
        }
        match self.real.nearest(&[single])[0] {
            Some(met) => Hit::new(cx, met.distance, met.face, wanted),
            None => Hit::new(cx, f64::MAX, NO_FACE, wanted),
        }
    }

    fn emitter(&self, cx: &mut Path<'p>, ray: &Ray<Path<'p>>, wanted: bool) -> Hit<Path<'p>> {
        self.nearest(cx, ray, wanted)
    }

    fn occluded(&self, _: &mut Path<'p>, _: &Ray<Path<'p>>, _: u32, _: bool) -> bool {
        unreachable!("the scenes of this bench sample no lamps")
    }
}

/// Arithmetic of one path in plain numbers.
struct Path<'a> {
    points: &'a PathPoints,
    pixel: [u32; 2],
    id: u64,
}

impl Arith for Path<'_> {
    type Real = f64;
    type Bool = bool;
    type Index = u32;

    fn real(&mut self, value: f64) -> f64 {
        value
    }
    fn add(&mut self, a: f64, b: f64) -> f64 {
        a + b
    }
    fn sub(&mut self, a: f64, b: f64) -> f64 {
        a - b
    }
    fn mul(&mut self, a: f64, b: f64) -> f64 {
        a * b
    }
    fn div(&mut self, a: f64, b: f64, _most: f64) -> f64 {
        a / b
    }
    fn neg(&mut self, a: f64) -> f64 {
        -a
    }
    fn abs(&mut self, a: f64) -> f64 {
        a.abs()
    }
    fn sqrt(&mut self, a: f64) -> f64 {
        a.sqrt()
    }
    fn min(&mut self, a: f64, b: f64) -> f64 {
        a.min(b)
    }
    fn max(&mut self, a: f64, b: f64) -> f64 {
        a.max(b)
    }
    fn function(&mut self, function: Function, a: f64) -> f64 {
        function.value(a)
    }
    fn pow(&mut self, a: f64, b: f64) -> f64 {
        libm::pow(a, b)
    }
    fn atan2(&mut self, y: f64, x: f64) -> f64 {
        libm::atan2(y, x)
    }
    fn truth(&mut self, value: bool) -> bool {
        value
    }
    fn less(&mut self, a: f64, b: f64) -> bool {
        a < b
    }
    fn less_equal(&mut self, a: f64, b: f64) -> bool {
        a <= b
    }
    fn odd(&mut self, a: f64) -> bool {
        qrt::scene::Checker::is_odd(a)
    }
    fn and(&mut self, a: bool, b: bool) -> bool {
        a && b
    }
    fn or(&mut self, a: bool, b: bool) -> bool {
        a || b
    }
    fn not(&mut self, a: bool) -> bool {
        !a
    }
    fn any(&mut self, a: bool) -> bool {
        a
    }
    fn select(&mut self, c: bool, a: f64, b: f64) -> f64 {
        if c { a } else { b }
    }
    fn index(&mut self, value: u32) -> u32 {
        value
    }
    fn select_index(&mut self, c: bool, a: u32, b: u32) -> u32 {
        if c { a } else { b }
    }
    fn is(&mut self, a: u32, value: u32) -> bool {
        a == value
    }
    fn same(&mut self, a: u32, b: u32) -> bool {
        a == b
    }
    fn below(&mut self, a: u32, value: u32) -> bool {
        a < value
    }
    fn rows<const K: usize>(&mut self, table: &[[f64; K]], row: u32) -> [f64; K] {
        table[row as usize]
    }
    fn entry(&mut self, table: &[u32], row: u32) -> u32 {
        table[row as usize]
    }
    fn coordinate(&mut self, coordinate: Coordinate) -> u32 {
        let [x, y] = self.pixel;
        let shift = self.points.shift(1, x, y, coordinate);
        self.points.index(coordinate, self.id, shift)
    }
    fn centre(&mut self, index: u32, bits: u32) -> f64 {
        cell_centre(index, bits)
    }
    fn sampled(&mut self, function: &Sampled, index: u32) -> f64 {
        function.at(index)
    }
    fn pixel(&mut self) -> [f64; 2] {
        self.pixel.map(f64::from)
    }
}
