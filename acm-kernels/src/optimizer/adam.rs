//! Adam and AdamW, as `torch.optim` computes them.
//!
//! ```text
//! coupled    g ← g + λ p            (L2, Adam)
//! decoupled  p ← p − η λ p          (AdamW)
//!
//! m ← β₁ m + (1 − β₁) g,   v ← β₂ v + (1 − β₂) g²
//! p ← p − η m̂ / (√v̂ + ε),   m̂ = m/(1 − β₁ᵗ),   v̂ = v/(1 − β₂ᵗ)
//! ```
//!
//! β₁ = 0.9, β₂ = 0.999, ε = 10⁻⁸. Kingma and Ba (2015), ICLR; Loshchilov and Hutter (2019), ICLR.
//!
//! [`pulp`] compiles the loop for each set of vector instructions and takes the widest that the processor has. Products and
//! sums are rounded apart on all of them, and roots and quotients exactly, so the width changes no bit.

use pulp::{Arch, Simd, WithSimd};

use super::moments::{FAINT_SQUARE, Moments};

const BETA_1: f64 = 0.9;
const BETA_2: f64 = 0.999;
const EPSILON: f32 = 1e-8;

/// Size below which an average gradient is negligible: over ε it moves no parameter by more than 10⁻²⁰ of the rate.
/// Where the gradient stays zero, the average would fade until it is a subnormal number, which processors multiply far
/// more slowly.
const FAINT: f32 = 1e-30;

/// Form of the weight decay λ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Decay {
    /// Weight decay in the gradient and its averages.
    Coupled,
    /// Weight decay on the parameter itself.
    Decoupled,
}

/// Takes one step; `moments.steps` counts it already.
pub fn step(rate: f64, weight_decay: f64, decay: Decay, moments: &mut Moments, values: &mut [f32], gradient: &[f32]) {
    let steps = moments.steps as f64;
    // The corrections are taken out of the loop in double precision: 1 − 0.999ᵗ has no digits to lose.
    let size = (rate / (1.0 - BETA_1.powf(steps))) as f32;
    let spread = (1.0 / (1.0 - BETA_2.powf(steps)).sqrt()) as f32;
    let (l2, shrink) = match decay {
        Decay::Coupled => (weight_decay as f32, 1.0),
        Decay::Decoupled => (0.0, (1.0 - rate * weight_decay) as f32),
    };
    let Moments { first, second, .. } = moments;
    Arch::new().dispatch(Pass { size, spread, l2, shrink, first, second, values, gradient });
}

/// One pass over all parameters, in the form that pulp needs.
struct Pass<'a> {
    size: f32,
    spread: f32,
    l2: f32,
    shrink: f32,
    first: &'a mut [f32],
    second: &'a mut [f32],
    values: &'a mut [f32],
    gradient: &'a [f32],
}

impl WithSimd for Pass<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { size, spread, l2, shrink, first, second, values, gradient } = self;
        let (keep_1, keep_2) = (BETA_1 as f32, BETA_2 as f32);
        let (new_1, new_2) = ((1.0 - BETA_1) as f32, (1.0 - BETA_2) as f32);
        for ((p, &g), (m, v)) in values.iter_mut().zip(gradient).zip(first.iter_mut().zip(second)) {
            let g = g + l2 * *p;
            let first = keep_1 * *m + new_1 * g;
            let second = keep_2 * *v + new_2 * g * g;
            // What is no number compares as false, and stays.
            *m = if first.abs() < FAINT { 0.0 } else { first };
            *v = if second < FAINT_SQUARE { 0.0 } else { second };
            *p = shrink * *p - size * *m / (v.sqrt() * spread + EPSILON);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optimizer::tests::architectures;

    /// Oracle: one number at a time, for every length up to some vectors and a rest.
    #[test]
    fn the_width_of_the_vectors_changes_no_bit() {
        let noise = |i: usize, root: f32| (i as f32 * root).sin();
        for count in [1, 7, 16, 33, 67] {
            let moved = |arch: Arch| {
                let column = |root: f32| -> Vec<f32> { (0..count).map(|i| noise(i, root)).collect() };
                let (mut values, mut first, mut second) = (column(1.3), column(0.7), column(2.1));
                second.iter_mut().for_each(|v| *v = v.abs());
                for step in 0..5 {
                    let gradient = column(0.3 + step as f32);
                    let (first, second, values) = (&mut first[..], &mut second[..], &mut values[..]);
                    let (size, spread, l2, shrink) = (1e-2, 3.0, 0.1, 0.99);
                    arch.dispatch(Pass { size, spread, l2, shrink, first, second, values, gradient: &gradient });
                }
                [values, first, second].map(|column| column.into_iter().map(f32::to_bits).collect::<Vec<_>>())
            };
            let plain = moved(Arch::Scalar);
            for arch in architectures() {
                assert_eq!(moved(arch), plain, "{count} parameters, {arch:?}");
            }
        }
    }

    /// Oracle: after one gradient g and k steps without any, m = 0.1 · 0.9ᵏ g and v = 0.001 · 0.999ᵏ g². Neither may linger
    /// among the numbers that are not normal, and what is no number must not look well.
    #[test]
    fn averages_fade_to_zero() {
        let (mut moments, mut values) = (Moments::new(2), [0.0, 0.0]);
        for k in 0..100_000 {
            moments.steps += 1;
            let gradient = if k == 0 { [1.0, f32::NAN] } else { [0.0; 2] };
            step(1e-3, 0.0, Decay::Coupled, &mut moments, &mut values, &gradient);
            let (m, v) = (0.1 * 0.9f64.powi(k), 0.001 * 0.999f64.powi(k));
            let near = |found: f32, expected: f64| (f64::from(found) / expected - 1.0).abs() < 1e-3;
            assert!(
                if m > 1e-29 { near(moments.first[0], m) } else { moments.first[0] == 0.0 || m > 1e-31 },
                "m at {k}"
            );
            assert!(moments.second[0] == 0.0 || moments.second[0].is_normal(), "v at {k}");
            assert!(v < 1e-8 || near(moments.second[0], v), "v at {k}");
        }
        assert_eq!((moments.first[0], moments.second[0]), (0.0, 0.0));
        assert!(moments.first[1].is_nan() && moments.second[1].is_nan() && values[1].is_nan());
    }
}
