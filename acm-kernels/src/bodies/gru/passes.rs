//! The gated recurrent unit over one shard, forward and back.
//!
//! All layers take a step before the next step begins, so that a pass which keeps nothing needs one slot a layer.

use std::ops::Range;

use pulp::Simd;

use super::{Gru, GruLayer};
use crate::bodies::cell;
use crate::bodies::layer::{forget_vanished, multiply};
use crate::bodies::network::{Network, Source, Weights, chunks};
use crate::plan::Gradients;
use crate::tape::Tape;
use crate::vectors::gradient::{Stretches, add_products};
use crate::vectors::product::product;
use crate::vectors::row::Row;

/// Activations of one layer over one shard.
#[derive(Debug)]
pub(crate) struct LayerTapes {
    /// Inputs (u, 1, h) before each step, and after the last.
    eta: Tape,
    /// Sums y, then slopes, then derivatives.
    y: Tape,
    /// Update gates z.
    update: Tape,
    /// Derivatives ∂L/∂h.
    state: Vec<Row>,
}

impl Network for Gru {
    type Tapes = Vec<LayerTapes>;

    fn tapes(&self) -> Self::Tapes {
        let tapes = |layer: &GruLayer| LayerTapes {
            eta: Tape::with_one(layer.inputs + 1 + self.units, layer.inputs),
            y: Tape::new(4 * self.units),
            update: Tape::new(self.units),
            state: vec![Row::ZERO; self.units],
        };
        self.layers.iter().map(tapes).collect()
    }

    fn reserve(&self, tapes: &mut Self::Tapes, steps: usize, train: bool) {
        let slots = if train { steps } else { 1 };
        for layer in tapes {
            layer.eta.reserve(slots + usize::from(train));
            layer.y.reserve(slots);
            layer.update.reserve(slots);
        }
    }

    #[inline(always)]
    fn forward<S: Simd, const TRAIN: bool>(
        &self,
        s: S,
        weights: Weights,
        tapes: &mut Self::Tapes,
        steps: usize,
        source: &impl Source,
        mut each: impl FnMut(usize, &[Row]),
    ) {
        for (l, (layer, tapes)) in self.layers.iter().zip(tapes.iter_mut()).enumerate() {
            source.state(l, &mut tapes.eta.at_mut(0)[layer.inputs + 1..]);
        }
        for step in 0..steps {
            let (slot, next) = if TRAIN { (step, step + 1) } else { (0, 0) };
            source.inputs(step, &mut tapes[0].eta.at_mut(slot)[..self.inputs]);
            for l in 0..self.layers.len() {
                let (below, here) = tapes.split_at_mut(l);
                let (layer, here) = (&self.layers[l], &mut here[0]);
                if let Some(below) = below.last() {
                    let state = &below.eta.at(next)[self.layers[l - 1].inputs + 1..];
                    here.eta.at_mut(slot)[..self.units].copy_from_slice(state);
                }
                let (x, y) = (here.eta.at(slot), here.y.at_mut(slot));
                let (gates, rest) = y.split_at_mut(2 * self.units);
                let (c, a) = rest.split_at_mut(self.units);
                let forward = |place| weights.forward.at(place);
                product::<S, false>(s, forward(layer.forward.gates), x, gates);
                product::<S, false>(s, forward(layer.forward.state), &x[layer.inputs..], c);
                let state = layer.inputs + 1;
                product::<S, false>(s, forward(layer.forward.input), &x[..state], a);
                if TRAIN {
                    let (before, after) = here.eta.pair_mut(slot);
                    after[state..].copy_from_slice(&before[state..]);
                }
                let h = &mut here.eta.at_mut(next)[state..];
                cell::gru::<S, TRAIN>(s, y, here.update.at_mut(slot), h);
            }
            let top = tapes.len() - 1;
            each(step, &tapes[top].eta.at(next)[self.layers[top].inputs..]);
        }
    }

