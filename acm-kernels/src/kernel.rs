//! The passes over a batch, and how they are spread over threads.
//!
//! | pass       | keeps                  | memory                     |
//! | ---------- | ---------------------- | -------------------------- |
//! | `forward`  | activations, for `backward` | of the whole batch    |
//! | `train`    | nothing: each shard goes forward and back at once | of one shard a thread |
//! | `infer`    | nothing                | of one step of one shard a thread |
//!
//! Threads are those of the current rayon pool. Shards, groups of shards and the order in which their
//! gradients are added follow from the batch alone, so any number of threads gives the same bits.

use pulp::Arch;
use rayon::prelude::*;

use crate::body::AnyBody;
use crate::layer::{Layer, linear};
use crate::level::{Level, run};
use crate::plan::{Gradients, Panels, Plan, length, pack};
use crate::sequences::{Deal, Lot};
use crate::shape::{Body, BuildError, Shape};
use crate::shard::{Backward, Forward, Model};
use crate::workspace::{Desk, Workspace, group};
use crate::{Sequences, network::Weights};

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
    /// With the best vector instructions that this processor has.
    ///
    /// # Errors
    /// If a size is zero.
    pub fn new(shape: &Shape) -> Result<Self, BuildError> {
        Self::with_level(shape, Level::best())
    }

    /// With vector instructions of the caller's choice.
    ///
    /// # Errors
    /// If a size is zero, or if the processor lacks the instructions.
    pub fn with_level(shape: &Shape, level: Level) -> Result<Self, BuildError> {
        shape.validate()?;
        let arch = level.arch().ok_or(BuildError::Level { level })?;
        let mut plan = Plan::default();
        let body = AnyBody::new(shape, &mut plan);
        let matrix = linear(&mut plan, shape.features(), shape.outputs);
        let head = Layer::new(&mut plan, matrix, 1..1 + shape.features());
        let model = Model { body, head, outputs: shape.outputs };
        Ok(Self { shape: shape.clone(), plan, model, arch, level })
    }

    /// Its vector instructions.
    pub fn level(&self) -> Level {
        self.level
    }

    /// Its network.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Number of parameters.
    pub fn parameters(&self) -> usize {
        self.plan.parameters
    }

    /// Predictions that a pass over `sequences` makes.
    pub fn predictions(&self, sequences: &Sequences) -> usize {
        Deal::new(&self.shape, sequences).predictions()
    }

    /// Empty buffers.
    pub fn workspace(&self) -> Workspace {
        Workspace::new(self)
    }

    /// Predictions [B,O] or [B,W,O]; keeps the activations in `work`.
    ///
    /// # Panics
    /// If a slice is not as long as the shapes say.
    pub fn forward(&self, parameters: &[f32], sequences: &Sequences, work: &mut Workspace, predictions: &mut [f32]) {
        let deal = self.check(parameters, sequences);
        assert_eq!(predictions.len(), deal.predictions(), "one number for each prediction");
        work.reserve_shards(self, sequences, &deal);
        pack(&self.plan.forward, parameters, &mut work.forward);
        let weights = self.weights(parameters, &work.forward, &[]);
        let jobs = (&mut work.shards[..deal.shards()], predictions);
        let forward = |(i, (shard, predictions)): (usize, (&mut _, &mut [f32]))| {
            let lot = Lot::new(&self.shape, sequences, &deal, i);
            run(self.arch, Forward::<true> { model: &self.model, weights, shard, lot, predictions });
        };
        let per_shard = deal.predictions_per_shard();
        if threads(deal.shards()) == 1 {
            jobs.0.iter_mut().zip(jobs.1.chunks_mut(per_shard)).enumerate().for_each(forward);
        } else {
            jobs.0.par_iter_mut().zip(jobs.1.par_chunks_mut(per_shard)).enumerate().for_each(forward);
        }
    }

    /// Gradient by the parameters, from the derivatives of a loss by the predictions that
    /// [`forward`](Self::forward) made last with the same arguments. Overwrites `gradient`.
    ///
    /// # Panics
    /// If a slice is not as long as the shapes say, or `work` has not been through such a forward pass.
    pub fn backward(
        &self,
        parameters: &[f32],
        sequences: &Sequences,
        derivatives: &[f32],
        work: &mut Workspace,
        gradient: &mut [f32],
    ) {
        let deal = self.check(parameters, sequences);
        assert_eq!(derivatives.len(), deal.predictions(), "one number for each prediction");
        assert!(work.shards.len() >= deal.shards(), "a forward pass comes first");
        let groups = work.reserve_groups(self, &deal);
        pack(&self.plan.backward, parameters, &mut work.backward);
        let weights = self.weights(parameters, &[], &work.backward);
        let (per_group, dense, list) = (group(deal.shards()), length(&self.plan.gradients), &self.plan.gradients);
        let backward = |(g, (shards, sums)): (usize, (&mut [_], &mut [f32]))| {
            sums.fill(0.0);
            for (i, shard) in shards.iter_mut().enumerate() {
                let lot = Lot::new(&self.shape, sequences, &deal, g * per_group + i);
                let start = (g * per_group + i) * deal.predictions_per_shard();
                let derivatives = &derivatives[start..][..lot.count() * deal.per_sample];
                let gradients = Gradients { list, values: &mut *sums };
                run(self.arch, Backward { model: &self.model, weights, shard, lot, derivatives, gradients });
            }
        };
        let (shards, sums) = (&mut work.shards[..deal.shards()], &mut work.gradients[..groups * dense]);
        if threads(groups) == 1 {
            shards.chunks_mut(per_group).zip(sums.chunks_mut(dense)).enumerate().for_each(backward);
        } else {
            shards.par_chunks_mut(per_group).zip(sums.par_chunks_mut(dense)).enumerate().for_each(backward);
        }
        self.unpack(&mut work.gradients[..groups * dense], gradient);
    }

    /// Loss and its gradient at once: each shard goes forward and back while its activations are in the cache.
    ///
    /// `loss` gets the place of the first of its predictions among all [B,O] or [B,W,O], the predictions,
    /// and as many derivatives to write; it returns its share of the loss. Overwrites `gradient`.
    ///
    /// # Panics
    /// If a slice is not as long as the shapes say.
    pub fn train(
        &self,
        parameters: &[f32],
        sequences: &Sequences,
        loss: impl Fn(usize, &[f32], &mut [f32]) -> f64 + Sync,
        work: &mut Workspace,
        gradient: &mut [f32],
    ) -> f64 {
        let deal = self.check(parameters, sequences);
        let groups = work.reserve_groups(self, &deal);
        let threads = threads(groups);
        work.reserve_desks(self, sequences, &deal, threads, true);
        pack(&self.plan.forward, parameters, &mut work.forward);
        pack(&self.plan.backward, parameters, &mut work.backward);
        let weights = self.weights(parameters, &work.forward, &work.backward);
        let (dense, list) = (length(&self.plan.gradients), &self.plan.gradients);

        let one_shard = |desk: &mut Desk, i: usize, values: &mut [f32]| {
            let lot = Lot::new(&self.shape, sequences, &deal, i);
            let count = lot.count() * deal.per_sample;
            let Desk { shard, predictions, derivatives } = desk;
            let (predictions, derivatives) = (&mut predictions[..count], &mut derivatives[..count]);
            let (model, weights) = (&self.model, weights);
            run(self.arch, Forward::<true> { model, weights, shard, lot, predictions });
            let loss = loss(i * deal.predictions_per_shard(), predictions, derivatives);
            run(self.arch, Backward { model, weights, shard, lot, derivatives, gradients: Gradients { list, values } });
            loss
        };
        // The shards of a group one after the other, the groups of a desk one after the other.
        let (per_group, per_desk) = (group(deal.shards()), groups.div_ceil(threads));
        let one_desk = |(d, (desk, (sums, losses))): (usize, (&mut Desk, (&mut [f32], &mut [f64])))| {
            for (g, (sums, total)) in sums.chunks_mut(dense).zip(losses).enumerate() {
                let first = (d * per_desk + g) * per_group;
                sums.fill(0.0);
                *total = (first..deal.shards().min(first + per_group)).map(|i| one_shard(desk, i, sums)).sum();
            }
        };
        let desks = &mut work.desks[..threads];
        let (sums, losses) = (&mut work.gradients[..groups * dense], &mut work.losses[..groups]);
        if threads == 1 {
            desks.iter_mut().zip([(sums, losses)]).enumerate().for_each(one_desk);
        } else {
            let parts = sums.par_chunks_mut(per_desk * dense).zip(losses.par_chunks_mut(per_desk));
            desks.par_iter_mut().zip(parts).enumerate().for_each(one_desk);
        }
        self.unpack(&mut work.gradients[..groups * dense], gradient);
        work.losses[..groups].iter().sum()
    }

    /// Predictions [B,O] or [B,W,O] alone, in little memory.
    ///
    /// # Panics
    /// If a slice is not as long as the shapes say.
    pub fn infer(&self, parameters: &[f32], sequences: &Sequences, work: &mut Workspace, predictions: &mut [f32]) {
        let deal = self.check(parameters, sequences);
        assert_eq!(predictions.len(), deal.predictions(), "one number for each prediction");
        let threads = threads(deal.shards());
        work.reserve_desks(self, sequences, &deal, threads, false);
        pack(&self.plan.forward, parameters, &mut work.forward);
        let weights = self.weights(parameters, &work.forward, &[]);
        let per_desk = deal.shards().div_ceil(threads);
        let infer = |(d, (desk, predictions)): (usize, (&mut Desk, &mut [f32]))| {
            for (i, predictions) in predictions.chunks_mut(deal.predictions_per_shard()).enumerate() {
                let lot = Lot::new(&self.shape, sequences, &deal, d * per_desk + i);
                let shard = &mut desk.shard;
                run(self.arch, Forward::<false> { model: &self.model, weights, shard, lot, predictions });
            }
        };
        let desks = &mut work.desks[..threads];
        if threads == 1 {
            desks.iter_mut().zip([predictions]).enumerate().for_each(infer);
        } else {
            let parts = predictions.par_chunks_mut(per_desk * deal.predictions_per_shard());
            desks.par_iter_mut().zip(parts).enumerate().for_each(infer);
        }
    }

    fn weights<'a>(&'a self, parameters: &'a [f32], forward: &'a [f32], backward: &'a [f32]) -> Weights<'a> {
        Weights {
            parameters,
            forward: Panels { list: &self.plan.forward, values: forward },
            backward: Panels { list: &self.plan.backward, values: backward },
        }
    }

    /// Adds the groups up in their order, and hands the sum to the caller in the order of the parameters.
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

/// Threads that `jobs` are worth.
fn threads(jobs: usize) -> usize {
    if jobs == 1 { 1 } else { rayon::current_num_threads().min(jobs) }
}
