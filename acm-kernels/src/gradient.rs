//! Gradient of a matrix: products of two activations, summed over samples and time steps.
//!
//! ```text
//! g[o,k] += Σ_t Σ_samples d[t,o] x[t,k]
//! ```
//!
//! | symbol | meaning                              | shape                     |
//! | ------ | ------------------------------------ | ------------------------- |
//! | `d`    | derivative of the loss by the output | T stretches of O rows     |
//! | `x`    | input of the matrix                  | T stretches of K rows     |
//! | `g`    | gradient, row by row                 | [O,K]                     |
//!
//! A tile of g stays in registers while t runs over [`CHUNK`] steps, one sum for each lane; the lanes are
//! added up once at its end. A chunk is as long as keeps a tile's share of d in the first-level cache
//! while x goes by.

use pulp::{Simd, WithSimd};

use crate::row::{Row, vectors};

/// Most time steps in one sum of products.
pub(crate) const CHUNK: usize = 32;

/// Rows of activations at equal distances, one stretch for each time step.
#[derive(Clone, Copy)]
pub(crate) struct Stretches<'a> {
    /// From the first row of the first stretch on.
    pub rows: &'a [Row],
    /// Rows from one stretch to the next.
    pub stride: usize,
    /// Rows in a stretch.
    pub width: usize,
}

/// Adds to `g` the products of `steps` stretches of d and x.
#[inline(always)]
pub(crate) fn add_products<S: Simd>(s: S, steps: usize, d: Stretches, x: Stretches, g: &mut [f32]) {
    s.vectorize(Products { steps, d, x, g });
}

/// The sum as pulp wants it, so that one compiled copy serves all callers.
struct Products<'a> {
    steps: usize,
    d: Stretches<'a>,
    x: Stretches<'a>,
    g: &'a mut [f32],
}

impl WithSimd for Products<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, s: S) {
        let Self { steps, d, x, g } = self;
        let (high, wide) = if S::REGISTER_COUNT >= 32 { (4, 5) } else { (3, 3) };
        for o in (0..d.width).step_by(high) {
            for k in (0..x.width).step_by(wide) {
                let d_rows = || d.rows[o..].chunks(d.stride).take(steps);
                let x_rows = || x.rows[k..].chunks(x.stride).take(steps);
                let g = &mut g[o * x.width + k..];
                macro_rules! tiles {
                    ($(($i:literal, $j:literal))+) => {
                        match (high.min(d.width - o), wide.min(x.width - k)) {
                            $(($i, $j) => tile::<S, $i, $j>(s, d_rows(), x_rows(), g, x.width),)+
                            _ => {}
                        }
                    };
                }
                tiles! {
                    (1, 1) (1, 2) (1, 3) (1, 4) (1, 5)
                    (2, 1) (2, 2) (2, 3) (2, 4) (2, 5)
                    (3, 1) (3, 2) (3, 3) (3, 4) (3, 5)
                    (4, 1) (4, 2) (4, 3) (4, 4) (4, 5)
                }
            }
        }
    }
}

/// I rows by J columns of the gradient.
#[inline(always)]
fn tile<'a, S: Simd, const I: usize, const J: usize>(
    s: S,
    d: impl Iterator<Item = &'a [Row]>,
    x: impl Iterator<Item = &'a [Row]>,
    g: &mut [f32],
    stride: usize,
) {
    let mut sums = [[s.splat_f32s(0.0); J]; I];
    for (d, x) in d.zip(x) {
        let (Some(d), Some(x)) = (d.first_chunk::<I>(), x.first_chunk::<J>()) else { return };
        for v in 0..vectors::<S>() {
            let x: [S::f32s; J] = std::array::from_fn(|j| x[j].vectors::<S>()[v]);
            for i in 0..I {
                let d = d[i].vectors::<S>()[v];
                for j in 0..J {
                    sums[i][j] = s.mul_add_e_f32s(d, x[j], sums[i][j]);
                }
            }
        }
    }
    for i in 0..I {
        for j in 0..J {
            g[i * stride + j] += s.reduce_sum_f32s(sums[i][j]);
        }
    }
}
