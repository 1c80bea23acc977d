//! One shard forward and back, with the linear layer over the body.
//!
//! ```text
//! p_t = W_head f_t + b_head,   ∂L/∂f_t = W_headᵀ ∂L/∂p_t,   ∂L/∂(W_head, b_head) = Σ_t ∂L/∂p_t (f_t, 1)ᵀ
//! ```

use pulp::{Simd, WithSimd};

use crate::body::{AnyBody, AnyTapes};
use crate::gradient::add_products;
use crate::layer::Layer;
use crate::network::{Network, Weights, chunks};
use crate::plan::Gradients;
use crate::product::product;
use crate::row::Row;
use crate::sequences::Lot;
use crate::tape::Tape;

/// Activations of one shard, of the body and of the layer over it.
pub(crate) struct Shard {
    body: AnyTapes,
    /// Predictions of one step.
    predictions: Vec<Row>,
    /// ∂L/∂p of each step.
    derivatives: Tape,
}

/// Body and head, whose weights have their places.
#[derive(Clone, Debug)]
pub(crate) struct Model {
    pub body: AnyBody,
    pub head: Layer,
    pub outputs: usize,
}

impl Model {
    /// A shard that has room for no steps yet.
    pub fn shard(&self) -> Shard {
        let predictions = vec![Row::ZERO; self.outputs];
        Shard { body: self.body.tapes(), predictions, derivatives: Tape::new(self.outputs) }
    }

    /// Makes sure of room for `slots` steps.
    pub fn reserve(&self, shard: &mut Shard, slots: usize, train: bool) {
        self.body.reserve(&mut shard.body, slots, train);
        if train {
            shard.derivatives.reserve(slots);
        }
    }
}

/// The forward pass of a shard; keeps what the backward pass needs where `TRAIN`.
pub(crate) struct Forward<'a, const TRAIN: bool> {
    pub model: &'a Model,
    pub weights: Weights<'a>,
    pub shard: &'a mut Shard,
    pub lot: Lot<'a>,
    pub predictions: &'a mut [f32],
}

impl<const TRAIN: bool> WithSimd for Forward<'_, TRAIN> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, s: S) {
        let Self { model, weights, shard, lot, predictions } = self;
        let kept = lot.kept();
        let rows = &mut shard.predictions;
        model.body.forward::<S, TRAIN>(s, weights, &mut shard.body, lot.slots(), &lot, |slot, features| {
            if kept.contains(&slot) {
                product::<S, false>(s, weights.forward.at(model.head.forward), features, rows);
                lot.scatter(slot, rows, predictions);
            }
        });
    }
}

/// The backward pass of a shard: adds its gradient.
pub(crate) struct Backward<'a> {
    pub model: &'a Model,
    pub weights: Weights<'a>,
    pub shard: &'a mut Shard,
    pub lot: Lot<'a>,
    pub derivatives: &'a [f32],
    pub gradients: Gradients<'a>,
}

impl WithSimd for Backward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, s: S) {
        let Self { model, weights, shard, lot, derivatives, mut gradients } = self;
        let kept = lot.kept();
        let Shard { body, derivatives: tape, .. } = shard;
        let outside = |slot: usize, by_features: &mut [Row]| {
            if kept.contains(&slot) {
                lot.gather(slot, derivatives, tape.at_mut(slot));
                product::<S, true>(s, weights.backward.at(model.head.backward), tape.at(slot), by_features);
            }
        };
        model.body.backward(s, weights, body, lot.slots(), outside, &mut gradients);
        for chunk in chunks(kept.len()) {
            let first = kept.start + chunk.start;
            let d = tape.stretches(first, 0, tape.width());
            let features = model.body.features(body, first);
            add_products(s, chunk.len(), d, features, gradients.at(model.head.gradient));
        }
    }
}
