//! RMSprop without momentum, as `torch.optim` computes it.
//!
//! ```text
//! g ← g + λ p,   v ← α v + (1 − α) g²,   p ← p − η g / (√v + ε)
//! ```
//!
//! α = 0.99, ε = 10⁻⁸. Tieleman and Hinton (2012), Neural Networks for Machine Learning, lecture 6.

use super::optimizer::Moments;

const ALPHA: f64 = 0.99;
const EPSILON: f32 = 1e-8;

/// One step.
pub fn step(rate: f64, weight_decay: f64, moments: &mut Moments, values: &mut [f32], gradient: &[f32]) {
    let (keep, new) = (ALPHA as f32, (1.0 - ALPHA) as f32);
    let (rate, l2) = (rate as f32, weight_decay as f32);
    for ((p, &g), v) in values.iter_mut().zip(gradient).zip(&mut moments.second) {
        let g = g + l2 * *p;
        *v = keep * *v + new * g * g;
        *p -= rate * g / (v.sqrt() + EPSILON);
    }
}
