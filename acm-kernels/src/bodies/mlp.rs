//! Multilayer perceptron: no state, so rows are independent.
//!
//! ```text
//! a_0 = u,   a_l = φ(W_l a_{l−1} + b_l)
//! ```
//!
//! What is a time step to the other bodies is a block of samples here.

use pulp::Simd;

use crate::bodies::layer::{Layer, activate, linear, multiply};
use crate::bodies::network::{Network, Source, Weights, chunks};
use crate::plan::{Gradients, Plan};
use crate::shape::MlpShape;
use crate::tape::Tape;
use crate::vectors::gradient::{Stretches, add_products};
use crate::vectors::product::product;
use crate::vectors::row::Row;

/// A network whose weights have their places.
#[derive(Clone, Debug)]
pub(crate) struct Mlp {
    pub shape: MlpShape,
    /// Width of a_0, a_1, ….
    widths: Vec<usize>,
    pub layers: Vec<Layer>,
}

impl Mlp {
    /// Takes its parameters from the plan in torch's order.
    pub fn new(shape: MlpShape, inputs: usize, plan: &mut Plan) -> Self {
        let widths: Vec<_> = std::iter::once(inputs).chain(shape.hidden.iter().copied()).collect();
        let layers = widths.windows(2).map(|pair| {
            let matrix = linear(plan, pair[0], &[pair[1]]);
            Layer::new(plan, matrix, 1..1 + pair[0])
        });
        let layers = layers.collect();
        Self { shape, widths, layers }
    }
}

/// Activations of one shard.
#[derive(Debug)]
pub(crate) struct Tapes {
    /// Features (1, a_0), (1, a_1), ….
    features: Vec<Tape>,
    /// Slopes of each layer, then derivatives.
    slopes: Vec<Tape>,
    /// Derivatives ∂L/∂a_l.
    derivatives: Vec<Vec<Row>>,
}

impl Network for Mlp {
    type Tapes = Tapes;

    fn tapes(&self) -> Tapes {
        Tapes {
            features: self.widths.iter().map(|width| Tape::with_one(1 + width, 0)).collect(),
            slopes: self.shape.hidden.iter().map(|&width| Tape::new(width)).collect(),
            derivatives: self.widths.iter().map(|&width| vec![Row::ZERO; width]).collect(),
        }
    }

    fn reserve(&self, tapes: &mut Tapes, steps: usize, train: bool) {
        let slots = if train { steps } else { 1 };
        tapes.features.iter_mut().for_each(|tape| tape.reserve(slots));
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
        for step in 0..steps {
            let slot = if TRAIN { step } else { 0 };
            source.inputs(step, &mut tapes.features[0].at_mut(slot)[1..]);
            for (l, layer) in self.layers.iter().enumerate() {
                let (below, here) = tapes.features.split_at_mut(l + 1);
                let a = &mut here[0].at_mut(slot)[1..];
                product::<S, false>(s, weights.forward.at(layer.forward), below[l].at(slot), a);
                let slopes = if TRAIN { tapes.slopes[l].at_mut(slot) } else { &mut [] };
                activate(s, self.shape.activation, a, slopes);
            }
            each(step, tapes.features[self.layers.len()].at(slot));
        }
    }

    #[inline(always)]
    fn backward<S: Simd>(
        &self,
        s: S,
        weights: Weights,
        tapes: &mut Tapes,
        steps: usize,
        _last: impl FnMut(usize, &mut [Row]),
        mut each: impl FnMut(usize, &mut [Row]),
        gradients: &mut Gradients,
    ) {
        let top = self.layers.len();
        for chunk in chunks(steps) {
            for step in chunk.clone() {
                tapes.derivatives[top].fill(Row::ZERO);
                each(step, &mut tapes.derivatives[top]);
                for (l, layer) in self.layers.iter().enumerate().rev() {
                    let (below, here) = tapes.derivatives.split_at_mut(l + 1);
                    let slopes = tapes.slopes[l].at_mut(step);
                    multiply(s, slopes, &here[0]);
                    if l > 0 {
                        product::<S, false>(s, weights.backward.at(layer.backward), slopes, &mut below[l]);
                    }
                }
            }
            for (l, layer) in self.layers.iter().enumerate() {
                let d = tapes.slopes[l].stretches(chunk.start, 0, self.widths[l + 1]);
                let x = tapes.features[l].stretches(chunk.start, 0, 1 + self.widths[l]);
                add_products(s, chunk.len(), d, x, gradients.at(layer.gradient));
            }
        }
    }

    #[inline(always)]
    fn by_inputs<S: Simd>(
        &self,
        s: S,
        weights: Weights,
        tapes: &Tapes,
        steps: usize,
        mut each: impl FnMut(usize, &mut [Row]),
        mut to: impl FnMut(usize, &[Row]),
    ) {
        let mut by_inputs = vec![Row::ZERO; self.widths[0]];
        for step in 0..steps {
            match self.layers.first() {
                Some(layer) => {
                    let d = tapes.slopes[0].at(step);
                    product::<S, false>(s, weights.backward.at(layer.backward), d, &mut by_inputs);
                }
                None => {
                    by_inputs.fill(Row::ZERO);
                    each(step, &mut by_inputs);
                }
            }
            to(step, &by_inputs);
        }
    }

    fn by_state<'a>(&self, _tapes: &'a Tapes, _layer: usize) -> &'a [Row] {
        &[]
    }

    fn last_state<'a>(&self, _tapes: &'a Tapes, _layer: usize, _steps: usize) -> &'a [Row] {
        &[]
    }

    fn features<'a>(&self, tapes: &'a Tapes, step: usize) -> Stretches<'a> {
        let tape = &tapes.features[self.layers.len()];
        tape.stretches(step, 0, tape.width())
    }
}
