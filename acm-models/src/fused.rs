//! A whole network over a batch of sequences as one differentiable operation, computed by the fused kernels.
//!
//! | symbol       | meaning                                        | shape            | gradient |
//! | ------------ | ---------------------------------------------- | ---------------- | -------- |
//! | `parameters` | all values in torch's order                    | [1,P]            | yes      |
//! | `inputs`     | channels of the sequences                      | [B,W,C]          | yes      |
//! | `elapsed`    | time since the previous step, s                  | [B,W]            | no       |
//! | `state`      | before the first step, layer after layer       | [layers·B,H]     | yes      |
//! | result       | predictions at every step, or at the last; below them, where asked for, the state after the last step | [B·W,O] or [B,O]; [layers·B,H] | |
//!
//! burn sees a single node, so the tape holds one entry however long the sequences are. Buffers come from the [`Pool`] of
//! the network and go back to it when the node is dropped.

use std::sync::{Arc, Mutex, PoisonError};

use acm_kernels::{Keep, Kernel, Sequences, Workspace};
use burn::backend::autodiff::checkpoint::{base::Checkpointer, strategy::CheckpointStrategy};
use burn::backend::autodiff::grads::Gradients;
use burn::backend::autodiff::ops::{Backward, Ops, OpsKind};
use burn::backend::flex::FlexTensor;
use burn::backend::{Autodiff, Backend, Dispatch, Flex, backend_extension, tensor::FloatTensor};
use burn::tensor::{Tensor, TensorData};

/// Kernel of a network, and buffers that are not in use.
pub struct Pool {
    pub(crate) kernel: Kernel,
    free: Mutex<Vec<Workspace>>,
}

impl Pool {
    /// Returns the pool without buffers.
    pub fn new(kernel: Kernel) -> Self {
        Self { kernel, free: Mutex::new(Vec::new()) }
    }

    fn take(&self) -> Workspace {
        self.free.lock().unwrap_or_else(PoisonError::into_inner).pop().unwrap_or_else(|| self.kernel.workspace())
    }

    fn give_back(&self, work: Workspace) {
        self.free.lock().unwrap_or_else(PoisonError::into_inner).push(work);
    }
}

impl std::fmt::Debug for Pool {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Pool").field("kernel", &self.kernel).finish_non_exhaustive()
    }
}

/// Sizes of a batch, and what is asked for.
#[derive(Clone, Debug)]
pub struct Pass {
    /// Sizes of a batch, and the requested results.
    pub pool: Arc<Pool>,
    /// Number of sequences B.
    pub batch: usize,
    /// Number of time steps W.
    pub steps: usize,
    /// Steps that are predicted.
    pub keep: Keep,
    /// Whether the state after the last step is requested. It is then as wide as the predictions.
    pub last: bool,
}

/// Returns the predictions, and the state after the last step; see the head of this file.
pub fn sequence(
    parameters: Tensor<2>,
    inputs: Tensor<3>,
    elapsed: Tensor<2>,
    state: Tensor<2>,
    pass: Pass,
) -> Tensor<2> {
    let (parameters, inputs) = (parameters.into_dispatch(), inputs.into_dispatch());
    Tensor::from_dispatch(Dispatch::sequence(parameters, inputs, elapsed.into_dispatch(), state.into_dispatch(), pass))
}

/// The operation, for burn to find by backend.
#[backend_extension(Flex, Autodiff)]
pub trait SequenceOps: Backend {
    /// Computes the network over a batch of sequences; see the head of this file.
    fn sequence(
        parameters: FloatTensor<Self>,
        inputs: FloatTensor<Self>,
        elapsed: FloatTensor<Self>,
        state: FloatTensor<Self>,
        pass: Pass,
    ) -> FloatTensor<Self>;
}

/// Inputs of the backward pass: the arguments, and the buffers with the activations.
struct Passed {
    pass: Pass,
    parameters: Vec<f32>,
    inputs: Vec<f32>,
    elapsed: Vec<f32>,
    state: Vec<f32>,
    work: Mutex<Option<Workspace>>,
}

/// Derivatives by the tensors that have one.
struct Derivatives {
    parameters: Vec<f32>,
    inputs: Vec<f32>,
    state: Vec<f32>,
}

impl Passed {
    fn new(parameters: FlexTensor, inputs: FlexTensor, elapsed: FlexTensor, state: FlexTensor, pass: Pass) -> Self {
        let [parameters, inputs, elapsed, state] = [parameters, inputs, elapsed, state].map(values);
        let work = Mutex::new(Some(pass.pool.take()));
        Self { pass, parameters, inputs, elapsed, state, work }
    }

