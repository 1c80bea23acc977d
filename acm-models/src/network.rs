//! A network with its weights: the recurrent or feed-forward body, and the linear output layer.
//!
//! ```text
//! prediction = W_head · features + b_head
//! ```

use std::sync::Arc;

use acm_kernels::{Kernel, Shape};
use burn::tensor::{Device, Gradients, Tensor};

use crate::affine::linear;
use crate::architecture::Keep;
use crate::networks::NetworkConfig;
use crate::parameter::{Blueprint, Parameter, Weights, read};
use crate::sequence::{Pass, Pool, sequence};
use crate::steps::Steps;

/// A network on a device. On a device with autodiff its parameters are tracked.
#[derive(Clone, Debug)]
pub struct Network {
    config: NetworkConfig,
    inputs: usize,
    outputs: usize,
    device: Device,
    parameters: Vec<Parameter>,
    /// Of the fused kernels; none where plain tensor operations are used.
    pool: Option<Arc<Pool>>,
}

impl Network {
    /// A new network for `inputs` channels and `outputs` predictions; its first values follow from
    /// `seed` alone. On flex, burn's device for processors, it is computed by the fused kernels.
    ///
    /// # Panics
    /// If the configuration was not validated.
    pub fn new(config: &NetworkConfig, inputs: usize, outputs: usize, seed: u64, device: &Device) -> Self {
        let parameters = blueprints(config, inputs, outputs)
            .iter()
            .zip(0..)
            .map(|(blueprint, stream)| Parameter::new(blueprint, seed, stream, device))
            .collect();
        let mut network =
            Self { config: config.clone(), inputs, outputs, device: device.clone(), parameters, pool: None };
        network.pool = network.pool_on(device);
        network
    }

    /// The same network in plain tensor operations on any device: slower, and the reference for the fused kernels.
    #[must_use]
    pub fn plain(&self) -> Self {
        Self { pool: None, ..self.clone() }
    }

    fn pool_on(&self, device: &Device) -> Option<Arc<Pool>> {
        let fused = device.clone().inner() == Device::flex();
        fused.then(|| {
            let shape = Shape { body: self.config.architecture().body(), inputs: self.inputs, outputs: self.outputs };
            Arc::new(Pool::new(Kernel::new(&shape).expect("the configuration is validated")))
        })
    }

    /// The same network on another device, or on the same one with or without autodiff.
    #[must_use]
    pub fn on(&self, device: &Device) -> Self {
        let mut network = self.clone();
        if device.clone().inner() != self.device.clone().inner() {
            network.pool = self.pool_on(device);
        }
        network.set_device(device);
        network.set_values(&self.values());
        network
    }

    /// Where the next values go.
    pub(crate) fn set_device(&mut self, device: &Device) {
        self.device = device.clone();
    }

    /// The kernel, where the network is computed by one.
    pub fn kernel(&self) -> Option<&Kernel> {
        self.pool.as_deref().map(|pool| &pool.kernel)
    }

    /// Prediction at every step.
    ///
    /// # Shapes
    /// inputs `[B,W,C]`, elapsed `[B,W]` in s → `[B,W,O]`
    pub fn forward(&self, inputs: Tensor<3>, elapsed: Tensor<2>) -> Tensor<3> {
        let state = self.initial_state(inputs.dims()[0]);
        self.forward_from(inputs, elapsed, state)
    }

    /// Prediction at every step, from a given state: one [B, width] tensor for each of
    /// [`initial_state`](Self::initial_state).
    pub fn forward_from(&self, inputs: Tensor<3>, elapsed: Tensor<2>, state: Vec<Tensor<2>>) -> Tensor<3> {
        let [batch, length, _] = inputs.dims();
        match &self.pool {
            Some(pool) => self.fused(pool, inputs, elapsed, state, Keep::Every).reshape([batch, length, self.outputs]),
            None => {
                let rows = self.predict(&Steps::new(inputs, elapsed), state, Keep::Every);
                rows.reshape([length, batch, self.outputs]).swap_dims(0, 1)
            }
        }
    }

