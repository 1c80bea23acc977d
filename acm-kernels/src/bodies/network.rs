//! Interface of the three bodies, as shards use it.

use pulp::Simd;

use crate::plan::{Gradients, Panels};
use crate::vectors::gradient::{CHUNK, Stretches};
use crate::vectors::row::Row;

/// Inputs of one shard at each step.
pub(crate) trait Source {
    /// Fills the rows of the channels at a step.
    fn inputs(&self, step: usize, rows: &mut [Row]);
    /// Fills the times since the previous step.
    fn elapsed(&self, step: usize, row: &mut Row);
    /// Fills the first state of a layer.
    fn state(&self, layer: usize, rows: &mut [Row]);
}

/// Weights as the passes read them.
#[derive(Clone, Copy)]
pub(crate) struct Weights<'a> {
    /// The flat parameters.
    pub parameters: &'a [f32],
    /// Panels of the forward pass.
    pub forward: Panels<'a>,
    /// Panels of the backward pass.
    pub backward: Panels<'a>,
}

/// A body over one shard of samples.
pub(crate) trait Network {
    /// Activations of a shard.
    type Tapes: Send;

    /// Returns tapes without slots.
    fn tapes(&self) -> Self::Tapes;

    /// Reserves slots for `steps`, or one slot if `TRAIN` is false.
    fn reserve(&self, tapes: &mut Self::Tapes, steps: usize, train: bool);

    /// Runs over the steps and passes the features (1, h) of each to `each`. Where `TRAIN`, tapes keep what the
    /// backward pass needs.
    fn forward<S: Simd, const TRAIN: bool>(
        &self,
        s: S,
        weights: Weights,
        tapes: &mut Self::Tapes,
        steps: usize,
        source: &impl Source,
        each: impl FnMut(usize, &[Row]),
    );

    /// Runs back over the steps. `last` fills ∂L/∂h of a layer after the last step, and `each` adds the external part
    /// of ∂L/∂h of the uppermost layer at a step.
    #[expect(clippy::too_many_arguments, reason = "what a shard has lies in parts that are borrowed apart")]
    fn backward<S: Simd>(
        &self,
        s: S,
        weights: Weights,
        tapes: &mut Self::Tapes,
        steps: usize,
        last: impl FnMut(usize, &mut [Row]),
        each: impl FnMut(usize, &mut [Row]),
        gradients: &mut Gradients,
    );

    /// Passes ∂L/∂u of each step to `to`, after a backward pass whose `each` was the same.
    fn by_inputs<S: Simd>(
        &self,
        s: S,
        weights: Weights,
        tapes: &Self::Tapes,
        steps: usize,
        each: impl FnMut(usize, &mut [Row]),
        to: impl FnMut(usize, &[Row]),
    );

    /// Returns ∂L/∂h of a layer before the first step, after a backward pass.
    fn by_state<'a>(&self, tapes: &'a Self::Tapes, layer: usize) -> &'a [Row];

    /// Returns h of a layer after the last of `steps`, after a forward pass that kept what the backward pass needs.
    fn last_state<'a>(&self, tapes: &'a Self::Tapes, layer: usize, steps: usize) -> &'a [Row];

    /// Returns the features (1, h) that the forward pass left, from `step` on.
    fn features<'a>(&self, tapes: &'a Self::Tapes, step: usize) -> Stretches<'a>;
}

/// Returns stretches of at most [`CHUNK`] steps, of lengths as equal as possible, the last first.
pub(crate) fn chunks(steps: usize) -> impl Iterator<Item = std::ops::Range<usize>> {
    let count = steps.div_ceil(CHUNK);
    (0..count).rev().map(move |i| i * steps / count..(i + 1) * steps / count)
}
