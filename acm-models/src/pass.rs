//! A pass of a network over sequences, by the fused operation where it can be and by burn's operations elsewhere.
//!
//! Fused: on flex, burn's device for processors, with every number in single precision, and where no gradient by the
//! elapsed times is requested. Both ways have the same answer, and gradients by parameters, inputs and state.

use std::sync::Arc;

use acm_kernels::{Keep, Kernel};
use burn::module::Module;
use burn::tensor::{DType, Device, Tensor};

use crate::fused::{Pass, Pool, sequence};
use crate::parameters::flat::row;
use crate::steps::Steps;

/// Inputs of a pass.
#[derive(Clone, Debug)]
pub(crate) struct Window {
    /// Channels, `[B,W,C]`.
    pub inputs: Tensor<3>,
    /// Elapsed times, `[B,W]` in s; none for networks that do not use them.
    pub elapsed: Option<Tensor<2>>,
    /// State `[B,H]` of each layer with memory; empty for zeros.
    pub state: Vec<Tensor<2>>,
    /// Steps that are predicted.
    pub keep: Keep,
}

/// Outputs of a pass.
#[derive(Debug)]
pub(crate) struct Answer {
    /// Features of each step that is kept, `[B,W,F]` or `[B,1,F]`.
    pub rows: Tensor<3>,
    /// State of each layer after the last step, `[B,H]`, where it is requested.
    pub last: Vec<Tensor<2>>,
}

/// A network in burn's operations, with the fused operation beside it.
pub(crate) trait Reference: Module {
    /// Returns the fused way, if there is one.
    fn fused(&self) -> &Fused;

    /// Returns the width of the state of each layer with memory.
    fn state_widths(&self) -> Vec<usize>;

    /// Returns the equations: rows of the steps that are kept, `[B,W,F]` or `[B,1,F]`, and the state after the last.
    fn run(&self, steps: &Steps, state: Vec<Tensor<2>>, keep: Keep) -> (Tensor<3>, Vec<Tensor<2>>);
}

/// The kernel of a network; none where burn's operations are selected on every device.
#[derive(Clone, Debug)]
pub(crate) struct Fused(Option<Arc<Pool>>);

impl Fused {
    /// Selects passes by a kernel.
    pub fn new(kernel: Kernel) -> Self {
        Self(Some(Arc::new(Pool::new(kernel))))
    }

    /// Selects passes by burn's operations on every device.
    pub fn none() -> Self {
        Self(None)
    }

    /// Returns the kernel.
    pub fn kernel(&self) -> Option<&Kernel> {
        self.0.as_deref().map(|pool| &pool.kernel)
    }
}

/// Returns the rows and, where `last` is true, the state after the last step.
///
/// # Panics
/// If the shapes do not fit.
pub(crate) fn pass(network: &impl Reference, window: Window, last: bool) -> Answer {
    check(network, &window);
    match fusible(network, &window) {
        Some((pool, parameters)) => by_kernel(network, pool, parameters, window, last),
        None => by_tensors(network, window),
    }
}

fn check(network: &impl Reference, window: &Window) {
    let [batch, length, _] = window.inputs.dims();
    assert!(batch > 0 && length > 0, "a batch needs a sequence, and a sequence a step");
    if let Some(elapsed) = &window.elapsed {
        assert_eq!(elapsed.dims(), [batch, length], "elapsed times must be [B,W] of the inputs");
    }
    if !window.state.is_empty() {
        let expected: Vec<_> = network.state_widths().iter().map(|&width| [batch, width]).collect();
        let found: Vec<_> = window.state.iter().map(Tensor::dims).collect();
        assert_eq!(found, expected, "the state must be [B,H] for each layer");
    }
}

