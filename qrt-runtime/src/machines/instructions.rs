//! Instruction sets that a machine's inner loops are compiled for.

use pulp::WithSimd;

/// An instruction set. All give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InstructionSet {
    /// x86-64-v4: 512 bits.
    Avx512,
    /// x86-64-v3: 256 bits.
    Avx2,
    /// 128 bits of AArch64.
    Neon,
    /// What every processor of the target has.
    Portable,
}

impl InstructionSet {
    /// Those that this processor has, the widest first.
    pub fn available() -> Vec<Self> {
        let all = [Self::Avx512, Self::Avx2, Self::Neon, Self::Portable];
        all.into_iter().filter(|set| set.exists()).collect()
    }

    /// The widest that this processor has.
    pub fn widest() -> Self {
        Self::available().first().copied().unwrap_or(Self::Portable)
    }

    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    fn exists(self) -> bool {
        match self {
            Self::Avx512 => pulp::x86::V4::is_available(),
            Self::Avx2 => pulp::x86::V3::is_available(),
            Self::Neon => false,
            Self::Portable => true,
        }
    }

    #[cfg(target_arch = "aarch64")]
    fn exists(self) -> bool {
        match self {
            Self::Neon => pulp::aarch64::Neon::is_available(),
            Self::Portable => true,
            Self::Avx512 | Self::Avx2 => false,
        }
    }

    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64", target_arch = "aarch64")))]
    fn exists(self) -> bool {
        self == Self::Portable
    }

    /// Runs `operation` compiled for this instruction set, or portably where there is none such.
    #[inline(always)]
    pub(crate) fn dispatch<W: WithSimd>(self, operation: W) -> W::Output {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        match self {
            Self::Avx512 => {
                if let Some(simd) = pulp::x86::V4::try_new() {
                    return pulp::Simd::vectorize(simd, operation);
                }
            }
            Self::Avx2 => {
                if let Some(simd) = pulp::x86::V3::try_new() {
                    return pulp::Simd::vectorize(simd, operation);
                }
            }
            Self::Neon | Self::Portable => {}
        }
        #[cfg(target_arch = "aarch64")]
        if self == Self::Neon
            && let Some(simd) = pulp::aarch64::Neon::try_new()
        {
            return pulp::Simd::vectorize(simd, operation);
        }
        operation.with_simd(pulp::Scalar::new())
    }
}
