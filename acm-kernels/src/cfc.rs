//! Closed-form continuous-time network. Hasani et al. (2022), Nature Machine Intelligence 4.
//!
//! ```text
//! η = (u, 1, h),   ψ = (1, backbone(η)), or η without a backbone,   y = M ψ = (N_1, N_2, N_a, N_b)
//!
//! default   h' = (1 − α) a + α b,   a = tanh N_1,   b = tanh N_2,   α = σ(N_a Δt + N_b)
//! no_gate   h' = a + α b
//! pure      h' = A − A exp(−Δt (|w_τ| + |N_1|)) N_1
//! ```
//!
//! | symbol   | meaning                           | rows  | unit |
//! | -------- | --------------------------------- | ----- | ---- |
//! | `u`      | inputs                            | C     | –    |
//! | `h, h'`  | state before and after            | H     | –    |
//! | `Δt`     | time since the step before        | 1     | s    |
//! | `w_τ, A` | decay rate, level (mode pure)     | H     | 1/s, – |
//!
//! The tape of y does three duties, one after the other: sums y, slopes ∂h'/∂y, derivatives ∂L/∂y.

use pulp::Simd;

use crate::cell;
use crate::gradient::{Stretches, add_products};
use crate::layer::{Layer, activate, linear, multiply};
use crate::matrix::Matrix;
use crate::network::{Network, Source, Weights, chunks};
use crate::plan::{Gradients, Place, Plan};
use crate::product::product;
use crate::row::Row;
use crate::shape::{CfcMode, CfcShape};
use crate::tape::Tape;

/// A network whose weights have their places.
#[derive(Clone, Debug)]
pub(crate) struct Cfc {
    pub shape: CfcShape,
    pub inputs: usize,
    pub backbone: Vec<Layer>,
    pub maps: Layer,
    /// Rows of y that are sums.
    sums: usize,
    pub pure: Option<Pure>,
}

/// Parameters of mode pure that no input multiplies.
#[derive(Clone, Debug)]
pub(crate) struct Pure {
    /// First parameter of w_τ.
    pub rate: usize,
    /// First parameter of A.
    pub level: usize,
    /// Both, as columns under the feature that is one: rows A, then w_τ.
    gradient: Place,
}

impl Cfc {
    /// Takes its parameters from the plan in torch's order.
    pub fn new(shape: CfcShape, inputs: usize, plan: &mut Plan) -> Self {
        let (units, width) = (shape.units, shape.backbone_units);
        let pure = (shape.mode == CfcMode::Pure).then(|| {
            let (rate, level) = (plan.parameters(units), plan.parameters(units));
            let matrix = Matrix::new(2 * units, 1).with(0..units, 0..1, level, 1).with(units..2 * units, 0..1, rate, 1);
            Pure { rate, level, gradient: plan.gradient(matrix) }
        });
        let state = inputs + 1..inputs + 1 + units;
        let backbone = (0..shape.backbone_layers).map(|l| {
            if l == 0 {
                let matrix = over_inputs_and_state(plan, inputs, units, &[width]);
                return Layer::new(plan, matrix, state.clone());
            }
            let matrix = linear(plan, width, width);
            Layer::new(plan, matrix, 1..1 + width)
        });
        let backbone: Vec<_> = backbone.collect();
        let maps = if pure.is_some() { vec![units] } else { vec![units; 4] };
        let sums = maps.iter().sum();
        let maps = if backbone.is_empty() {
            let matrix = over_inputs_and_state(plan, inputs, units, &maps);
            Layer::new(plan, matrix, state)
        } else {
            let matrix = stacked(plan, width, &maps);
            Layer::new(plan, matrix, 1..1 + width)
        };
        Self { shape, inputs, backbone, maps, sums, pure }
    }

    /// The feature of ψ that is one.
    fn one(&self) -> usize {
        if self.backbone.is_empty() { self.inputs } else { 0 }
    }
}

/// Linear layers over torch's (u, h), one below the other, on features (u, 1, h).
fn over_inputs_and_state(plan: &mut Plan, inputs: usize, units: usize, outputs: &[usize]) -> Matrix {
    let mut matrix = Matrix::new(outputs.iter().sum(), inputs + 1 + units);
    let mut row = 0;
    for &outputs in outputs {
        let (weight, rows) = (plan.parameters(outputs * (inputs + units)), row..row + outputs);
        let bias = plan.parameters(outputs);
        matrix = matrix
            .with(rows.clone(), 0..inputs, weight, inputs + units)
            .with(rows.clone(), inputs..inputs + 1, bias, 1)
            .with(rows, inputs + 1..inputs + 1 + units, weight + inputs, inputs + units);
        row += outputs;
    }
    matrix
}

/// Linear layers over (1, x), one below the other.
fn stacked(plan: &mut Plan, inputs: usize, outputs: &[usize]) -> Matrix {
    let mut matrix = Matrix::new(outputs.iter().sum(), 1 + inputs);
    let mut row = 0;
    for &outputs in outputs {
        let (weight, rows) = (plan.parameters(outputs * inputs), row..row + outputs);
        let bias = plan.parameters(outputs);
        matrix = matrix.with(rows.clone(), 0..1, bias, 1).with(rows, 1..1 + inputs, weight, inputs);
        row += outputs;
    }
    matrix
}

/// Activations of one shard.
#[derive(Debug)]
pub(crate) struct Tapes {
    /// (u, 1, h) before each step, and after the last.
    eta: Tape,
    elapsed: Tape,
    /// (1, features) after each backbone layer.
    backbone: Vec<Tape>,
    /// Slopes of the backbone layers, then derivatives.
    slopes: Vec<Tape>,
    /// Sums, slopes, derivatives.
    y: Tape,
    /// ∂L/∂h.
    state: Vec<Row>,
    /// ∂L/∂ψ.
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
        mut each: impl FnMut(usize, &mut [Row]),
        gradients: &mut Gradients,
    ) {
        tapes.state.fill(Row::ZERO);
        for chunk in chunks(steps) {
            for step in chunk.clone().rev() {
                each(step, &mut tapes.state);
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

    fn features<'a>(&self, tapes: &'a Tapes, step: usize) -> Stretches<'a> {
        tapes.eta.stretches(step + 1, self.inputs, 1 + self.shape.units)
    }
}

impl Cfc {
    /// Products of derivatives and inputs over a stretch of steps.
    #[inline(always)]
    fn add_gradients<S: Simd>(&self, s: S, tapes: &Tapes, chunk: std::ops::Range<usize>, gradients: &mut Gradients) {
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
