//! Predictions of a network, and their loss.

use acm_models::{Engine, Keep, Network};
use nalgebra::DMatrix;

use crate::learn::examples::Examples;
use crate::learn::examples::batch::Batch;
use crate::learn::examples::windows::WindowSet;
use crate::learn::projection::Projection;

/// Number of windows predicted at a time: more would not be faster, and memory stays small.
const BATCH: usize = 1024;

/// Returns the predicted residual at the last step of each window, in the residual's unit: [N×O].
pub fn predict(network: &Network, windows: &WindowSet) -> DMatrix<f64> {
    let mut all = Vec::with_capacity(windows.len() * windows.outputs());
    walk(&mut Engine::new(network), &network.values(), windows, |predictions, _| {
        all.extend_from_slice(predictions);
    });
    windows.restore(&all)
}

/// Returns the mean loss: of the standardised residual at the last steps, or of whatever counts in the examples.
///
/// The sum is in double precision and in the order of the examples, so the same weights give the same bits.
pub fn loss(engine: &mut Engine, weights: &[f32], examples: &impl Examples) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    walk(engine, weights, examples, |predictions, batch| {
        let (error, counted) = batch.error(predictions);
        (sum, count) = (sum + error, count + counted);
    });
    sum / count as f64
}

/// Computes the loss as [`loss`] does, with the projection of the residual on the predictions where the targets are a
/// residual.
pub fn validate(engine: &mut Engine, weights: &[f32], examples: &impl Examples) -> (f64, Option<Projection>) {
    let (mut sum, mut count, mut sums) = (0.0, 0, examples.residual().map(|_| Projection::default()));
    walk(engine, weights, examples, |predictions, batch| {
        let (error, counted) = batch.error(predictions);
        (sum, count) = (sum + error, count + counted);
        if let (Some(scaler), Some(sums)) = (examples.residual(), &mut sums) {
            *sums += Projection::of(scaler, predictions, &batch.targets);
        }
    });
    (sum / count as f64, sums.map(|sums| sums.over(examples.len())))
}

/// Passes predictions and their batches to `visit`, batch after batch.
pub fn walk(engine: &mut Engine, weights: &[f32], examples: &impl Examples, mut visit: impl FnMut(&[f32], &Batch)) {
    let (mut batch, mut predictions) = (Batch::default(), Vec::new());
    let all: Vec<usize> = (0..examples.len()).collect();
    for chosen in all.chunks(BATCH) {
        examples.gather(chosen, Keep::Last, &mut batch);
        engine.predict(weights, &batch.windows(), &mut predictions);
        visit(&batch.predictions(&predictions), &batch);
    }
}
