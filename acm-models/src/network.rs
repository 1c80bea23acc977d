//! A network with its weights: the recurrent or feed-forward body, and the linear output layer.
//!
//! ```text
//! prediction = W_head · features + b_head
//! ```

use acm_kernels::{Keep, Kernel};
use burn::module::Module;
use burn::nn::Linear;
use burn::tensor::{Device, Gradients, Tensor};

use crate::networks::{AnyBody, NetworkConfig};
use crate::parameters::first_values::{FirstRule, FirstValues};
use crate::parameters::flat::{Parameter, gradient, numbers, parameters, row, with_values};
use crate::pass::{Fused, Reference, Window, pass};
use crate::steps::Steps;

/// A network on a device. On a device with autodiff its parameters are tracked.
#[derive(Module, Debug)]
pub struct Network {
    /// Body of the network; it computes the features.
    pub body: AnyBody,
    /// The linear layer over them.
    pub head: Linear,
    #[module(skip)]
    config: NetworkConfig,
    #[module(skip)]
    inputs: usize,
    #[module(skip)]
    parameters: Vec<Parameter>,
    /// Fused operation of body and head.
    #[module(skip)]
    fused: Fused,
}

impl Network {
    /// Returns a new network for `inputs` channels and `outputs` predictions; its first values follow from `seed`
    /// alone. On flex, burn's device for processors, it is computed by the fused kernels.
    ///
    /// # Panics
    /// If the configuration was not validated.
    pub fn new(config: &NetworkConfig, inputs: usize, outputs: usize, seed: u64, device: &Device) -> Self {
        Self::by(FirstRule::Torch, config, inputs, outputs, seed, device)
    }

    /// Returns a new network as [`new`](Self::new), with first values by `rule`.
    ///
    /// # Panics
    /// If the configuration was not validated.
    pub fn by(
        rule: FirstRule,
        config: &NetworkConfig,
        inputs: usize,
        outputs: usize,
        seed: u64,
        device: &Device,
    ) -> Self {
        let shape = config.shape(inputs, outputs);
        let mut first = FirstValues::by(rule, seed, device);
        let body = config.build(inputs, &mut first);
        let head = first.linear(shape.features(), outputs);
        let mut list = parameters(&body);
        let named = |parameter: Parameter| Parameter { name: format!("head.{}", parameter.name), ..parameter };
        list.extend(parameters(&head).into_iter().map(named));
        let fused = Fused::new(Kernel::new(&shape).expect("the configuration is validated"));
        Self { body, head, config: config.clone(), inputs, parameters: list, fused }
    }

    /// Returns the network in burn's operations on every device: slower on CPUs, and the reference for the fused
    /// operation.
    #[must_use]
    pub fn plain(&self) -> Self {
        Self { fused: Fused::none(), ..self.clone() }
    }

    /// Copies the network to another device, or to the same device with or without autodiff.
    #[must_use]
    pub fn on(&self, device: &Device) -> Self {
        self.with_values(&self.values(), device)
    }

    /// Copies the network with other parameter values to a device.
    pub(crate) fn with_values(&self, values: &[f32], device: &Device) -> Self {
        assert_eq!(values.len(), self.parameter_count(), "one value for each parameter");
        with_values(self.clone(), values, device)
    }

    /// Returns the kernel, where the network is computed by one.
    pub fn kernel(&self) -> Option<&Kernel> {
        self.fused.kernel().filter(|_| self.device() == Device::flex())
    }

    /// Returns the prediction at every step.
    ///
    /// # Shapes
    /// - inputs: `[B,W,C]`
    /// - elapsed: `[B,W]`, time since the previous step in s
    /// - result: `[B,W,O]`
    ///
    /// # Panics
    /// If the shapes do not fit.
    pub fn forward(&self, inputs: Tensor<3>, elapsed: Tensor<2>) -> Tensor<3> {
        self.forward_from(inputs, elapsed, Vec::new())
    }

    /// Returns the prediction at every step, from a given state: one `[B,H]` tensor for each of
    /// [`initial_state`](Self::initial_state), or none for zeros.
    ///
    /// # Shapes
    /// As [`forward`](Self::forward).
    ///
    /// # Panics
    /// If the shapes do not fit.
    pub fn forward_from(&self, inputs: Tensor<3>, elapsed: Tensor<2>, state: Vec<Tensor<2>>) -> Tensor<3> {
        pass(self, Window { inputs, elapsed: Some(elapsed), state, keep: Keep::Every }, false).rows
    }

    /// Returns the prediction at the last step.
    ///
    /// # Shapes
    /// - inputs: `[B,W,C]`
    /// - elapsed: `[B,W]`, time since the previous step in s
    /// - result: `[B,O]`
    ///
    /// # Panics
    /// If the shapes do not fit.
    pub fn forward_last(&self, inputs: Tensor<3>, elapsed: Tensor<2>) -> Tensor<2> {
        let window = Window { inputs, elapsed: Some(elapsed), state: Vec::new(), keep: Keep::Last };
        pass(self, window, false).rows.squeeze_dim(1)
    }

    /// Returns the state before the first step: zeros, one tensor for each layer with memory.
    pub fn initial_state(&self, batch: usize) -> Vec<Tensor<2>> {
        let device = self.device().inner();
        self.state_widths().iter().map(|&width| Tensor::zeros([batch, width], &device)).collect()
    }

    /// Returns the configuration that it was built from.
    pub fn config(&self) -> &NetworkConfig {
        &self.config
    }

    /// Returns the number of channels C.
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// Returns the number of predictions O.
    pub fn outputs(&self) -> usize {
        self.head.weight.shape()[1]
    }

    /// Returns the device of the parameters.
    pub fn device(&self) -> Device {
        self.head.weight.val().device()
    }

    /// Names and shapes of the parameters in the order of torch's `named_parameters`, the output layer last.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Returns the number of trainable values.
    pub fn parameter_count(&self) -> usize {
        self.parameters.iter().map(Parameter::len).sum()
    }

    /// Returns all values in one row, parameter after parameter, each in torch's layout.
    ///
    /// # Panics
    /// If a parameter has been quantized, adapted or given another precision.
    pub fn values(&self) -> Vec<f32> {
        numbers(row(self).expect("networks are f32 by construction").inner())
    }

    /// Replaces all values; the reverse of [`values`](Self::values).
    ///
    /// # Panics
    /// If the number of values is not [`parameter_count`](Self::parameter_count).
    pub fn set_values(&mut self, values: &[f32]) {
        *self = self.with_values(values, &self.device());
    }

    /// Returns the gradient of a loss with respect to [`values`](Self::values), in the same order.
    ///
    /// A parameter that the loss does not depend on has gradient zero.
    pub fn gradient(&self, gradients: &mut Gradients) -> Vec<f32> {
        gradient(self, gradients)
    }
}

impl Reference for Network {
    fn fused(&self) -> &Fused {
        &self.fused
    }

    fn state_widths(&self) -> Vec<usize> {
        self.body.state_widths()
    }

    fn run(&self, steps: &Steps, state: Vec<Tensor<2>>, keep: Keep) -> (Tensor<3>, Vec<Tensor<2>>) {
        let (features, last) = self.body.run(steps, state, keep);
        (self.head.forward(features), last)
    }
}