    fn sequences(&self) -> Sequences<'_> {
        let Pass { batch, steps, keep, .. } = self.pass;
        let state = (!self.state.is_empty()).then_some(self.state.as_slice());
        Sequences { inputs: &self.inputs, elapsed: &self.elapsed, state, batch, steps, keep }
    }

    /// Returns the predictions. Where the pass is `tracked`, it keeps the buffers that the backward pass needs.
    fn predictions(&self, tracked: bool) -> FlexTensor {
        let (kernel, sequences) = (&self.pass.pool.kernel, self.sequences());
        let mut predictions = vec![0.0; kernel.predictions(&sequences)];
        let mut last = vec![0.0; if self.pass.last { kernel.states(&sequences) } else { 0 }];
        if let Some(work) = self.lock().as_mut() {
            if tracked || self.pass.last {
                kernel.forward(&self.parameters, &sequences, work, &mut predictions);
            } else {
                kernel.infer(&self.parameters, &sequences, work, &mut predictions);
            }
            if self.pass.last {
                kernel.last_state(&sequences, work, &mut last);
            }
        }
        predictions.extend(last);
        let outputs = kernel.shape().outputs;
        tensor([predictions.len() / outputs, outputs], predictions)
    }

    /// Returns the derivatives. `around` states whether derivatives by inputs and state are requested.
    fn derivatives(&self, by_result: &[f32], around: bool) -> Derivatives {
        let (kernel, sequences) = (&self.pass.pool.kernel, self.sequences());
        let (by_predictions, by_last) = by_result.split_at(kernel.predictions(&sequences));
        let by_last = (!by_last.is_empty()).then_some(by_last);
        let zeros = |count: usize| vec![0.0; if around { count } else { 0 }];
        let (mut inputs, mut state) = (zeros(self.inputs.len()), zeros(kernel.states(&sequences)));
        let mut parameters = vec![0.0; kernel.parameters()];
        if let Some(work) = self.lock().as_mut() {
            kernel.backward_from(&self.parameters, &sequences, by_predictions, by_last, work, &mut parameters);
            if around {
                kernel.derivatives(&self.parameters, &sequences, by_predictions, work, &mut inputs, &mut state);
            }
        }
        Derivatives { parameters, inputs, state }
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Option<Workspace>> {
        self.work.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Passed {
    fn drop(&mut self) {
        let work = self.lock().take();
        work.into_iter().for_each(|work| self.pass.pool.give_back(work));
    }
}

impl std::fmt::Debug for Passed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Passed").field("pass", &self.pass).finish_non_exhaustive()
    }
}

impl SequenceOps for Flex {
    fn sequence(
        parameters: FloatTensor<Self>,
        inputs: FloatTensor<Self>,
        elapsed: FloatTensor<Self>,
        state: FloatTensor<Self>,
        pass: Pass,
    ) -> FloatTensor<Self> {
        Passed::new(parameters, inputs, elapsed, state, pass).predictions(false)
    }
}

#[derive(Debug)]
struct SequenceBackward;

impl Backward<Flex, 3> for SequenceBackward {
    type State = Arc<Passed>;

    fn backward(self, ops: Ops<Self::State, 3>, gradients: &mut Gradients, _: &mut Checkpointer) {
        let by_result = values(gradients.consume::<Flex>(&ops.node));
        let [parameters, inputs, state] = ops.parents;
        let passed = &ops.state;
        let Pass { batch, steps, .. } = passed.pass;
        let by = passed.derivatives(&by_result, inputs.is_some() || state.is_some());
        if let Some(parameters) = parameters {
            gradients.register::<Flex>(parameters.id, tensor([1, by.parameters.len()], by.parameters));
        }
        if let Some(inputs) = inputs {
            let channels = by.inputs.len() / (batch * steps);
            gradients.register::<Flex>(inputs.id, tensor([batch, steps, channels], by.inputs));
        }
        if let Some(state) = state {
            let width = passed.pass.pool.kernel.shape().features();
            gradients.register::<Flex>(state.id, tensor([by.state.len() / width, width], by.state));
        }
    }
}

impl<C: CheckpointStrategy> SequenceOps for Autodiff<Flex, C> {
    fn sequence(
        parameters: FloatTensor<Self>,
        inputs: FloatTensor<Self>,
        elapsed: FloatTensor<Self>,
        state: FloatTensor<Self>,
        pass: Pass,
    ) -> FloatTensor<Self> {
        let [(parameters, by_parameters), (inputs, by_inputs), (state, by_state)] =
            [parameters, inputs, state].map(FloatTensor::<Self>::into_parts);
        let passed = Passed::new(parameters, inputs, elapsed.into_primitive(), state, pass);
        match SequenceBackward.prepare::<C>([by_parameters, by_inputs, by_state]).compute_bound().stateful() {
            OpsKind::Tracked(node) => {
                let predictions = passed.predictions(true);
                node.finish(Arc::new(passed), predictions)
            }
            OpsKind::UnTracked(node) => node.finish(passed.predictions(false)),
        }
    }
}

fn values(tensor: FlexTensor) -> Vec<f32> {
    tensor.into_data().try_to_vec().expect("networks are f32 by construction")
}

fn tensor<const D: usize>(shape: [usize; D], values: Vec<f32>) -> FlexTensor {
    FlexTensor::from_data(TensorData::new(values, shape))
}
