//! The passes over a batch, and how they are spread over threads.
//!
//! | pass       | keeps                  | memory                     |
//! | ---------- | ---------------------- | -------------------------- |
//! | `forward`  | activations, for `backward` | of the whole batch    |
//! | `train`    | nothing: each shard goes forward and back at once | of one shard a thread |
//! | `infer`    | nothing                | of one step of one shard a thread |
//!
//! After `forward` and `backward`, `last_state` and `derivatives` tell what a caller with layers below or pieces before
//! and after needs.
//!
//! Threads are those of the current rayon pool. Shards, groups of shards and the order in which their
//! gradients are added follow from the batch alone, so any number of threads gives the same bits.

mod apart;
mod around;
mod infer;
mod train;

pub use train::Loss;

use pulp::Arch;

use crate::bodies::body::AnyBody;
use crate::bodies::layer::{Layer, linear};
use crate::bodies::network::Weights;
use crate::plan::{Panels, Plan, length};
use crate::sequences::{Deal, Sequences};
use crate::shape::{Body, BuildError, Shape};
use crate::shard::Model;
use crate::vectors::level::Level;
use crate::workspace::Workspace;

/// A network's passes, for one shape and one set of vector instructions. It holds no weights.
#[derive(Clone, Debug)]
pub struct Kernel {
    pub(crate) shape: Shape,
    pub(crate) plan: Plan,
    pub(crate) model: Model,
    pub(crate) arch: Arch,
    level: Level,
}

impl Kernel {
    /// Returns the kernel of a network, with the best vector instructions that this processor has.
    ///
    /// # Errors
    /// If a size is zero.
    pub fn new(shape: &Shape) -> Result<Self, BuildError> {
        Self::with_level(shape, Level::best())
    }

    /// Returns the kernel with vector instructions of the caller's choice.
    ///
    /// # Errors
    /// If a size is zero, or if the processor lacks the instructions.
    pub fn with_level(shape: &Shape, level: Level) -> Result<Self, BuildError> {
        Self::build(shape, level, true)
    }

    /// Returns the kernel without a linear layer: predictions are the [`features`](Shape::features) of `body`.
    ///
    /// # Errors
    /// If a size is zero, or if nothing is left to compute: a perceptron without hidden layers.
    pub fn without_head(body: &Body, inputs: usize) -> Result<Self, BuildError> {
        let shape = Shape { body: body.clone(), inputs, outputs: 1 };
        let kernel = Self::build(&Shape { outputs: shape.features(), ..shape }, Level::best(), false)?;
        if kernel.parameters() == 0 { Err(BuildError::Size { field: "hidden layers" }) } else { Ok(kernel) }
    }

    fn build(shape: &Shape, level: Level, with_head: bool) -> Result<Self, BuildError> {
        shape.validate()?;
        let arch = level.arch().ok_or(BuildError::Level { level })?;
        let mut plan = Plan::default();
        let body = AnyBody::new(shape, &mut plan);
        let head = with_head.then(|| {
            let matrix = linear(&mut plan, shape.features(), &[shape.outputs]);
            Layer::new(&mut plan, matrix, 1..1 + shape.features())
        });
        let model = Model { body, head, outputs: shape.outputs };
        Ok(Self { shape: shape.clone(), plan, model, arch, level })
    }

    /// Returns the vector instructions of the kernel.
    pub fn level(&self) -> Level {
        self.level
    }

    /// Returns the shape of the network.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Returns the number of parameters.
    pub fn parameters(&self) -> usize {
        self.plan.parameters
    }

    /// Returns the number of predictions that a pass over `sequences` makes.
    pub fn predictions(&self, sequences: &Sequences) -> usize {
        Deal::new(&self.shape, sequences).predictions()
    }

    /// Returns empty buffers.
    pub fn workspace(&self) -> Workspace {
        Workspace::new(&self.plan)
    }

    /// Returns the packed weights as the passes read them.
    fn weights<'a>(&'a self, parameters: &'a [f32], forward: &'a [f32], backward: &'a [f32]) -> Weights<'a> {
        Weights {
            parameters,
            forward: Panels { list: &self.plan.forward, values: forward },
            backward: Panels { list: &self.plan.backward, values: backward },
        }
    }

    /// Adds the groups up in their order, and writes the sum to `gradient` in the order of the parameters.
    fn unpack(&self, groups: &mut [f32], gradient: &mut [f32]) {
        assert_eq!(gradient.len(), self.parameters(), "one number for each parameter");
        let (sum, others) = groups.split_at_mut(length(&self.plan.gradients));
        for other in others.chunks(sum.len()) {
            sum.iter_mut().zip(other).for_each(|(sum, other)| *sum += other);
        }
        gradient.fill(0.0);
        for placed in &self.plan.gradients {
            placed.matrix.unpack(placed.of(sum), gradient);
        }
    }

    fn check(&self, parameters: &[f32], sequences: &Sequences) -> Deal {
        let Sequences { inputs, elapsed, state, batch, steps, .. } = *sequences;
        assert!(batch > 0 && steps > 0, "a batch needs a sequence, and a sequence a step");
        assert_eq!(parameters.len(), self.parameters(), "one value for each parameter");
        assert_eq!(inputs.len(), batch * steps * self.shape.inputs, "inputs must be [B,W,C]");
        if matches!(self.shape.body, Body::Cfc(_)) {
            assert_eq!(elapsed.len(), batch * steps, "elapsed times must be [B,W]");
        }
        if let Some(state) = state {
            assert_eq!(state.len(), self.shape.layers_with_state() * batch * self.shape.features(), "[layers,B,H]");
        }
        Deal::new(&self.shape, sequences)
    }
}

/// Returns the number of threads for `jobs`.
fn threads(jobs: usize) -> usize {
    if jobs == 1 { 1 } else { rayon::current_num_threads().min(jobs) }
}
