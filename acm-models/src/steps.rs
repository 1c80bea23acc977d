//! A batch of windows, taken apart into time steps before it meets the network.
//!
//! The inputs are cut up off the tape: cutting a tracked tensor once a step would make the way back
//! quadratic in the length of the window. So no gradient reaches the inputs.

use burn::tensor::Tensor;

/// Inputs and elapsed time, one entry for each time step.
#[derive(Clone, Debug)]
pub struct Steps {
    /// Channels at each step, `[B,C]`.
    pub inputs: Vec<Tensor<2>>,
    /// Time since the step before, `[B,1]`, s.
    pub elapsed: Vec<Tensor<2>>,
}

impl Steps {
    /// From inputs `[B,W,C]` and elapsed times `[B,W]`.
    ///
    /// # Panics
    /// If the two disagree on B or W, or if there is no step.
    pub fn new(inputs: Tensor<3>, elapsed: Tensor<2>) -> Self {
        let [batch, length, channels] = inputs.dims();
        assert_eq!(elapsed.dims(), [batch, length], "elapsed times must be [B,W] of the inputs");
        assert!(batch > 0 && length > 0, "a batch needs a window, and a window a step");
        let (inputs, elapsed) = (inputs.inner(), elapsed.inner());
        let step = |t| inputs.clone().narrow(1, t, 1).reshape([batch, channels]);
        Self {
            inputs: (0..length).map(step).collect(),
            elapsed: (0..length).map(|t| elapsed.clone().narrow(1, t, 1)).collect(),
        }
    }

    /// W.
    pub fn len(&self) -> usize {
        self.inputs.len()
    }

    /// Whether there is no step.
    pub fn is_empty(&self) -> bool {
        self.inputs.is_empty()
    }

    /// All inputs as rows, time-major: [W·B, C].
    pub(crate) fn rows(&self) -> Tensor<2> {
        Tensor::cat(self.inputs.clone(), 0)
    }
}
