//! Loops of plain arithmetic, compiled for the widest vector registers that the processor has.

use pulp::{Simd, WithSimd};
use qrt_machines::InstructionSet;

/// Runs `work`, compiled for [`InstructionSet::widest`].
///
/// Loops of `work` use its registers if all that they call is inlined. Results are the same on every
/// processor, because no operation is fused or reordered.
#[inline(always)]
pub(crate) fn vectorized<R>(work: impl FnOnce() -> R) -> R {
    struct Work<F>(F);
    impl<R, F: FnOnce() -> R> WithSimd for Work<F> {
        type Output = R;

        #[inline(always)]
        fn with_simd<S: Simd>(self, _: S) -> R {
            (self.0)()
        }
    }
    InstructionSet::widest().dispatch(Work(work))
}
