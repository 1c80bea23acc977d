//! Forward and backward as two calls, for a caller whose loss lies elsewhere, such as an operation of a tensor
//! library. The activations of the whole batch are kept in between.

use rayon::prelude::*;

use super::{Kernel, threads};
use crate::plan::{Gradients, length, pack};
use crate::sequences::{Lot, Sequences};
use crate::shard::{Backward, Forward};
use crate::vectors::level::run;
use crate::workspace::{Workspace, group};

impl Kernel {
    /// Computes the predictions `[B,O]` or `[B,W,O]`; keeps the activations in `work`.
    ///
    /// # Panics
    /// If a slice is not as long as the shapes say.
    pub fn forward(&self, parameters: &[f32], sequences: &Sequences, work: &mut Workspace, predictions: &mut [f32]) {
        let deal = self.check(parameters, sequences);
        assert_eq!(predictions.len(), deal.predictions(), "one number for each prediction");
        work.reserve_shards(&self.model, sequences, &deal);
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

    /// Computes the gradient by the parameters, from the derivatives of a loss by the predictions that
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
        self.backward_from(parameters, sequences, derivatives, None, work, gradient);
    }

    /// Computes the gradient as [`backward`](Self::backward) does, of a loss that depends on the state after the last
    /// step as well: `last` holds its derivatives by that, `[layers,B,H]`.
    ///
    /// # Panics
    /// As [`backward`](Self::backward).
    pub fn backward_from(
        &self,
        parameters: &[f32],
        sequences: &Sequences,
        derivatives: &[f32],
        last: Option<&[f32]>,
        work: &mut Workspace,
        gradient: &mut [f32],
    ) {
        let deal = self.check(parameters, sequences);
        assert_eq!(derivatives.len(), deal.predictions(), "one number for each prediction");
        assert!(last.is_none_or(|last| last.len() == self.states(sequences)), "the state must be [layers,B,H]");
        assert!(work.shards.len() >= deal.shards(), "a forward pass comes first");
        let groups = work.reserve_groups(&self.plan, &deal);
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
                run(self.arch, Backward { model: &self.model, weights, shard, lot, derivatives, last, gradients });
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
}
