//! RMSprop without momentum, as `torch.optim` computes it.
//!
//! ```text
//! g ← g + λ p,   v ← α v + (1 − α) g²,   p ← p − η g / (√v + ε)
//! ```
//!
//! α = 0.99, ε = 10⁻⁸. Tieleman and Hinton (2012), Neural Networks for Machine Learning, lecture 6.

use pulp::{Arch, Simd, WithSimd};

use super::moments::{FAINT_SQUARE, Moments};

const ALPHA: f64 = 0.99;
const EPSILON: f32 = 1e-8;

/// Takes one step, with the widest vectors that the processor has; the width changes no bit (see `adam`).
pub fn step(rate: f64, weight_decay: f64, moments: &mut Moments, values: &mut [f32], gradient: &[f32]) {
    let (rate, l2) = (rate as f32, weight_decay as f32);
    Arch::new().dispatch(Pass { rate, l2, second: &mut moments.second, values, gradient });
}

/// One pass over all parameters, in the form that pulp needs.
struct Pass<'a> {
    rate: f32,
    l2: f32,
    second: &'a mut [f32],
    values: &'a mut [f32],
    gradient: &'a [f32],
}

impl WithSimd for Pass<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { rate, l2, second, values, gradient } = self;
        let (keep, new) = (ALPHA as f32, (1.0 - ALPHA) as f32);
        for ((p, &g), v) in values.iter_mut().zip(gradient).zip(second) {
            let g = g + l2 * *p;
            let second = keep * *v + new * g * g;
            *v = if second < FAINT_SQUARE { 0.0 } else { second };
            *p -= rate * g / (v.sqrt() + EPSILON);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optimizer::tests::architectures;

    /// Oracle: one number at a time.
    #[test]
    fn the_width_of_the_vectors_changes_no_bit() {
        let column = |root: f32| -> Vec<f32> { (0..67).map(|i| (i as f32 * root).sin()).collect() };
        let moved = |arch: Arch| {
            let (mut values, mut second) = (column(1.3), vec![0.0; 67]);
            for step in 0..5 {
                let gradient = column(0.3 + step as f32);
                let (second, values) = (&mut second[..], &mut values[..]);
                arch.dispatch(Pass { rate: 1e-2, l2: 0.1, second, values, gradient: &gradient });
            }
            [values, second].map(|column| column.into_iter().map(f32::to_bits).collect::<Vec<_>>())
        };
        let plain = moved(Arch::Scalar);
        for arch in architectures() {
            assert_eq!(moved(arch), plain, "{arch:?}");
        }
    }

    /// Oracle: after one gradient of 1 and k steps without any, v = 0.01 · 0.99ᵏ, until it is as good as none.
    #[test]
    fn the_average_fades_to_zero() {
        let (mut moments, mut value) = (Moments::new(1), [0.0]);
        for k in 0..10_000 {
            step(1e-3, 0.0, &mut moments, &mut value, &[if k == 0 { 1.0 } else { 0.0 }]);
            let (v, found) = (0.01 * 0.99f64.powi(k), moments.second[0]);
            assert!(v < 1e-33 || (f64::from(found) / v - 1.0).abs() < 1e-3, "{found} instead of {v} at {k}");
            assert!(found == 0.0 || found.is_normal(), "{found} at {k}");
        }
        assert_eq!(moments.second[0], 0.0);
    }
}
