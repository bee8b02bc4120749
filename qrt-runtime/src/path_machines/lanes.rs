//! The tracer's arithmetic over SIMD lanes of `f64`.
//!
//! Each lane holds one path. Every operation is a single correctly rounded IEEE 754 operation (no
//! fused multiply-add) or a function of the `libm` crate, so that AVX-512, AVX2, NEON and plain
//! code give the same bits.

use crate::path_machines::masks::bits;
use pulp::bytemuck;
use qrt_scene::Checker;
use qrt_scene::sampling::cell_centre;
use qrt_syntax::expr::Function;
use qrt_tracer::{Arith, Coordinate, Sampled, Segment, Work};
use std::cell::RefCell;

/// Number of paths of a block, whose sample indices are filled in together.
pub(crate) const BLOCK: usize = 256;

/// The input of a block of paths: indices by the slot of their coordinate, and the pixel of each
/// path.
pub(crate) struct Inputs {
    pub(crate) indices: Vec<[u32; BLOCK]>,
    pub(crate) column: [f64; BLOCK],
    pub(crate) row: [f64; BLOCK],
    /// Records of rays and their hits, if these are wanted.
    pub(crate) watched: Option<RefCell<Vec<Watched>>>,
}

/// A ray of each path of a block, and its hit, in stage units: see [`Segment`].
#[derive(Clone, Debug)]
pub(crate) struct Watched {
    pub(crate) origin: [[f64; BLOCK]; 3],
    pub(crate) direction: [[f64; BLOCK]; 3],
    pub(crate) distance: [f64; BLOCK],
    pub(crate) face: [u64; BLOCK],
    /// 1 for true and 0 for false, here and in `found`.
    pub(crate) goes: [f64; BLOCK],
    pub(crate) found: [f64; BLOCK],
    /// As `goes`; -1 if the search does not determine the side.
    pub(crate) front: [f64; BLOCK],
}

impl Watched {
    /// An empty record: no path has this ray.
    pub(crate) const NONE: Self = Self {
        origin: [[0.0; BLOCK]; 3],
        direction: [[0.0; BLOCK]; 3],
        distance: [0.0; BLOCK],
        face: [0; BLOCK],
        goes: [0.0; BLOCK],
        found: [0.0; BLOCK],
        front: [-1.0; BLOCK],
    };
}

/// SIMD lanes of one instruction set, with `W` registers per value. The first lane holds path
/// `first` of a block.
#[derive(Clone, Copy)]
pub(crate) struct Lanes<'a, S, const W: usize> {
    pub(crate) simd: S,
    pub(crate) inputs: &'a Inputs,
    pub(crate) first: usize,
}

/// Returns the lanes of `vector` as a slice.
#[inline(always)]
pub(crate) fn lanes<T: bytemuck::Pod, U: bytemuck::Pod>(vector: &[T]) -> &[U] {
    bytemuck::cast_slice(vector)
}

/// Returns the lanes of `vector` as a mutable slice.
#[inline(always)]
pub(crate) fn slots<T: bytemuck::Pod, U: bytemuck::Pod>(vector: &mut [T]) -> &mut [U] {
    bytemuck::cast_slice_mut(vector)
}

/// Applies `f` to every lane. Not inlined, because the calls of `f` cost more.
#[inline(never)]
fn apply(lanes: &mut [f64], f: impl Fn(f64) -> f64) {
    for lane in lanes {
        *lane = f(*lane);
    }
}

/// Applies `f` to every lane of two values.
#[inline(never)]
fn apply_to_pairs(lanes: &mut [f64], others: &[f64], f: fn(f64, f64) -> f64) {
    for (lane, &other) in lanes.iter_mut().zip(others) {
        *lane = f(*lane, other);
    }
}

// The functions below that go through memory lane by lane gain nothing from the instruction set.
// Most of them are not inlined: their loops, unrolled all over the tracer, cost minutes of compile
// time.

