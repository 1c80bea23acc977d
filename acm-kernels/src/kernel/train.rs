//! Forward and back at once, shard by shard, while a shard's activations are in the cache.

use rayon::prelude::*;

use super::{Kernel, threads};
use crate::plan::{Gradients, length, pack};
use crate::sequences::{Lot, Sequences};
use crate::shard::{Backward, Forward};
use crate::vectors::level::run;
use crate::workspace::{Desk, Workspace, group};

/// Loss of some predictions, with its derivatives; see [`Kernel::train`]. Behind a pointer, so that the passes are compiled once, here.
pub type Loss<'a> = dyn Fn(usize, &[f32], &mut [f32]) -> f64 + Sync + 'a;

impl Kernel {
    /// Returns the loss and its gradient at once: each shard goes forward and back while its activations are in the
    /// cache.
    ///
    /// `loss` gets the place of the first of its predictions among all `[B,O]` or `[B,W,O]`, the predictions,
    /// and as many derivatives to write; it returns its share of the loss. Overwrites `gradient`.
    ///
    /// # Panics
    /// If a slice is not as long as the shapes say.
    pub fn train(
        &self,
        parameters: &[f32],
        sequences: &Sequences,
        loss: &Loss,
        work: &mut Workspace,
        gradient: &mut [f32],
    ) -> f64 {
        let deal = self.check(parameters, sequences);
        let groups = work.reserve_groups(&self.plan, &deal);
        let threads = threads(groups);
        work.reserve_desks(&self.model, sequences, &deal, threads, true);
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
            let gradients = Gradients { list, values };
            run(self.arch, Backward { model, weights, shard, lot, derivatives, last: None, gradients });
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
}
