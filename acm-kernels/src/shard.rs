//! One shard forward and back, with the linear layer over the body, or without it.
//!
//! ```text
//! p_t = W_head f_t + b_head,   ∂L/∂f_t = W_headᵀ ∂L/∂p_t,   ∂L/∂(W_head, b_head) = Σ_t ∂L/∂p_t (f_t, 1)ᵀ
//! p_t = f_t,                   ∂L/∂f_t = ∂L/∂p_t
//! ```

use pulp::{Simd, WithSimd};

use crate::bodies::body::{AnyBody, AnyTapes};
use crate::bodies::layer::{Layer, add};
use crate::bodies::network::{Network, Weights, chunks};
use crate::plan::Gradients;
use crate::sequences::Lot;
use crate::tape::Tape;
use crate::vectors::gradient::add_products;
use crate::vectors::product::product;
use crate::vectors::row::Row;

/// Activations of one shard, of the body and of the layer over it.
pub(crate) struct Shard {
    body: AnyTapes,
    /// Predictions of one step.
    predictions: Vec<Row>,
    /// Derivatives ∂L/∂p of each step.
    derivatives: Tape,
}

/// Body and head with the places of their weights.
#[derive(Clone, Debug)]
pub(crate) struct Model {
    pub body: AnyBody,
    /// Output layer; none where the features are the predictions.
    pub head: Option<Layer>,
    pub outputs: usize,
}

impl Model {
    /// Returns a shard that has room for no steps yet.
    pub fn shard(&self) -> Shard {
        let predictions = vec![Row::ZERO; self.outputs];
        Shard { body: self.body.tapes(), predictions, derivatives: Tape::new(self.outputs) }
    }

    /// Reserves room for `slots` steps.
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
                let Some(head) = &model.head else { return lot.scatter(slot, &features[1..], predictions) };
                product::<S, false>(s, weights.forward.at(head.forward), features, rows);
                lot.scatter(slot, rows, predictions);
            }
        });
    }
}

/// Returns a function that adds ∂L/∂f of the predicted slots to its argument.
#[inline(always)]
fn from_outside<S: Simd>(
    s: S,
    model: &Model,
    weights: Weights,
    lot: &Lot,
    derivatives: &[f32],
    tape: &mut Tape,
) -> impl FnMut(usize, &mut [Row]) {
    let kept = lot.kept();
    move |slot, by_features| {
        if kept.contains(&slot) {
            lot.gather(slot, derivatives, tape.at_mut(slot));
            match &model.head {
                Some(head) => product::<S, true>(s, weights.backward.at(head.backward), tape.at(slot), by_features),
                None => add(s, by_features, tape.at(slot)),
            }
        }
    }
}

/// The backward pass of a shard: adds its gradient.
pub(crate) struct Backward<'a> {
    pub model: &'a Model,
    pub weights: Weights<'a>,
    pub shard: &'a mut Shard,
    pub lot: Lot<'a>,
    pub derivatives: &'a [f32],
    /// Derivatives ∂L/∂h after the last step, `[layers,B,H]`; zeros if `None`.
    pub last: Option<&'a [f32]>,
    pub gradients: Gradients<'a>,
}

impl WithSimd for Backward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, s: S) {
        let Self { model, weights, shard, lot, derivatives, last, mut gradients } = self;
        let kept = lot.kept();
        let Shard { body, derivatives: tape, .. } = shard;
        let last = |layer: usize, rows: &mut [Row]| lot.gather_state(layer, last, rows);
        let outside = from_outside(s, model, weights, &lot, derivatives, tape);
        model.body.backward(s, weights, body, lot.slots(), last, outside, &mut gradients);
        let Some(head) = &model.head else { return };
        for chunk in chunks(kept.len()) {
            let first = kept.start + chunk.start;
            let d = tape.stretches(first, 0, tape.width());
            let features = model.body.features(body, first);
            add_products(s, chunk.len(), d, features, gradients.at(head.gradient));
        }
    }
}

/// The derivatives of a shard by what it read, after its backward pass.
pub(crate) struct ByInputs<'a> {
    pub model: &'a Model,
    pub weights: Weights<'a>,
    pub shard: &'a mut Shard,
    pub lot: Lot<'a>,
    pub derivatives: &'a [f32],
    /// The shard's own part of `[B,W,C]`.
    pub inputs: &'a mut [f32],
}

impl WithSimd for ByInputs<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, s: S) {
        let Self { model, weights, shard, lot, derivatives, inputs } = self;
        let Shard { body, derivatives: tape, .. } = shard;
        let outside = from_outside(s, model, weights, &lot, derivatives, tape);
        let to = |slot: usize, rows: &[Row]| lot.scatter_inputs(slot, rows, inputs);
        model.body.by_inputs(s, weights, body, lot.slots(), outside, to);
    }
}

impl Shard {
    /// Returns the activations of the shard in the body.
    pub fn body(&self) -> &AnyTapes {
        &self.body
    }
}
