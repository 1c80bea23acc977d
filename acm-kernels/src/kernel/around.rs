//! State after a pass, and derivatives by its inputs.
//!
//! | symbol    | meaning                             | shape            |
//! | --------- | ----------------------------------- | ---------------- |
//! | `h_W`     | state after the last step           | `[layers,B,H]`   |
//! | `∂L/∂u`   | derivative by the inputs            | `[B,W,C]`        |
//! | `∂L/∂h_0` | derivative by the first state       | `[layers,B,H]`   |
//!
//! Both are read from the activations that the passes leave, so training without them pays nothing for them.

use rayon::prelude::*;

use super::{Kernel, threads};
use crate::bodies::network::Network;
use crate::sequences::{Deal, Lot, Sequences};
use crate::shard::{ByInputs, Shard};
use crate::vectors::level::run;
use crate::vectors::row::Row;
use crate::workspace::Workspace;

impl Kernel {
    /// Returns the length of the state of all layers over `sequences`.
    pub fn states(&self, sequences: &Sequences) -> usize {
        self.shape.layers_with_state() * sequences.batch * self.shape.features()
    }

    /// Writes the state after the last step, `[layers,B,H]`, that [`forward`](Self::forward) reached last with
    /// `sequences`.
    ///
    /// # Panics
    /// If `state` is not as long as the shape says, or `work` has not been through such a forward pass.
    pub fn last_state(&self, sequences: &Sequences, work: &Workspace, state: &mut [f32]) {
        self.scatter_states(sequences, work, state, |shard, layer| {
            self.model.body.last_state(shard.body(), layer, sequences.steps)
        });
    }

    /// Computes the derivatives of the loss by the inputs and by the first state, after [`backward`](Self::backward)
    /// with the same arguments.
    ///
    /// # Panics
    /// If a slice is not as long as the shapes say, or `work` has not been through such a backward pass.
    pub fn derivatives(
        &self,
        parameters: &[f32],
        sequences: &Sequences,
        derivatives: &[f32],
        work: &mut Workspace,
        inputs: &mut [f32],
        state: &mut [f32],
    ) {
        let deal = self.check(parameters, sequences);
        assert_eq!(derivatives.len(), deal.predictions(), "one number for each prediction");
        assert_eq!(inputs.len(), sequences.inputs.len(), "one number for each input");
        assert!(work.shards.len() >= deal.shards(), "a backward pass comes first");
        inputs.fill(0.0);
        let weights = self.weights(parameters, &[], &work.backward);
        let by_inputs = |(i, (shard, inputs)): (usize, (&mut Shard, &mut [f32]))| {
            let lot = Lot::new(&self.shape, sequences, &deal, i);
            let derivatives = &derivatives[i * deal.predictions_per_shard()..][..lot.count() * deal.per_sample];
            run(self.arch, ByInputs { model: &self.model, weights, shard, lot, derivatives, inputs });
        };
        let shards = &mut work.shards[..deal.shards()];
        let per_shard = deal.places_per_shard(sequences) * self.shape.inputs;
        if threads(deal.shards()) == 1 {
            shards.iter_mut().zip(inputs.chunks_mut(per_shard)).enumerate().for_each(by_inputs);
        } else {
            shards.par_iter_mut().zip(inputs.par_chunks_mut(per_shard)).enumerate().for_each(by_inputs);
        }
        self.scatter_states(sequences, work, state, |shard, layer| self.model.body.by_state(shard.body(), layer));
    }

    fn scatter_states<'a>(
        &self,
        sequences: &Sequences,
        work: &'a Workspace,
        state: &mut [f32],
        rows: impl Fn(&'a Shard, usize) -> &'a [Row],
    ) {
        let deal = Deal::new(&self.shape, sequences);
        assert_eq!(state.len(), self.states(sequences), "the state must be [layers,B,H]");
        assert!(work.shards.len() >= deal.shards(), "a pass comes first");
        for (i, shard) in work.shards[..deal.shards()].iter().enumerate() {
            let lot = Lot::new(&self.shape, sequences, &deal, i);
            for layer in 0..self.shape.layers_with_state() {
                lot.scatter_state(layer, rows(shard, layer), state);
            }
        }
    }
}
