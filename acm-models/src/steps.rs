//! A batch of sequences, split into time steps.
//!
//! Inputs that no gradient is asked for are cut up off the tape: cutting a tracked tensor once a step makes the way back
//! quadratic in the length of the sequence.

use burn::tensor::Tensor;

/// Inputs and elapsed time, one entry for each time step.
#[derive(Clone, Debug)]
pub(crate) struct Steps {
    /// Channels at each step, `[B,C]`.
    pub inputs: Vec<Tensor<2>>,
    /// Time since the previous step, `[B,1]`, s; empty for networks that do not ask for it.
    pub elapsed: Vec<Tensor<2>>,
}

impl Steps {
    /// Returns the steps of inputs `[B,W,C]` and elapsed times `[B,W]`.
    pub fn new(inputs: Tensor<3>, elapsed: Option<Tensor<2>>) -> Self {
        let [batch, length, channels] = inputs.dims();
        let inputs = if inputs.is_tracked() { inputs } else { inputs.inner() };
        let step = |t| inputs.clone().narrow(1, t, 1).reshape([batch, channels]);
        let elapsed = elapsed.map(|elapsed| if elapsed.is_tracked() { elapsed } else { elapsed.inner() });
        let times = |elapsed: Tensor<2>| (0..length).map(|t| elapsed.clone().narrow(1, t, 1)).collect();
        Self { inputs: (0..length).map(step).collect(), elapsed: elapsed.map(times).unwrap_or_default() }
    }
}
