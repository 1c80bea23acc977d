//! Reusable buffers of the passes. They grow with the largest batch, and never shrink.

use crate::plan::{Plan, length};
use crate::sequences::{Deal, Sequences};
use crate::shard::{Model, Shard};

/// Largest number of sums of gradients that shards are added into. It follows from the batch alone, not from the
/// threads, and so do the order of additions and each bit of the result.
const MOST_GROUPS: usize = 32;

/// Buffers of a kernel: packed weights, activations, sums of gradients.
pub struct Workspace {
    /// Buffers of each shard, kept from a forward pass to its backward pass.
    pub(crate) shards: Vec<Shard>,
    /// Buffers of each thread, for passes that keep nothing.
    pub(crate) desks: Vec<Desk>,
    pub(crate) forward: Vec<f32>,
    pub(crate) backward: Vec<f32>,
    /// One dense gradient for each group of shards.
    pub(crate) gradients: Vec<f32>,
    /// One loss for each group.
    pub(crate) losses: Vec<f64>,
}

/// A thread's own buffers.
pub(crate) struct Desk {
    pub shard: Shard,
    pub predictions: Vec<f32>,
    pub derivatives: Vec<f32>,
}

/// Returns the number of shards in a group.
pub(crate) fn group(shards: usize) -> usize {
    shards.div_ceil(MOST_GROUPS).max(1)
}

impl Workspace {
    pub(crate) fn new(plan: &Plan) -> Self {
        Self {
            shards: Vec::new(),
            desks: Vec::new(),
            forward: vec![0.0; length(&plan.forward)],
            backward: vec![0.0; length(&plan.backward)],
            gradients: Vec::new(),
            losses: Vec::new(),
        }
    }

    /// Reserves room for the activations of a whole batch.
    pub(crate) fn reserve_shards(&mut self, model: &Model, sequences: &Sequences, deal: &Deal) {
        self.shards.resize_with(self.shards.len().max(deal.shards()), || model.shard());
        let slots = deal.slots(sequences);
        self.shards[..deal.shards()].iter_mut().for_each(|shard| model.reserve(shard, slots, true));
    }

    /// Reserves room for one shard per thread.
    pub(crate) fn reserve_desks(
        &mut self,
        model: &Model,
        sequences: &Sequences,
        deal: &Deal,
        threads: usize,
        train: bool,
    ) {
        let desk = || Desk { shard: model.shard(), predictions: Vec::new(), derivatives: Vec::new() };
        self.desks.resize_with(self.desks.len().max(threads), desk);
        for desk in &mut self.desks[..threads] {
            model.reserve(&mut desk.shard, deal.slots(sequences), train);
            if train && desk.predictions.len() < deal.predictions_per_shard() {
                desk.predictions.resize(deal.predictions_per_shard(), 0.0);
                desk.derivatives.resize(deal.predictions_per_shard(), 0.0);
            }
        }
    }

    /// Reserves room for the sums of gradients and losses, and returns the number of groups.
    pub(crate) fn reserve_groups(&mut self, plan: &Plan, deal: &Deal) -> usize {
        let groups = deal.shards().div_ceil(group(deal.shards()));
        let length = groups * length(&plan.gradients);
        self.gradients.resize(self.gradients.len().max(length), 0.0);
        self.losses.resize(self.losses.len().max(groups), 0.0);
        groups
    }
}
