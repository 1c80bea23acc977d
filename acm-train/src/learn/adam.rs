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

use super::optimizer::Moments;

const BETA_1: f64 = 0.9;
const BETA_2: f64 = 0.999;
const EPSILON: f32 = 1e-8;

/// Where the weight decay λ acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Decay {
    /// Through the gradient and its averages.
    Coupled,
    /// On the parameter itself.
    Decoupled,
}

/// One step; `moments.steps` counts it already.
pub fn step(rate: f64, weight_decay: f64, decay: Decay, moments: &mut Moments, values: &mut [f32], gradient: &[f32]) {
    let steps = moments.steps as f64;
    // The corrections are taken out of the loop in double precision: 1 − 0.999ᵗ has no digits to lose.
    let size = (rate / (1.0 - BETA_1.powf(steps))) as f32;
    let spread = (1.0 / (1.0 - BETA_2.powf(steps)).sqrt()) as f32;
    let (l2, shrink) = match decay {
        Decay::Coupled => (weight_decay as f32, 1.0),
        Decay::Decoupled => (0.0, (1.0 - rate * weight_decay) as f32),
    };
    let (keep_1, keep_2) = (BETA_1 as f32, BETA_2 as f32);
    let (new_1, new_2) = ((1.0 - BETA_1) as f32, (1.0 - BETA_2) as f32);
    let averages = moments.first.iter_mut().zip(&mut moments.second);
    for ((p, &g), (m, v)) in values.iter_mut().zip(gradient).zip(averages) {
        let g = g + l2 * *p;
        *m = keep_1 * *m + new_1 * g;
        *v = keep_2 * *v + new_2 * g * g;
        *p = shrink * *p - size * *m / (v.sqrt() * spread + EPSILON);
    }
}
