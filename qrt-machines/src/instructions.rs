//! Instruction sets that a machine's inner loops are compiled for.

use pulp::WithSimd;
use std::ffi::OsStr;
use std::sync::OnceLock;

/// An instruction set. All give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InstructionSet {
    /// x86-64-v4: 512 bits.
    Avx512,
    /// x86-64-v3: 256 bits.
    Avx2,
    /// 128 bits of AArch64.
    Neon,
    /// The instructions that every processor of the target has.
    Portable,
}

/// The environment variable names an instruction set that this processor does not have.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}={asked}: this processor has {}", InstructionSet::VARIABLE, listed(.available))]
pub struct InstructionsError {
    /// The name in the environment variable.
    pub asked: String,
    /// The instruction sets that this processor has.
    pub available: Vec<InstructionSet>,
}

fn listed(sets: &[InstructionSet]) -> String {
    let names: Vec<String> = sets.iter().map(|set| format!("`{}`", set.name())).collect();
    names.join(", ")
}

impl InstructionSet {
    /// All sets, the widest first.
    pub const ALL: [Self; 4] = [Self::Avx512, Self::Avx2, Self::Neon, Self::Portable];

    /// The name by which [`InstructionSet::VARIABLE`] selects it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Avx512 => "avx512",
            Self::Avx2 => "avx2",
            Self::Neon => "neon",
            Self::Portable => "portable",
        }
    }

    /// Name of the environment variable that sets the instruction set of all machines that are
    /// created without one, for example `QRT_INSTRUCTIONS=portable`. It changes only their speed.
    pub const VARIABLE: &'static str = "QRT_INSTRUCTIONS";

    /// Returns the instruction sets that this processor has, the widest first.
    pub fn available() -> Vec<Self> {
        Self::ALL.into_iter().filter(|set| set.exists()).collect()
    }

    /// Returns the instruction set that [`InstructionSet::VARIABLE`] names at the first call, or
    /// else the widest that this processor has.
    pub fn widest() -> Self {
        static WIDEST: OnceLock<InstructionSet> = OnceLock::new();
        *WIDEST.get_or_init(|| match Self::asked() {
            Ok(Some(asked)) => asked,
            _ => Self::available().first().copied().unwrap_or(Self::Portable),
        })
    }

    /// Returns the instruction set that [`InstructionSet::VARIABLE`] names, if the variable is set.
    ///
    /// # Errors
    /// If it names no instruction set that this processor has; machines then use the widest.
    pub fn asked() -> Result<Option<Self>, InstructionsError> {
        std::env::var_os(Self::VARIABLE).map_or(Ok(None), |name| Self::named(&name).map(Some))
    }

    fn named(name: &OsStr) -> Result<Self, InstructionsError> {
        let available = Self::available();
        let found = available.iter().find(|set| name == set.name());
        found.copied().ok_or_else(|| InstructionsError {
            asked: name.to_string_lossy().into_owned(),
            available: available.clone(),
        })
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

    /// Runs `operation` compiled for this instruction set, or portably if the processor does not
    /// have it.
    #[inline(always)]
    pub fn dispatch<W: WithSimd>(self, operation: W) -> W::Output {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_instruction_set_has_a_name_and_what_is_not_there_is_refused() {
        for set in InstructionSet::ALL {
            let found = InstructionSet::named(set.name().as_ref());
            assert_eq!(found.is_ok_and(|found| found == set), set.exists());
        }
        for name in ["", "AVX2", "scalar"] {
            let error = InstructionSet::named(name.as_ref()).unwrap_err();
            let words = error.to_string();
            assert!(words.starts_with(&format!("QRT_INSTRUCTIONS={name}: ")));
            assert!(words.ends_with("`portable`"), "{words}");
        }
    }
}
