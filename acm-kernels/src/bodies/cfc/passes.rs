//! The closed-form network over one shard, forward and back.
//!
//! The tape of y does three duties, one after the other: sums y, slopes ∂h'/∂y, derivatives ∂L/∂y. That of the
//! backbone's slopes does the last two.

use std::ops::Range;

use pulp::Simd;

use super::Cfc;
use crate::bodies::cell;
use crate::bodies::layer::{activate, forget_vanished, multiply};
use crate::bodies::network::{Network, Source, Weights, chunks};
use crate::plan::Gradients;
use crate::shape::CfcMode;
use crate::tape::Tape;
use crate::vectors::gradient::{Stretches, add_products};
use crate::vectors::product::product;
use crate::vectors::row::Row;

/// Activations of one shard.
#[derive(Debug)]
pub(crate) struct Tapes {
    /// Inputs (u, 1, h) before each step, and after the last.
    eta: Tape,
    elapsed: Tape,
    /// Features (1, features) after each backbone layer.
    backbone: Vec<Tape>,
    /// Slopes of the backbone layers, then derivatives.
    slopes: Vec<Tape>,
    /// Sums y, then slopes, then derivatives.
    y: Tape,
    /// Derivatives ∂L/∂h.
    state: Vec<Row>,
    /// Derivatives ∂L/∂ψ.
    features: Vec<Row>,
}

impl Network for Cfc {
    type Tapes = Tapes;

    fn tapes(&self) -> Tapes {
        let (units, width) = (self.shape.units, self.shape.backbone_units);
        let blocks = if self.pure.is_some() { 3 } else { 4 };
        Tapes {
            eta: Tape::with_one(self.inputs + 1 + units, self.inputs),
            elapsed: Tape::new(1),
            backbone: self.backbone.iter().map(|_| Tape::with_one(1 + width, 0)).collect(),
            slopes: self.backbone.iter().map(|_| Tape::new(width)).collect(),
            y: Tape::new(blocks * units),
            state: vec![Row::ZERO; units],
            features: vec![Row::ZERO; width],
        }
    }

    fn reserve(&self, tapes: &mut Tapes, steps: usize, train: bool) {
        let slots = if train { steps } else { 1 };
        tapes.eta.reserve(slots + usize::from(train));
        tapes.elapsed.reserve(slots);
        tapes.y.reserve(slots);
        tapes.backbone.iter_mut().for_each(|tape| tape.reserve(slots));
        if train {
            tapes.slopes.iter_mut().for_each(|tape| tape.reserve(slots));
        }
    }

    #[inline(always)]
    fn forward<S: Simd, const TRAIN: bool>(
        &self,
        s: S,
        weights: Weights,
        tapes: &mut Tapes,
        steps: usize,
        source: &impl Source,
        mut each: impl FnMut(usize, &[Row]),
    ) {
        let state = self.inputs + 1;
        source.state(0, &mut tapes.eta.at_mut(0)[state..]);
        for step in 0..steps {
            let (slot, next) = if TRAIN { (step, step + 1) } else { (0, 0) };
            source.inputs(step, &mut tapes.eta.at_mut(slot)[..self.inputs]);
            source.elapsed(step, &mut tapes.elapsed.at_mut(slot)[0]);
            let mut x = tapes.eta.at(slot);
            for (l, (layer, tape)) in self.backbone.iter().zip(&mut tapes.backbone).enumerate() {
                let features = tape.at_mut(slot);
                product::<S, false>(s, weights.forward.at(layer.forward), x, &mut features[1..]);
                let slopes = if TRAIN { tapes.slopes[l].at_mut(slot) } else { &mut [] };
                activate(s, self.shape.activation, &mut features[1..], slopes);
                x = features;
            }
            let y = tapes.y.at_mut(slot);
            product::<S, false>(s, weights.forward.at(self.maps.forward), x, &mut y[..self.sums]);
            let (elapsed, h) = (&tapes.elapsed.at(slot)[0], &mut tapes.eta.at_mut(next)[state..]);
            match &self.pure {
                None if self.shape.mode == CfcMode::Default => cell::gated::<S, TRAIN, true>(s, y, elapsed, h),
                None => cell::gated::<S, TRAIN, false>(s, y, elapsed, h),
                Some(pure) => {
                    let (rate, level) = (&weights.parameters[pure.rate..], &weights.parameters[pure.level..]);
                    let constant = |unit: usize, _: usize| (s.splat_f32s(rate[unit]), s.splat_f32s(level[unit]));
                    cell::pure::<S, TRAIN>(s, y, elapsed, constant, h);
                }
            }
            each(step, &tapes.eta.at(next)[self.inputs..]);
        }
    }