/// Reads row `rows[lane]` of `table` for each lane, into `columns` column by column.
#[inline(always)]
fn gather_rows<const K: usize>(table: &[[f64; K]], rows: &[u64], columns: &mut [f64]) {
    let count = rows.len();
    for (lane, &row) in rows.iter().enumerate() {
        let row = &table[row as usize];
        for (column, &value) in row.iter().enumerate() {
            columns[column * count + lane] = value;
        }
    }
}

/// Replaces each row number by the entry of `table` in that row.
#[inline(never)]
fn gather_entries(table: &[u32], rows: &mut [u64]) {
    for row in rows {
        *row = u64::from(table[*row as usize]);
    }
}

#[inline(never)]
fn widen(indices: &[u32], wide: &mut [u64]) {
    for (wide, &index) in wide.iter_mut().zip(indices) {
        *wide = u64::from(index);
    }
}

#[inline(never)]
fn cell_centres(indices: &[u64], bits: u32, centres: &mut [f64]) {
    for (centre, &index) in centres.iter_mut().zip(indices) {
        *centre = cell_centre(index as u32, bits);
    }
}

#[inline(always)]
fn sample(function: &Sampled, indices: &[u64], values: &mut [f64]) {
    match function.table() {
        Some(table) => {
            for (value, &index) in values.iter_mut().zip(indices) {
                *value = table[index as usize];
            }
        }
        None => evaluate(function, indices, values),
    }
}

#[inline(never)]
fn evaluate(function: &Sampled, indices: &[u64], values: &mut [f64]) {
    for (value, &index) in values.iter_mut().zip(indices) {
        *value = function.at(index as u32);
    }
}

/// Work that runs in a function of its own. The compiler compiles it separately from the tracer,
/// for the same instruction set.
struct Apart<'a, A: Arith, T: Work<A>> {
    cx: &'a mut A,
    work: T,
    output: &'a mut Option<T::Output>,
}

#[inline(never)]
fn in_a_function<S: pulp::Simd, T: pulp::WithSimd<Output = ()>>(simd: S, task: T) {
    simd.vectorize(task);
}

impl<A: Arith, T: Work<A>> pulp::WithSimd for Apart<'_, A, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<U: pulp::Simd>(self, _: U) {
        *self.output = Some(self.work.run(self.cx));
    }
}

/// Applies an operation register by register. It is a macro, not a function that takes a closure: a
/// closure uses the instruction set only if it is inlined, which is left to chance.
macro_rules! each {
    ($cx:ident, $operation:ident, $first:ident $(, $rest:ident)*) => {{
        // No loop: one loop for each of thousands of operations would cost minutes of compile time.
        const { assert!(W == 1 || W == 2) };
        let mut result = [$cx.simd.$operation($first[0] $(, $rest[0])*); W];
        if W == 2 {
            result[W - 1] = $cx.simd.$operation($first[W - 1] $(, $rest[W - 1])*);
        }
        result
    }};
}

impl<'a, S: pulp::Simd> Lanes<'a, S, 1> {
    /// Creates lanes with one register per value, at the start of a block.
    #[inline(always)]
    pub(crate) fn single(simd: S, inputs: &'a Inputs) -> Self {
        let first = 0;
        Self {
            simd,
            inputs,
            first,
        }
    }
}

impl<S: pulp::Simd, const W: usize> Lanes<'_, S, W> {
    /// Records a ray of each path in the lanes.
    #[cold]
    #[inline(never)]
    fn watch(&self, watched: &RefCell<Vec<Watched>>, depth: usize, segment: &Segment<Self>) {
        let mut watched = watched.borrow_mut();
        let Some(ray) = watched.get_mut(depth) else {
            return;
        };
        let range = self.first..self.first + Self::COUNT;
        let mut cx = *self;
        let (one, zero, minus) = (cx.real(1.0), cx.real(0.0), cx.real(-1.0));
        let mut truth = |holds| cx.select(holds, one, zero);
        let goes = truth(segment.goes);
        let found = truth(segment.found);
        let front = segment.front.map_or(minus, truth);
        let note = |out: &mut [f64; BLOCK], value: &[S::f64s; W]| {
            out[range.clone()].copy_from_slice(lanes(value));
        };
        for axis in 0..3 {
            note(&mut ray.origin[axis], &segment.origin[axis]);
            note(&mut ray.direction[axis], &segment.direction[axis]);
        }
        note(&mut ray.distance, &segment.distance);
        note(&mut ray.goes, &goes);
        note(&mut ray.found, &found);
        note(&mut ray.front, &front);
        ray.face[range].copy_from_slice(lanes(&segment.face));
    }

    /// Number of paths in a value.
    pub(crate) const COUNT: usize = W * S::F64_LANES;
}