    #[inline(always)]
    fn backward<S: Simd>(
        &self,
        s: S,
        weights: Weights,
        tapes: &mut Self::Tapes,
        steps: usize,
        mut last: impl FnMut(usize, &mut [Row]),
        mut each: impl FnMut(usize, &mut [Row]),
        gradients: &mut Gradients,
    ) {
        tapes.iter_mut().enumerate().for_each(|(l, tapes)| last(l, &mut tapes.state));
        let top = tapes.len() - 1;
        for chunk in chunks(steps) {
            for step in chunk.clone().rev() {
                each(step, &mut tapes[top].state);
                for (l, layer) in self.layers.iter().enumerate().rev() {
                    let (below, here) = tapes.split_at_mut(l);
                    let LayerTapes { y, update, state, .. } = &mut here[0];
                    forget_vanished(s, state);
                    let y = y.at_mut(step);
                    y.chunks_mut(self.units).for_each(|block| multiply(s, block, state));
                    multiply(s, state, update.at(step));
                    let (gates_and_c, a) = y.split_at(3 * self.units);
                    let backward = |place| weights.backward.at(place);
                    product::<S, true>(s, backward(layer.by_state), gates_and_c, state);
                    if let Some(below) = below.last_mut() {
                        let [gates, input] = layer.by_input.map(backward);
                        product::<S, true>(s, gates, &y[..2 * self.units], &mut below.state);
                        product::<S, true>(s, input, a, &mut below.state);
                    }
                }
            }
            for (layer, tapes) in self.layers.iter().zip(tapes.iter()) {
                self.add_gradients(s, layer, tapes, chunk.clone(), gradients);
            }
        }
    }

    #[inline(always)]
    fn by_inputs<S: Simd>(
        &self,
        s: S,
        weights: Weights,
        tapes: &Self::Tapes,
        steps: usize,
        _each: impl FnMut(usize, &mut [Row]),
        mut to: impl FnMut(usize, &[Row]),
    ) {
        let mut by_inputs = vec![Row::ZERO; self.inputs];
        let [gates, input] = self.layers[0].by_input.map(|place| weights.backward.at(place));
        for step in 0..steps {
            let y = tapes[0].y.at(step);
            product::<S, false>(s, gates, &y[..2 * self.units], &mut by_inputs);
            product::<S, true>(s, input, &y[3 * self.units..], &mut by_inputs);
            to(step, &by_inputs);
        }
    }

    fn by_state<'a>(&self, tapes: &'a Self::Tapes, layer: usize) -> &'a [Row] {
        &tapes[layer].state
    }

    fn last_state<'a>(&self, tapes: &'a Self::Tapes, layer: usize, steps: usize) -> &'a [Row] {
        &tapes[layer].eta.at(steps)[self.layers[layer].inputs + 1..]
    }

    fn features<'a>(&self, tapes: &'a Self::Tapes, step: usize) -> Stretches<'a> {
        let top = tapes.len() - 1;
        tapes[top].eta.stretches(step + 1, self.layers[top].inputs, 1 + self.units)
    }
}

impl Gru {
    /// Adds the products of derivatives and inputs over a stretch of steps.
    #[inline(always)]
    fn add_gradients<S: Simd>(
        &self,
        s: S,
        layer: &GruLayer,
        tapes: &LayerTapes,
        chunk: Range<usize>,
        gradients: &mut Gradients,
    ) {
        let (first, steps, h) = (chunk.start, chunk.len(), self.units);
        let d = |block, blocks| tapes.y.stretches(first, block * h, blocks * h);
        let x = |column, columns| tapes.eta.stretches(first, column, columns);
        let (inputs, places) = (layer.inputs, &layer.gradient);
        add_products(s, steps, d(0, 2), x(0, inputs + 1 + h), gradients.at(places.gates));
        add_products(s, steps, d(2, 1), x(inputs, 1 + h), gradients.at(places.state));
        add_products(s, steps, d(3, 1), x(0, inputs + 1), gradients.at(places.input));
    }
}