    #[inline(always)]
    fn backward<S: Simd>(
        &self,
        s: S,
        weights: Weights,
        tapes: &mut Tapes,
        steps: usize,
        mut last: impl FnMut(usize, &mut [Row]),
        mut each: impl FnMut(usize, &mut [Row]),
        gradients: &mut Gradients,
    ) {
        last(0, &mut tapes.state);
        for chunk in chunks(steps) {
            for step in chunk.clone().rev() {
                each(step, &mut tapes.state);
                forget_vanished(s, &mut tapes.state);
                let y = tapes.y.at_mut(step);
                for block in y.chunks_mut(self.shape.units) {
                    multiply(s, block, &tapes.state);
                }
                let mut d = &y[..self.sums];
                let mut above = self.maps.backward;
                for (layer, slopes) in self.backbone.iter().zip(&mut tapes.slopes).rev() {
                    product::<S, false>(s, weights.backward.at(above), d, &mut tapes.features);
                    let slopes = slopes.at_mut(step);
                    multiply(s, slopes, &tapes.features);
                    (d, above) = (slopes, layer.backward);
                }
                product::<S, false>(s, weights.backward.at(above), d, &mut tapes.state);
            }
            self.add_gradients(s, tapes, chunk, gradients);
        }
    }

    #[inline(always)]
    fn by_inputs<S: Simd>(
        &self,
        s: S,
        weights: Weights,
        tapes: &Tapes,
        steps: usize,
        _each: impl FnMut(usize, &mut [Row]),
        mut to: impl FnMut(usize, &[Row]),
    ) {
        let mut by_inputs = vec![Row::ZERO; self.inputs];
        for step in 0..steps {
            let d = tapes.slopes.first().map_or(&tapes.y.at(step)[..self.sums], |slopes| slopes.at(step));
            product::<S, false>(s, weights.backward.at(self.by_input), d, &mut by_inputs);
            to(step, &by_inputs);
        }
    }

    fn by_state<'a>(&self, tapes: &'a Tapes, _layer: usize) -> &'a [Row] {
        &tapes.state
    }

    fn last_state<'a>(&self, tapes: &'a Tapes, _layer: usize, steps: usize) -> &'a [Row] {
        &tapes.eta.at(steps)[self.inputs + 1..]
    }

    fn features<'a>(&self, tapes: &'a Tapes, step: usize) -> Stretches<'a> {
        tapes.eta.stretches(step + 1, self.inputs, 1 + self.shape.units)
    }
}

impl Cfc {
    /// Adds the products of derivatives and inputs over a stretch of steps.
    #[inline(always)]
    fn add_gradients<S: Simd>(&self, s: S, tapes: &Tapes, chunk: Range<usize>, gradients: &mut Gradients) {
        let (first, steps) = (chunk.start, chunk.len());
        let mut x = &tapes.eta;
        for (l, layer) in self.backbone.iter().enumerate() {
            let d = tapes.slopes[l].stretches(first, 0, self.shape.backbone_units);
            add_products(s, steps, d, x.stretches(first, 0, x.width()), gradients.at(layer.gradient));
            x = &tapes.backbone[l];
        }
        let d = tapes.y.stretches(first, 0, self.sums);
        add_products(s, steps, d, x.stretches(first, 0, x.width()), gradients.at(self.maps.gradient));
        if let Some(pure) = &self.pure {
            let d = tapes.y.stretches(first, self.shape.units, 2 * self.shape.units);
            add_products(s, steps, d, x.stretches(first, self.one(), 1), gradients.at(pure.gradient));
        }
    }
}
