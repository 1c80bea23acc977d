//! Vector instruction sets, detected at run time once a kernel.
//!
//! The choice is pulp's: each piece of work is compiled once for each level, and a kernel calls the copy
//! of its own. So the program needs no `target-cpu`, and a test can force every level that the processor has.

use pulp::{Arch, WithSimd};

/// A set of vector instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// One number at a time.
    Scalar,
    /// NEON, four numbers at a time.
    Neon,
    /// AVX2 with fused multiply-add, eight numbers at a time.
    Avx2,
    /// AVX-512, sixteen numbers at a time.
    Avx512,
}

impl Level {
    /// All levels, the plainest first.
    pub const ALL: [Self; 4] = [Self::Scalar, Self::Neon, Self::Avx2, Self::Avx512];

    /// Returns the best level that this processor has.
    pub fn best() -> Self {
        Self::ALL.into_iter().rev().find(|level| level.arch().is_some()).unwrap_or(Self::Scalar)
    }

    /// Returns the levels that this processor has.
    pub fn available() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|level| level.arch().is_some())
    }

    /// Returns the instructions themselves; `None` where the processor lacks them.
    pub(crate) fn arch(self) -> Option<Arch> {
        match self {
            Self::Scalar => Some(Arch::Scalar),
            #[cfg(target_arch = "aarch64")]
            Self::Neon => pulp::aarch64::Neon::try_new().map(Arch::Neon),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Self::Avx2 => pulp::x86::V3::try_new().map(Arch::V3),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Self::Avx512 => pulp::x86::V4::try_new().map(Arch::V4),
            #[allow(unreachable_patterns, reason = "each processor lacks some levels")]
            _ => None,
        }
    }
}

/// Runs `work` with the instructions of `arch`.
#[inline]
pub(crate) fn run<W: WithSimd>(arch: Arch, work: W) -> W::Output {
    arch.dispatch(work)
}
