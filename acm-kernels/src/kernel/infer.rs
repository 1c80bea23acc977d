//! Forward alone, in the memory of one step of one shard a thread.

use rayon::prelude::*;

use super::{Kernel, threads};
use crate::plan::pack;
use crate::sequences::{Lot, Sequences};
use crate::shard::Forward;
use crate::vectors::level::run;
use crate::workspace::{Desk, Workspace};

impl Kernel {
    /// Computes the predictions `[B,O]` or `[B,W,O]` alone, in little memory.
    ///
    /// # Panics
    /// If a slice is not as long as the shapes say.
    pub fn infer(&self, parameters: &[f32], sequences: &Sequences, work: &mut Workspace, predictions: &mut [f32]) {
        let deal = self.check(parameters, sequences);
        assert_eq!(predictions.len(), deal.predictions(), "one number for each prediction");
        let threads = threads(deal.shards());
        work.reserve_desks(&self.model, sequences, &deal, threads, false);
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
}