    /// Prediction at the last step.
    ///
    /// # Shapes
    /// inputs `[B,W,C]`, elapsed `[B,W]` in s → `[B,O]`
    pub fn forward_last(&self, inputs: Tensor<3>, elapsed: Tensor<2>) -> Tensor<2> {
        let state = self.initial_state(inputs.dims()[0]);
        match &self.pool {
            Some(pool) => self.fused(pool, inputs, elapsed, state, Keep::Last),
            None => self.predict(&Steps::new(inputs, elapsed), state, Keep::Last),
        }
    }

    /// The state before the first step: zeros, one tensor for each layer with memory.
    pub fn initial_state(&self, batch: usize) -> Vec<Tensor<2>> {
        let device = self.device.clone().inner();
        let widths = self.config.architecture().state_widths();
        widths.iter().map(|&width| Tensor::zeros([batch, width], &device)).collect()
    }

    fn fused(
        &self,
        pool: &Arc<Pool>,
        inputs: Tensor<3>,
        elapsed: Tensor<2>,
        state: Vec<Tensor<2>>,
        keep: Keep,
    ) -> Tensor<2> {
        let [batch, steps, _] = inputs.dims();
        let flat = |parameter: &Parameter| parameter.tensor.clone().reshape([1, parameter.len()]);
        let parameters = Tensor::cat(self.parameters.iter().map(flat).collect(), 1);
        let state =
            if state.is_empty() { Tensor::empty([0, 1], &self.device.clone().inner()) } else { Tensor::cat(state, 0) };
        let pass = Pass { pool: pool.clone(), batch, steps, keep };
        sequence(parameters, inputs.inner(), elapsed.inner(), state.inner(), pass)
    }

    fn predict(&self, steps: &Steps, state: Vec<Tensor<2>>, keep: Keep) -> Tensor<2> {
        let weights = Weights(&self.parameters);
        let features = self.config.architecture().run(&weights, steps, state, keep);
        linear(&weights, "head", features)
    }

    /// The configuration it was built from.
    pub fn config(&self) -> &NetworkConfig {
        &self.config
    }

    /// C.
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// O.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// Where it lives.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// The parameters in the order of torch's `named_parameters`, the output layer last.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Number of trainable values.
    pub fn parameter_count(&self) -> usize {
        self.parameters.iter().map(Parameter::len).sum()
    }

    /// All values in one row, parameter after parameter.
    pub fn values(&self) -> Vec<f32> {
        self.parameters.iter().flat_map(Parameter::values).collect()
    }

    /// Replaces all values; the reverse of [`values`](Self::values).
    ///
    /// # Panics
    /// If the number of values is not [`parameter_count`](Self::parameter_count).
    pub fn set_values(&mut self, values: &[f32]) {
        assert_eq!(values.len(), self.parameter_count(), "one value for each parameter");
        let mut rest = values;
        for parameter in &mut self.parameters {
            let (own, others) = rest.split_at(parameter.len());
            *parameter = parameter.with_values(own, &self.device);
            rest = others;
        }
    }

    /// The gradient of a loss with respect to [`values`](Self::values), in the same order.
    ///
    /// A parameter that the loss does not depend on has gradient zero.
    pub fn gradient(&self, gradients: &mut Gradients) -> Vec<f32> {
        let gradient = |parameter: &Parameter| match parameter.tensor.grad_remove(gradients) {
            Some(gradient) => read(gradient),
            None => vec![0.0; parameter.len()],
        };
        self.parameters.iter().flat_map(gradient).collect()
    }
}

fn blueprints(config: &NetworkConfig, inputs: usize, outputs: usize) -> Vec<Blueprint> {
    let architecture = config.architecture();
    let mut all = architecture.blueprints(inputs);
    all.extend(Blueprint::linear("head", architecture.features(inputs), outputs));
    all
}
