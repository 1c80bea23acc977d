//! A whole network over a batch of sequences as one differentiable operation, computed by the fused kernels.
//!
//! | symbol       | meaning                                        | shape            | gradient |
//! | ------------ | ---------------------------------------------- | ---------------- | -------- |
//! | `parameters` | all values in the order of `Network::values`   | [1,P]            | yes      |
//! | `inputs`     | channels of the sequences                      | [B,W,C]          | no       |
//! | `elapsed`    | time since the step before, s                  | [B,W]            | no       |
//! | `state`      | before the first step, layer after layer       | [layers·B,H]     | no       |
//! | result       | predictions at every step, or at the last      | [B·W,O] or [B,O] |          |
//!
//! burn sees a single node with a single parent, so the tape holds one entry however long the sequences are. Buffers
//! come from the [`Pool`] of the network and go back to it when the node is dropped.

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
    /// With no buffer yet.
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

/// Sizes of a batch, and which steps are predicted.
#[derive(Clone, Debug)]
pub struct Pass {
    /// Of the network.
    pub pool: Arc<Pool>,
    /// B.
    pub batch: usize,
    /// W.
    pub steps: usize,
    /// Which steps are predicted.
    pub keep: Keep,
}

/// Predictions; see the head of this file.
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
    /// See the head of this file.
    fn sequence(
        parameters: FloatTensor<Self>,
        inputs: FloatTensor<Self>,
        elapsed: FloatTensor<Self>,
        state: FloatTensor<Self>,
        pass: Pass,
    ) -> FloatTensor<Self>;
}

/// What the way back needs: the arguments, and the buffers with the activations.
struct Passed {
    pass: Pass,
    parameters: Vec<f32>,
    inputs: Vec<f32>,
    elapsed: Vec<f32>,
    state: Vec<f32>,
    work: Mutex<Option<Workspace>>,
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

    /// Predictions by `pass`, one of the kernel's.
    fn predictions(&self, pass: impl Fn(&Kernel, &[f32], &Sequences, &mut Workspace, &mut [f32])) -> FlexTensor {
        let (kernel, sequences) = (&self.pass.pool.kernel, self.sequences());
        let mut predictions = vec![0.0; kernel.predictions(&sequences)];
        if let Some(work) = self.lock().as_mut() {
            pass(kernel, &self.parameters, &sequences, work, &mut predictions);
        }
        let outputs = kernel.shape().outputs;
        tensor(predictions, outputs)
    }

    fn gradient(&self, derivatives: &[f32]) -> Vec<f32> {
        let (kernel, sequences) = (&self.pass.pool.kernel, self.sequences());
        let mut gradient = vec![0.0; kernel.parameters()];
        if let Some(work) = self.lock().as_mut() {
            kernel.backward(&self.parameters, &sequences, derivatives, work, &mut gradient);
        }
        gradient
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
        Passed::new(parameters, inputs, elapsed, state, pass).predictions(Kernel::infer)
    }
}

#[derive(Debug)]
struct SequenceBackward;

impl Backward<Flex, 1> for SequenceBackward {
    type State = Arc<Passed>;

    fn backward(self, ops: Ops<Self::State, 1>, gradients: &mut Gradients, _: &mut Checkpointer) {
        let derivatives = values(gradients.consume::<Flex>(&ops.node));
        let [parent] = ops.parents;
        if let Some(parameters) = parent {
            let gradient = ops.state.gradient(&derivatives);
            let count = gradient.len();
            gradients.register::<Flex>(parameters.id, tensor(gradient, count));
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
        let (parameters, node) = parameters.into_parts();
        let [inputs, elapsed, state] = [inputs, elapsed, state].map(FloatTensor::<Self>::into_primitive);
        let passed = Passed::new(parameters, inputs, elapsed, state, pass);
        match SequenceBackward.prepare::<C>([node]).compute_bound().stateful() {
            OpsKind::Tracked(node) => {
                let predictions = passed.predictions(Kernel::forward);
                node.finish(Arc::new(passed), predictions)
            }
            OpsKind::UnTracked(node) => node.finish(passed.predictions(Kernel::infer)),
        }
    }
}

fn values(tensor: FlexTensor) -> Vec<f32> {
    tensor.into_data().try_to_vec().expect("networks are f32 by construction")
}

/// Rows of `width` values.
fn tensor(values: Vec<f32>, width: usize) -> FlexTensor {
    let rows = values.len() / width;
    FlexTensor::from_data(TensorData::new(values, [rows, width]))
}
