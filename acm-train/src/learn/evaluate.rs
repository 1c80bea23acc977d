//! Predictions of a network, and their loss.

use acm_models::burn::tensor::Device;
use acm_models::{Keep, Network};
use nalgebra::DMatrix;

use super::batch::WindowSet;

/// Windows predicted at a time: more would not be faster, and memory stays small.
const BATCH: usize = 1024;

/// Predicted residual at the last step of each window, in the residual's unit: [N×O].
pub fn predict(network: &Network, windows: &WindowSet) -> DMatrix<f64> {
    windows.restore(&standardised(network, windows))
}

/// Mean squared error of the standardised residual at the last steps.
///
/// The sum is in double precision and in the order of the windows, so the same weights give the same bits.
pub fn loss(network: &Network, windows: &WindowSet) -> f64 {
    let targets = windows.last_targets(0..windows.len());
    let error = |(p, t): (&f32, &f32)| (f64::from(*p) - f64::from(*t)).powi(2);
    standardised(network, windows).iter().zip(&targets).map(error).sum::<f64>() / targets.len() as f64
}

fn standardised(network: &Network, windows: &WindowSet) -> Vec<f32> {
    let device: Device = network.device().clone().inner();
    let network = network.on(&device);
    let all: Vec<usize> = (0..windows.len()).collect();
    let rows = all.chunks(BATCH).flat_map(|chosen| {
        let batch = windows.batch(chosen, Keep::Last, &device);
        let prediction = network.forward_last(batch.inputs, batch.elapsed);
        prediction.into_data().try_to_vec::<f32>().expect("networks predict f32")
    });
    rows.collect()
}
