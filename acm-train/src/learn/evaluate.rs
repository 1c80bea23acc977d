//! Predictions of a network, and their loss.

use acm_models::{Engine, Keep, Network};
use nalgebra::DMatrix;

use super::batch::{Batch, WindowSet};

/// Windows predicted at a time: more would not be faster, and memory stays small.
const BATCH: usize = 1024;

/// Predicted residual at the last step of each window, in the residual's unit: [N×O].
pub fn predict(network: &Network, windows: &WindowSet) -> DMatrix<f64> {
    let mut all = Vec::with_capacity(windows.len() * windows.outputs());
    walk(&mut Engine::new(network), &network.values(), windows, |predictions, _| all.extend_from_slice(predictions));
    windows.restore(&all)
}

/// Mean squared error of the standardised residual at the last steps.
///
/// The sum is in double precision and in the order of the windows, so the same weights give the same bits.
pub fn loss(engine: &mut Engine, weights: &[f32], windows: &WindowSet) -> f64 {
    let mut sum = 0.0;
    let error = |(p, t): (&f32, &f32)| (f64::from(*p) - f64::from(*t)).powi(2);
    walk(engine, weights, windows, |predictions, targets| {
        sum += predictions.iter().zip(targets).map(error).sum::<f64>()
    });
    sum / (windows.len() * windows.outputs()) as f64
}

/// Predictions and targets, batch after batch.
fn walk(engine: &mut Engine, weights: &[f32], windows: &WindowSet, mut visit: impl FnMut(&[f32], &[f32])) {
    let (mut batch, mut predictions) = (Batch::default(), Vec::new());
    let all: Vec<usize> = (0..windows.len()).collect();
    for chosen in all.chunks(BATCH) {
        windows.gather(chosen, Keep::Last, &mut batch);
        engine.predict(weights, &batch.windows(), &mut predictions);
        visit(&predictions, &batch.targets);
    }
}
