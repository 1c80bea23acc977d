//! Predictions of a network, and their loss.

use acm_models::{Engine, Keep, Network, Stepper};
use nalgebra::DMatrix;

use crate::learn::examples::Examples;
use crate::learn::examples::batch::Batch;
use crate::learn::projection::Projection;

/// Returns the predicted residual at each target, in the residual's unit: [N×O]. Where the state is carried, it has the bits of an
/// estimator that takes one sample after the other.
///
/// # Panics
/// If the targets are no residual.
pub fn predict(network: &Network, examples: &dyn Examples) -> DMatrix<f64> {
    let mut all = vec![];
    let visit = |predictions: &[f32], batch: &Batch| {
        let [scored, _] = batch.scored(predictions);
        all.extend(scored.iter().map(|value| f64::from(*value)));
    };
    match network.kernel().filter(|_| examples.carry_state()) {
        Some(kernel) => step(&mut kernel.stepper(&network.values()), network.outputs(), examples, visit),
        None => walk(&mut Engine::new(network), &network.values(), examples, visit),
    }
    let (rows, outputs) = (all.len() / examples.outputs(), examples.outputs());
    let scaler = examples.residual().expect("the targets are a residual");
    scaler.restore(&DMatrix::from_row_iterator(rows, outputs, all))
}

/// Returns the mean loss: of the standardised residual at the last steps, or of whatever counts in the examples.
///
/// The sum is in double precision and in the order of the examples, so the same weights give the same bits.
pub fn loss(engine: &mut Engine, weights: &[f32], examples: &dyn Examples) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    walk(engine, weights, examples, |predictions, batch| {
        let (error, counted) = batch.error(predictions);
        (sum, count) = (sum + error, count + counted);
    });
    sum / count as f64
}

/// Computes the loss as [`loss`] does, with the projection of the residual on the predictions where the targets are a
/// residual.
pub fn validate(engine: &mut Engine, weights: &[f32], examples: &dyn Examples) -> (f64, Option<Projection>) {
    let (mut sum, mut count, mut sums) = (0.0, 0, examples.residual().map(|_| Projection::default()));
    walk(engine, weights, examples, |predictions, batch| {
        let (error, counted) = batch.error(predictions);
        (sum, count) = (sum + error, count + counted);
        if let (Some(scaler), Some(sums)) = (examples.residual(), &mut sums) {
            let [predictions, targets] = batch.scored(predictions);
            *sums += Projection::of(scaler, &predictions, &targets);
        }
    });
    (sum / count as f64, sums.map(|sums| sums.over(count / examples.outputs())))
}

/// Passes the predictions of each example to `visit`, computed step by step.
fn step(stepper: &mut Stepper, outputs: usize, examples: &dyn Examples, mut visit: impl FnMut(&[f32], &Batch)) {
    let (mut batch, channels) = (Batch::default(), examples.channels());
    for index in 0..examples.len() {
        examples.gather(&[index], Keep::Last, &mut batch);
        stepper.reset();
        let mut said = vec![0.0; batch.elapsed.len() * outputs];
        for (k, answer) in said.chunks_mut(outputs).enumerate() {
            stepper.step(&batch.inputs[k * channels..(k + 1) * channels], batch.elapsed[k], answer);
        }
        visit(&batch.predictions(&said), &batch);
    }
}

/// Passes predictions and their batches to `visit`, batch after batch.
pub fn walk(engine: &mut Engine, weights: &[f32], examples: &dyn Examples, mut visit: impl FnMut(&[f32], &Batch)) {
    let (mut batch, mut predictions) = (Batch::default(), Vec::new());
    for chosen in examples.batches() {
        examples.gather(&chosen.collect::<Vec<_>>(), Keep::Last, &mut batch);
        engine.predict(weights, &batch.windows(), &mut predictions);
        visit(&batch.predictions(&predictions), &batch);
    }
}