/// Returns buffers and parameters, where the fused operation can be used.
fn fusible<'a>(network: &'a impl Reference, window: &Window) -> Option<(&'a Arc<Pool>, Tensor<2>)> {
    let pool = network.fused().0.as_ref()?;
    let single = |kind: DType| kind == DType::F32;
    let times = window.elapsed.as_ref().is_none_or(|elapsed| single(elapsed.dtype()) && !elapsed.is_tracked());
    let numbers = single(window.inputs.dtype()) && window.state.iter().all(|state| single(state.dtype()));
    if !times || !numbers || window.inputs.device() != Device::flex() {
        return None;
    }
    let parameters = row(network)?;
    let fits = parameters.dims()[1] == pool.kernel.parameters() && parameters.device() == Device::flex();
    fits.then_some((pool, parameters))
}

fn by_kernel(network: &impl Reference, pool: &Arc<Pool>, parameters: Tensor<2>, window: Window, last: bool) -> Answer {
    let Window { inputs, elapsed, state, keep } = window;
    let [batch, steps, channels] = inputs.dims();
    assert_eq!(channels, pool.kernel.shape().inputs, "inputs must have as many channels as the network");
    let nothing = || Tensor::empty([0, 1], &Device::flex());
    let state = if state.is_empty() { nothing() } else { Tensor::cat(state, 0) };
    let pass = Pass { pool: pool.clone(), batch, steps, keep, last };
    let result = sequence(parameters, inputs, elapsed.unwrap_or_else(nothing), state, pass);
    let [_, width] = result.dims();
    let kept = if keep == Keep::Every { steps } else { 1 };
    let layers = if last { network.state_widths().len() } else { 0 };
    let last = (0..layers).map(|l| result.clone().narrow(0, batch * (kept + l), batch)).collect();
    let rows = if layers == 0 { result } else { result.narrow(0, 0, batch * kept) };
    Answer { rows: rows.reshape([batch, kept, width]), last }
}

fn by_tensors(network: &impl Reference, window: Window) -> Answer {
    let Window { inputs, elapsed, state, keep } = window;
    let ([batch, ..], device) = (inputs.dims(), inputs.device().inner());
    let zeros = || network.state_widths().iter().map(|&width| Tensor::zeros([batch, width], &device)).collect();
    let state = if state.is_empty() { zeros() } else { state };
    let (rows, last) = network.run(&Steps::new(inputs, elapsed), state, keep);
    Answer { rows, last }
}

#[cfg(test)]
mod tests {
    use burn::tensor::FloatDType;

    use super::*;
    use crate::{CfcConfig, GruConfig};

    fn window(device: &Device) -> Window {
        let elapsed = Some(Tensor::ones([2, 3], device));
        Window { inputs: Tensor::ones([2, 3, 4], device), elapsed, state: Vec::new(), keep: Keep::Every }
    }

    /// What a user trains with is fused, with tracked inputs and state too.
    #[test]
    fn processors_take_the_fused_operation() {
        for device in [Device::flex(), Device::flex().autodiff()] {
            let cfc = CfcConfig::new(4).init(&device);
            assert!(fusible(&cfc, &window(&device)).is_some());
            let gru = GruConfig::new(4).with_layers(2).init(&device);
            assert!(fusible(&gru, &window(&device)).is_some());
            assert!(fusible(&cfc.plain(), &window(&device)).is_none());
        }
        let device = Device::flex().autodiff();
        let cfc = CfcConfig::new(4).init(&device);
        let inputs = Tensor::ones([2, 3, 4], &device).require_grad();
        assert!(fusible(&cfc, &Window { inputs, ..window(&device) }).is_some());
    }

    #[test]
    fn tracked_times_and_other_precisions_take_burns_operations() {
        let device = Device::flex().autodiff();
        let cfc = CfcConfig::new(4).init(&device);
        let tracked = Window { elapsed: Some(Tensor::ones([2, 3], &device).require_grad()), ..window(&device) };
        assert!(fusible(&cfc, &tracked).is_none());
        let inputs = window(&device).inputs.cast(FloatDType::F64);
        assert!(fusible(&cfc, &Window { inputs, ..window(&device) }).is_none());
    }
}
