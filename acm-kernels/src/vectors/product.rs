//! Matrix times activations, in registers.
//!
//! ```text
//! y[o] = Σ_k w[o,k] x[k]        or, added to what is there,    y[o] += Σ_k w[o,k] x[k]
//! ```
//!
//! | symbol | meaning                                                   | shape      |
//! | ------ | --------------------------------------------------------- | ---------- |
//! | `x, y` | rows of activations                                       | [K], [O]   |
//! | `w`    | weights in panels of [`PANEL`] outputs, each [K][PANEL]   | O·K values |
//!
//! A tile is a panel of outputs times one or two vectors of samples; its sums stay in registers while k
//! runs. For every k a tile loads its vectors of x and multiplies them with PANEL broadcast weights: with
//! AVX-512 that is 24 multiply-adds for 14 loads. The last panel is as narrow as what is left, so no width
//! is padded.

use pulp::{Simd, WithSimd};

use crate::vectors::row::{Row, vectors};

/// Outputs in a panel.
pub(crate) const PANEL: usize = 12;

/// Computes y = w x, or y += w x where `ADD`.
#[inline(always)]
pub(crate) fn product<S: Simd, const ADD: bool>(s: S, w: &[f32], x: &[Row], y: &mut [Row]) {
    s.vectorize(Product::<ADD> { w, x, y });
}

/// A product in the form that pulp needs, so that one compiled copy serves all callers.
struct Product<'a, const ADD: bool> {
    w: &'a [f32],
    x: &'a [Row],
    y: &'a mut [Row],
}

impl<const ADD: bool> WithSimd for Product<'_, ADD> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, s: S) {
        let Self { w, x, y } = self;
        debug_assert_eq!(w.len(), x.len() * y.len());
        for (panel, y) in w.chunks(PANEL * x.len()).zip(y.chunks_mut(PANEL)) {
            match y.len() {
                1 => rows::<S, 1, ADD>(s, panel, x, y),
                2 => rows::<S, 2, ADD>(s, panel, x, y),
                3 => rows::<S, 3, ADD>(s, panel, x, y),
                4 => rows::<S, 4, ADD>(s, panel, x, y),
                5 => rows::<S, 5, ADD>(s, panel, x, y),
                6 => rows::<S, 6, ADD>(s, panel, x, y),
                7 => rows::<S, 7, ADD>(s, panel, x, y),
                8 => rows::<S, 8, ADD>(s, panel, x, y),
                9 => rows::<S, 9, ADD>(s, panel, x, y),
                10 => rows::<S, 10, ADD>(s, panel, x, y),
                11 => rows::<S, 11, ADD>(s, panel, x, y),
                _ => rows::<S, PANEL, ADD>(s, panel, x, y),
            }
        }
    }
}

/// Multiplies one panel by the whole row, as many vectors at a time as the registers hold.
#[inline(always)]
fn rows<S: Simd, const P: usize, const ADD: bool>(s: S, panel: &[f32], x: &[Row], y: &mut [Row]) {
    if S::REGISTER_COUNT >= 32 {
        for v in (0..vectors::<S>()).step_by(2) {
            tile::<S, P, 2, ADD>(s, panel, x, y, v);
        }
    } else {
        for v in 0..vectors::<S>() {
            tile::<S, P, 1, ADD>(s, panel, x, y, v);
        }
    }
}

/// Computes P outputs of V vectors, the first of which is number `v` of its row.
#[inline(always)]
fn tile<S: Simd, const P: usize, const V: usize, const ADD: bool>(
    s: S,
    panel: &[f32],
    x: &[Row],
    y: &mut [Row],
    v: usize,
) {
    let Some(y) = y.first_chunk_mut::<P>() else { return };
    let mut sums = [[s.splat_f32s(0.0); V]; P];
    if ADD {
        for i in 0..P {
            sums[i] = std::array::from_fn(|n| y[i].vectors::<S>()[v + n]);
        }
    }
    let (weights, _) = panel.as_chunks::<P>();
    for (weights, x) in weights.iter().zip(x) {
        let x: [S::f32s; V] = std::array::from_fn(|n| x.vectors::<S>()[v + n]);
        for i in 0..P {
            let weight = s.splat_f32s(weights[i]);
            for n in 0..V {
                sums[i][n] = s.mul_add_e_f32s(weight, x[n], sums[i][n]);
            }
        }
    }
    // One by one: a slice copied as a whole would need the sums in memory.
    for i in 0..P {
        for n in 0..V {
            y[i].vectors_mut::<S>()[v + n] = sums[i][n];
        }
    }
}
