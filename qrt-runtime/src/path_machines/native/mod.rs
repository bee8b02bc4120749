//! The native machine: a scene's program as native code for vectors of lanes.
//!
//! It computes what [`qrt_circuit::Contents`] defines, as the fixed machine does, but without a
//! list of steps to interpret and without memory between the steps. `qrt!` writes the program as
//! one function over [`Vectors`]. Each line of it is an instruction or a few, and the ranges of the
//! registers determine the lanes that each number takes. The compiler keeps the numbers in the
//! processor's registers.
//!
//! The code undoes nothing: it computes each value once and then drops it.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod scalar;
#[cfg(test)]
mod tests;
mod vectors;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use scalar::Scalar;
pub use vectors::{Integers, Truths, Vectors, word};

use pulp::NullaryFnOnce;
use qrt_core::oracle::compiled::CompiledOracle;
use qrt_machines::InstructionSet;
use std::marker::PhantomData;

/// A compiled oracle that also has code for vectors.
#[diagnostic::on_unimplemented(
    message = "there is no native code for the circuit of `{Self}`",
    label = "not compiled to native code",
    note = "`qrt!` writes code for circuits of at most 20,000 operations"
)]
pub trait NativeOracle: CompiledOracle {
    /// True if the code exists. `qrt!` writes it in optimised builds and for tests. In other builds
    /// with `debug_assertions` it would take longer to compile than the rest of the program, and
    /// would not finish sooner than the fixed machine, which takes its place.
    const WRITTEN: bool = true;

    /// Computes the paths `ids` in a pixel with the classical parameters `words`. Returns by
    /// channel the number of thresholds that the paths' colours exceed, before it is cut to `2^c`,
    /// and the colours.
    fn native<V: Vectors>(v: V, words: &[u64], ids: V::Longs) -> [[V::Longs; 3]; 2];
}

/// Runs a part of the code, which has a stack frame of its own if it is not inlined.
#[doc(hidden)]
#[inline(always)]
pub fn block<T>(part: impl FnOnce() -> T) -> T {
    part()
}

/// Neighbouring path indices of one pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run<'a> {
    pub(super) first: u64,
    pub(super) count: usize,
    /// The pixel's classical parameters.
    pub(super) parameters: &'a [u64],
}

/// Computes runs of paths, one after another. Sets `values[k][path]` to the path's k-th output: by
/// channel the counts and, if there are more than three columns, the colours.
pub(super) fn compute_runs<C: NativeOracle>(
    set: InstructionSet,
    runs: &[Run<'_>],
    values: &mut [Vec<i64>],
) {
    #[cfg(target_arch = "x86_64")]
    if set == InstructionSet::Avx512
        && let Some(simd) = pulp::x86::V4::try_new()
    {
        return simd.vectorize(NativeTask::<C, _>::new(simd, runs, values));
    }
    #[cfg(target_arch = "x86_64")]
    if set == InstructionSet::Avx2
        && let Some(simd) = pulp::x86::V3::try_new()
    {
        return simd.vectorize(NativeTask::<C, _>::new(simd, runs, values));
    }
    let _ = set;
    NativeTask::<C, _>::new(Scalar, runs, values).call();
}

struct NativeTask<'a, C, V> {
    vectors: V,
    runs: &'a [Run<'a>],
    values: &'a mut [Vec<i64>],
    oracle: PhantomData<C>,
}

impl<'a, C, V> NativeTask<'a, C, V> {
    fn new(vectors: V, runs: &'a [Run<'a>], values: &'a mut [Vec<i64>]) -> Self {
        Self {
            vectors,
            runs,
            values,
            oracle: PhantomData,
        }
    }
}

impl<C: NativeOracle, V: Vectors> NullaryFnOnce for NativeTask<'_, C, V> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let v = self.vectors;
        let mut start = 0;
        for run in self.runs {
            for done in (0..run.count).step_by(V::LANES) {
                let ids = v.from(run.first + done as u64);
                let [counts, colours] = C::native(v, run.parameters, ids);
                let place = start + done;
                let rest = V::LANES.min(run.count - done);
                let [red, green, blue] = counts;
                v.store(red, lanes(self.values, 0, place, rest));
                v.store(green, lanes(self.values, 1, place, rest));
                v.store(blue, lanes(self.values, 2, place, rest));
                if self.values.len() > 3 {
                    let [red, green, blue] = colours;
                    v.store(red, lanes(self.values, 3, place, rest));
                    v.store(green, lanes(self.values, 4, place, rest));
                    v.store(blue, lanes(self.values, 5, place, rest));
                }
            }
            start += run.count;
        }
    }
}

/// Returns `count` places of a column from `first` on; none if the column does not exist.
#[inline(always)]
fn lanes(values: &mut [Vec<i64>], column: usize, first: usize, count: usize) -> &mut [i64] {
    let column = values.get_mut(column);
    column
        .and_then(|column| column.get_mut(first..first + count))
        .unwrap_or_default()
}
