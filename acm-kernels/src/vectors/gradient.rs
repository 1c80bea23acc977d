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
//! | `g`    | gradient, in panels of [`HIGH`] rows | each [K][HIGH]            |
//!
//! A tile of g stays in registers while t runs over [`CHUNK`] steps, one sum for each lane; the lanes are
//! added up together at its end (see `lanes`), in the order in which g has them. A chunk is as long as keeps a
//! tile's share of d in the first-level cache while x goes by. The last panel is as narrow as what is left.

use pulp::{Simd, WithSimd, bytemuck};

use crate::vectors::lanes::pack_sums;
use crate::vectors::row::{Row, vectors};

/// Largest number of time steps in one sum of products.
pub(crate) const CHUNK: usize = 32;

/// Rows of the gradient in a panel.
pub(crate) const HIGH: usize = 4;

/// Number of sums in the largest tile, a multiple of the lanes of every vector.
const SUMS: usize = 16;

/// Rows of activations at equal distances, one stretch for each time step.
#[derive(Clone, Copy)]
pub(crate) struct Stretches<'a> {
    /// Rows from the first row of the first stretch on.
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

/// The sum in the form that pulp needs, so that one compiled copy serves all callers.
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
        // As wide as leaves registers for the factors.
        if S::REGISTER_COUNT >= 32 { self.tiles::<S, 4>(s) } else { self.tiles::<S, 3>(s) }
    }
}

impl Products<'_> {
    /// Adds tiles of [`HIGH`] rows and `WIDE` columns.
    #[inline(always)]
    fn tiles<S: Simd, const WIDE: usize>(self, s: S) {
        let Self { steps, d, x, g } = self;
        for (o, g) in (0..d.width).step_by(HIGH).zip(g.chunks_mut(HIGH * x.width)) {
            let high = HIGH.min(d.width - o);
            for (k, g) in (0..x.width).step_by(WIDE).zip(g.chunks_mut(WIDE * high)) {
                let d_rows = || d.rows[o..].chunks(d.stride).take(steps);
                let x_rows = || x.rows[k..].chunks(x.stride).take(steps);
                macro_rules! tiles {
                    ($(($i:literal, $j:literal))+) => {
                        match (high, WIDE.min(x.width - k)) {
                            $(($i, $j) => tile::<S, $i, $j>(s, d_rows(), x_rows(), g),)+
                            _ => {}
                        }
                    };
                }
                tiles! {
                    (1, 1) (1, 2) (1, 3) (1, 4)
                    (2, 1) (2, 2) (2, 3) (2, 4)
                    (3, 1) (3, 2) (3, 3) (3, 4)
                    (4, 1) (4, 2) (4, 3) (4, 4)
                }
            }
        }
    }
}

/// Adds I rows by J columns of the gradient, column by column.
#[inline(always)]
fn tile<'a, S: Simd, const I: usize, const J: usize>(
    s: S,
    d: impl Iterator<Item = &'a [Row]>,
    x: impl Iterator<Item = &'a [Row]>,
    g: &mut [f32],
) {
    let mut sums = [s.splat_f32s(0.0); SUMS];
    for (d, x) in d.zip(x) {
        let (Some(d), Some(x)) = (d.first_chunk::<I>(), x.first_chunk::<J>()) else { return };
        for v in 0..vectors::<S>() {
            let x: [S::f32s; J] = std::array::from_fn(|j| x[j].vectors::<S>()[v]);
            for i in 0..I {
                let d = d[i].vectors::<S>()[v];
                for j in 0..J {
                    sums[j * I + i] = s.mul_add_e_f32s(d, x[j], sums[j * I + i]);
                }
            }
        }
    }
    pack_sums(s, &mut sums);
    let sums: &[f32] = bytemuck::cast_slice(&sums);
    g.iter_mut().zip(&sums[..I * J]).for_each(|(g, sum)| *g += sum);
}
