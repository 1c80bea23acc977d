//! Loss and gradient of a network from slices of numbers: fused kernels on CPUs, tensors on every other device.
//!
//! | symbol      | meaning                                         | shape            |
//! | ----------- | ----------------------------------------------- | ---------------- |
//! | `values`    | all weights, as `Network::values` orders them   | [P]              |
//! | predictions | standardised, at every step or at the last      | [B,W,O] or [B,O] |
//! | gradient    | of the loss by each value                       | [P]              |
//!
//! A loss gets predictions, writes its derivatives by them, and returns its value. It may be asked part by part: its first
//! argument is the place of the part among all predictions. With the fused kernels no tensor is made, and once the largest
//! batch has come nothing is allocated.

use acm_kernels::{Keep, Kernel, Loss, Sequences, Workspace};
use burn::tensor::{Tensor, TensorData};

use crate::network::Network;
use crate::parameters::flat::numbers;

/// Engine that computes the gradients of a network.
#[derive(Debug)]
pub struct Engine(Way);

enum Way {
    Fused { kernel: Kernel, work: Box<Workspace> },
    Plain(Box<Network>),
}

impl Engine {
    /// Returns an engine for the shape, the device and the computing method of `network`; its weights do not matter.
    pub fn new(network: &Network) -> Self {
        Self(match network.kernel() {
            Some(kernel) => Way::Fused { work: Box::new(kernel.workspace()), kernel: kernel.clone() },
            None => Way::Plain(Box::new(network.clone())),
        })
    }

    /// Returns the loss; `gradient` is overwritten.
    ///
    /// # Panics
    /// If a slice is not as long as the shapes say.
    pub fn gradient(&mut self, values: &[f32], windows: &Sequences, loss: &Loss, gradient: &mut [f32]) -> f64 {
        match &mut self.0 {
            Way::Fused { kernel, work } => kernel.train(values, windows, loss, work, gradient),
            Way::Plain(network) => {
                let tracked = network.device().autodiff();
                **network = network.with_values(values, &tracked);
                let predicted = forward(network, windows);
                let numbers = numbers(predicted.clone().inner());
                let mut derivatives = vec![0.0; numbers.len()];
                let value = loss(0, &numbers, &mut derivatives);
                // The gradient of Σ derivative · prediction is that of the loss.
                let derivatives = Tensor::from_data(TensorData::new(derivatives, predicted.dims()), &tracked);
                let along = (predicted * derivatives).sum();
                gradient.copy_from_slice(&network.gradient(&mut along.backward()));
                value
            }
        }
    }

    /// Computes the predictions alone, in little memory, and replaces the contents of `predictions` by them.
    ///
    /// # Panics
    /// If a slice is not as long as the shapes say.
    pub fn predict(&mut self, values: &[f32], windows: &Sequences, predictions: &mut Vec<f32>) {
        match &mut self.0 {
            Way::Fused { kernel, work } => {
                predictions.resize(kernel.predictions(windows), 0.0);
                kernel.infer(values, windows, work, predictions);
            }
            Way::Plain(network) => {
                **network = network.with_values(values, &network.device().inner());
                *predictions = numbers(forward(network, windows));
            }
        }
    }
}

/// Returns the rows of predictions, window after window.
fn forward(network: &Network, windows: &Sequences) -> Tensor<2> {
    let Sequences { inputs, elapsed, batch, steps, keep, .. } = *windows;
    let device = network.device().inner();
    let inputs = Tensor::from_data(TensorData::new(inputs.to_vec(), [batch, steps, network.inputs()]), &device);
    let elapsed = Tensor::from_data(TensorData::new(elapsed.to_vec(), [batch, steps]), &device);
    match keep {
        Keep::Last => network.forward_last(inputs, elapsed),
        Keep::Every => network.forward(inputs, elapsed).reshape([batch * steps, network.outputs()]),
    }
}

impl std::fmt::Debug for Way {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Fused { .. } => "Fused",
            Self::Plain(_) => "Plain",
        })
    }
}
