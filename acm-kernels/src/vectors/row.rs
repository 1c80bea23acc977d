//! One feature of [`ROWS`] samples: the unit in which activations are held.
//!
//! Activations lie feature by feature, [features][ROWS], not sample by sample. So the lanes of a vector are
//! samples, and every width works without padding: a network of 33 units has 33 rows. A concatenation
//! (u, 1, h) is three neighbouring stretches of rows, a stretch of gates is a slice.

use pulp::Simd;

/// Samples that go through the sequence side by side: two vectors of AVX-512, four of AVX2.
pub(crate) const ROWS: usize = 32;

/// A feature of each of the samples.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Row(pub [f32; ROWS]);

impl Row {
    /// Row of zeros.
    pub const ZERO: Self = Self([0.0; ROWS]);
    /// Factor of a bias.
    pub const ONE: Self = Self([1.0; ROWS]);

    /// Returns the samples as vectors.
    #[inline(always)]
    pub fn vectors<S: Simd>(&self) -> &[S::f32s] {
        S::as_simd_f32s(&self.0).0
    }

    /// Returns the samples as vectors.
    #[inline(always)]
    pub fn vectors_mut<S: Simd>(&mut self) -> &mut [S::f32s] {
        S::as_mut_simd_f32s(&mut self.0).0
    }
}

/// Returns the number of vectors in a row.
#[inline(always)]
pub(crate) const fn vectors<S: Simd>() -> usize {
    ROWS / S::F32_LANES
}
