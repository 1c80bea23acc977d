//! Gradients against central differences of the equations in double precision.
//!
//! The loss is L = Σ k_i p_i. With a step of 1e-5 the difference is good to 1e-9 or so.

use acm_kernels::{Activation, Body, Kernel, Level};

use crate::cases::{Case, cases, noise, wide_cases};
use crate::equations;
use crate::values::error;

const TOLERANCE: f64 = 1e-5;
const STEP: f64 = 1e-5;

/// Σ |k_i|: what the gradient's error is in proportion to.
fn size(case: &Case) -> f64 {
    case.derivatives().iter().map(|&k| f64::from(k.abs())).sum::<f64>().max(1.0)
}

fn differences(case: &Case) -> Vec<f64> {
    let batch = case.in_double();
    let weights: Vec<_> = case.derivatives().iter().map(|&k| f64::from(k)).collect();
    let mut parameters: Vec<_> = case.parameters.iter().map(|&p| f64::from(p)).collect();
    let mut loss = |i: usize, step: f64| {
        let before = std::mem::replace(&mut parameters[i], f64::from(case.parameters[i]) + step);
        let all = equations::predictions(&case.shape, &parameters, &batch);
        parameters[i] = before;
        all.iter().zip(&weights).map(|(p, k)| p * k).sum::<f64>()
    };
    (0..case.parameters.len()).map(|i| (loss(i, STEP) - loss(i, -STEP)) / (2.0 * STEP)).collect()
}

/// A kink within reach of the step would spoil the difference.
fn smooth(case: &Case) -> bool {
    let activation = match &case.shape.body {
        Body::Cfc(cfc) => Some(cfc.activation).filter(|_| cfc.backbone_layers > 0),
        Body::Mlp(mlp) => Some(mlp.activation),
        Body::Gru(_) => None,
    };
    activation != Some(Activation::Relu) || case.batch * case.steps < 20
}

#[test]
fn gradients_are_those_of_finite_differences() {
    let mut worst = 0f64;
    for case in cases().iter().filter(|case| smooth(case)) {
        let size = size(case);
        let expected: Vec<_> = differences(case).iter().map(|g| g / size).collect();
        for level in Level::available() {
            let kernel = Kernel::with_level(&case.shape, level).expect("sizes are positive");
            let (mut work, derivatives) = (kernel.workspace(), case.derivatives());
            let mut predictions = vec![0.0; derivatives.len()];
            let mut gradient = vec![f32::NAN; kernel.parameters()];
            kernel.forward(&case.parameters, &case.sequences(), &mut work, &mut predictions);
            kernel.backward(&case.parameters, &case.sequences(), &derivatives, &mut work, &mut gradient);
            let scaled: Vec<_> = gradient.iter().map(|&g| (f64::from(g) / size) as f32).collect();
            let off = error(&scaled, &expected);
            assert!(off < TOLERANCE, "{level:?}: off by {off:.1e}: {}", case.name());
            worst = worst.max(off);
        }
    }
    eprintln!("worst error {worst:.1e}");
}

/// Where single parameters are too many: the slope along a few directions, each of which moves all.
#[test]
fn gradients_of_wide_networks_are_right_in_any_direction() {
    for case in wide_cases() {
        let (batch, size) = (case.in_double(), size(&case));
        let loss = |direction: &[f32], step: f64| {
            let moved = case.parameters.iter().zip(direction).map(|(&p, &v)| f64::from(p) + step * f64::from(v));
            let all = equations::predictions(&case.shape, &moved.collect::<Vec<_>>(), &batch);
            all.iter().zip(case.derivatives()).map(|(p, k)| p * f64::from(k)).sum::<f64>()
        };
        let kernel = Kernel::new(&case.shape).expect("sizes are positive");
        let (mut work, derivatives) = (kernel.workspace(), case.derivatives());
        let mut predictions = vec![0.0; derivatives.len()];
        let mut gradient = vec![f32::NAN; kernel.parameters()];
        kernel.forward(&case.parameters, &case.sequences(), &mut work, &mut predictions);
        kernel.backward(&case.parameters, &case.sequences(), &derivatives, &mut work, &mut gradient);
        for root in [13.0, 17.0, 19.0, 23.0] {
            let direction = noise(gradient.len(), root);
            let expected = (loss(&direction, STEP) - loss(&direction, -STEP)) / (2.0 * STEP);
            let found: f64 = gradient.iter().zip(&direction).map(|(&g, &v)| f64::from(g) * f64::from(v)).sum();
            let off = (found - expected).abs() / size;
            assert!(off < TOLERANCE, "off by {off:.1e} of {expected}: {}", case.name());
        }
    }
}

/// Forward and back at once is forward, then back, to the bit.
#[test]
fn train_is_forward_and_backward() {
    for case in cases() {
        let kernel = Kernel::new(&case.shape).expect("sizes are positive");
        let (mut work, derivatives) = (kernel.workspace(), case.derivatives());
        let mut predictions = vec![0.0; derivatives.len()];
        let mut apart = vec![f32::NAN; kernel.parameters()];
        let mut at_once = apart.clone();
        kernel.forward(&case.parameters, &case.sequences(), &mut work, &mut predictions);
        kernel.backward(&case.parameters, &case.sequences(), &derivatives, &mut work, &mut apart);
        let loss = |first: usize, found: &[f32], to: &mut [f32]| {
            assert_eq!(found, &predictions[first..first + found.len()], "{}", case.name());
            to.copy_from_slice(&derivatives[first..first + to.len()]);
            to.iter().zip(found).map(|(k, p)| f64::from(k * p)).sum()
        };
        let total = kernel.train(&case.parameters, &case.sequences(), &loss, &mut work, &mut at_once);
        let expected: f64 = derivatives.iter().zip(&predictions).map(|(k, p)| f64::from(k * p)).sum();
        assert!((total - expected).abs() < 1e-9 * (1.0 + expected.abs()), "{}", case.name());
        assert_eq!(apart, at_once, "{}", case.name());
    }
}