impl<S: pulp::Simd, const W: usize> Arith for Lanes<'_, S, W> {
    type Real = [S::f64s; W];
    type Bool = [S::m64s; W];
    type Index = [S::u64s; W];

    #[inline(always)]
    fn real(&mut self, value: f64) -> Self::Real {
        [self.simd.splat_f64s(value); W]
    }
    #[inline(always)]
    fn add(&mut self, a: Self::Real, b: Self::Real) -> Self::Real {
        each!(self, add_f64s, a, b)
    }
    #[inline(always)]
    fn sub(&mut self, a: Self::Real, b: Self::Real) -> Self::Real {
        each!(self, sub_f64s, a, b)
    }
    #[inline(always)]
    fn mul(&mut self, a: Self::Real, b: Self::Real) -> Self::Real {
        each!(self, mul_f64s, a, b)
    }
    #[inline(always)]
    fn div(&mut self, a: Self::Real, b: Self::Real, _most: f64) -> Self::Real {
        each!(self, div_f64s, a, b)
    }
    #[inline(always)]
    fn neg(&mut self, a: Self::Real) -> Self::Real {
        each!(self, neg_f64s, a)
    }
    #[inline(always)]
    fn abs(&mut self, a: Self::Real) -> Self::Real {
        each!(self, abs_f64s, a)
    }
    #[inline(always)]
    fn sqrt(&mut self, a: Self::Real) -> Self::Real {
        each!(self, sqrt_f64s, a)
    }
    // Not the minimum and maximum of the instruction sets: these differ for NaN and for the signs
    // of zeros.
    #[inline(always)]
    fn min(&mut self, a: Self::Real, b: Self::Real) -> Self::Real {
        let less = self.less(a, b);
        self.select(less, a, b)
    }
    #[inline(always)]
    fn max(&mut self, a: Self::Real, b: Self::Real) -> Self::Real {
        let greater = self.less(b, a);
        self.select(greater, a, b)
    }
    #[inline(always)]
    fn cosine(&mut self, a: Self::Real) -> Self::Real {
        let (low, high) = (self.real(-1.0), self.real(1.0));
        let a = self.max(a, low);
        self.min(a, high)
    }
    #[inline(always)]
    fn function(&mut self, function: Function, a: Self::Real) -> Self::Real {
        let mut result = a;
        apply(slots(&mut result), |x| function.value(x));
        result
    }
    #[inline(always)]
    fn pow(&mut self, a: Self::Real, b: Self::Real) -> Self::Real {
        let mut result = a;
        apply_to_pairs(slots(&mut result), lanes(&b), libm::pow);
        result
    }
    #[inline(always)]
    fn atan2(&mut self, y: Self::Real, x: Self::Real) -> Self::Real {
        let mut result = y;
        apply_to_pairs(slots(&mut result), lanes(&x), libm::atan2);
        result
    }

    #[inline(always)]
    fn truth(&mut self, value: bool) -> Self::Bool {
        let bound = self.simd.splat_u64s(u64::from(value));
        [self.simd.less_than_u64s(self.simd.splat_u64s(0), bound); W]
    }
    #[inline(always)]
    fn less(&mut self, a: Self::Real, b: Self::Real) -> Self::Bool {
        each!(self, less_than_f64s, a, b)
    }
    #[inline(always)]
    fn less_equal(&mut self, a: Self::Real, b: Self::Real) -> Self::Bool {
        each!(self, less_than_or_equal_f64s, a, b)
    }
    #[inline(always)]
    fn odd(&mut self, a: Self::Real) -> Self::Bool {
        let mut odd = a;
        apply(slots(&mut odd), |x| f64::from(Checker::is_odd(x)));
        let half = self.real(0.5);
        self.less(half, odd)
    }
    #[inline(always)]
    fn and(&mut self, a: Self::Bool, b: Self::Bool) -> Self::Bool {
        each!(self, and_m64s, a, b)
    }
    #[inline(always)]
    fn or(&mut self, a: Self::Bool, b: Self::Bool) -> Self::Bool {
        each!(self, or_m64s, a, b)
    }
    #[inline(always)]
    fn not(&mut self, a: Self::Bool) -> Self::Bool {
        each!(self, not_m64s, a)
    }
    #[inline(always)]
    fn any(&mut self, a: Self::Bool) -> bool {
        bits(self.simd, self.simd.or_m64s(a[0], a[W - 1])) != 0
    }
    #[inline(always)]
    fn select(&mut self, c: Self::Bool, a: Self::Real, b: Self::Real) -> Self::Real {
        each!(self, select_f64s, c, a, b)
    }

    #[inline(always)]
    fn index(&mut self, value: u32) -> Self::Index {
        [self.simd.splat_u64s(u64::from(value)); W]
    }
    #[inline(always)]
    fn select_index(&mut self, c: Self::Bool, a: Self::Index, b: Self::Index) -> Self::Index {
        each!(self, select_u64s, c, a, b)
    }
    #[inline(always)]
    fn is(&mut self, a: Self::Index, value: u32) -> Self::Bool {
        let value = self.index(value);
        each!(self, equal_u64s, a, value)
    }
    #[inline(always)]
    fn same(&mut self, a: Self::Index, b: Self::Index) -> Self::Bool {
        each!(self, equal_u64s, a, b)
    }
    #[inline(always)]
    fn below(&mut self, a: Self::Index, value: u32) -> Self::Bool {
        let value = self.index(value);
        each!(self, less_than_u64s, a, value)
    }
    #[inline(always)]
    fn rows<const K: usize>(&mut self, table: &[[f64; K]], row: Self::Index) -> [Self::Real; K] {
        let mut columns = [self.real(0.0); K];
        gather_rows(table, lanes(&row), slots(columns.as_flattened_mut()));
        columns
    }
    #[inline(always)]
    fn entry(&mut self, table: &[u32], row: Self::Index) -> Self::Index {
        let mut entries = row;
        gather_entries(table, slots(&mut entries));
        entries
    }

    #[inline(always)]
    fn traced(&mut self, depth: usize, segment: Segment<Self>) {
        if let Some(watched) = &self.inputs.watched {
            self.watch(watched, depth, &segment);
        }
    }
    #[inline(always)]
    fn apart<T: Work<Self>>(&mut self, work: T) -> T::Output {
        let mut output = None;
        let cx = self;
        in_a_function(
            cx.simd,
            Apart {
                cx,
                work,
                output: &mut output,
            },
        );
        // `in_a_function` has run the work.
        #[allow(clippy::expect_used)]
        output.expect("the work's output")
    }
    #[inline(always)]
    fn coordinate(&mut self, coordinate: Coordinate) -> Self::Index {
        let indices = &self.inputs.indices[coordinate.slot()];
        let mut wide = self.index(0);
        widen(
            &indices[self.first..self.first + Self::COUNT],
            slots(&mut wide),
        );
        wide
    }
    #[inline(always)]
    fn centre(&mut self, index: Self::Index, bits: u32) -> Self::Real {
        let mut centres = self.real(0.0);
        cell_centres(lanes(&index), bits, slots(&mut centres));
        centres
    }
    #[inline(always)]
    fn sampled(&mut self, function: &Sampled, index: Self::Index) -> Self::Real {
        let mut values = self.real(0.0);
        sample(function, lanes(&index), slots(&mut values));
        values
    }
    #[inline(always)]
    fn pixel(&mut self) -> [Self::Real; 2] {
        let range = self.first..self.first + Self::COUNT;
        let mut pixel = [self.real(0.0); 2];
        slots(&mut pixel[0]).copy_from_slice(&self.inputs.column[range.clone()]);
        slots(&mut pixel[1]).copy_from_slice(&self.inputs.row[range]);
        pixel
    }
}
