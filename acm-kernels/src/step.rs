//! One sample at a time, for an estimator that runs on a robot.
//!
//! All weights are laid out once; a step allocates nothing, starts no thread and takes the same time for any
//! numbers. It runs the same cells as the batch does, with units in the lanes instead of samples.

mod cfc;
mod gru;
mod mlp;
mod spread;

use pulp::{Simd, WithSimd};

use crate::Kernel;
use crate::bodies::body::AnyBody;
use crate::matrix::Matrix;
use crate::plan::Place;
use crate::vectors::level::run;
use crate::vectors::row::Row;
use spread::{Spread, collect, rows, spread};

/// A network with its weights, its state, and buffers for one step.
#[derive(Clone, Debug)]
pub struct Stepper {
    kernel: Kernel,
    /// Matrices of the forward pass, in the order of their places.
    matrices: Vec<Spread>,
    /// Constants w_τ and A of mode pure.
    constants: [Vec<Row>; 2],
    buffers: Buffers,
}

/// State and scratch.
#[derive(Clone, Debug)]
struct Buffers {
    /// State of each layer.
    state: Vec<Vec<Row>>,
    /// Input of a matrix.
    features: Vec<f32>,
    /// Output of the matrices.
    y: Vec<Row>,
    /// Derivatives ∂h'/∂h, which a batch keeps and a step drops.
    update: Vec<Row>,
}

impl Kernel {
    /// Returns a network for single steps, with the state zero.
    ///
    /// # Panics
    /// If there is not one value for each parameter.
    pub fn stepper(&self, parameters: &[f32]) -> Stepper {
        assert_eq!(parameters.len(), self.parameters(), "one value for each parameter");
        let laid_out = |(place, matrix)| Spread::new(matrix, unit(self, place, matrix), parameters);
        let matrices: Vec<_> =
            self.plan.forward.iter().map(|placed| &placed.matrix).enumerate().map(laid_out).collect();
        let width = rows(self.shape.features());
        let constants = match &self.model.body {
            AnyBody::Cfc(cfc) => cfc.constants(parameters).map(|values| {
                let mut rows = vec![Row::ZERO; width];
                spread(values, &mut rows);
                rows
            }),
            _ => Default::default(),
        };
        let widest = self.plan.forward.iter().map(|placed| placed.matrix.columns).max().unwrap_or(0);
        let buffers = Buffers {
            state: vec![vec![Row::ZERO; width]; self.shape.layers_with_state()],
            features: vec![0.0; widest.max(1 + self.shape.features())],
            y: vec![Row::ZERO; matrices.iter().map(Spread::outputs).max().unwrap_or(0).max(4 * width)],
            update: vec![Row::ZERO; width],
        };
        Stepper { kernel: self.clone(), matrices, constants, buffers }
    }
}

/// Returns the number of rows of a matrix that belong together: the units of one gate, or all of them.
fn unit(kernel: &Kernel, place: Place, matrix: &Matrix) -> usize {
    match &kernel.model.body {
        AnyBody::Cfc(cfc) if place == cfc.maps() => kernel.shape.features(),
        AnyBody::Gru(_) if kernel.model.head.as_ref().is_none_or(|head| place != head.forward) => {
            kernel.shape.features()
        }
        _ => matrix.rows,
    }
}

impl Stepper {
    /// Computes the predictions `[O]` of one step from its channels `[C]` and the time since the previous step in s.
    ///
    /// # Panics
    /// If a slice is not as long as the shape says.
    pub fn step(&mut self, inputs: &[f32], elapsed: f32, predictions: &mut [f32]) {
        assert_eq!(inputs.len(), self.kernel.shape.inputs, "one number for each channel");
        assert_eq!(predictions.len(), self.kernel.shape.outputs, "one number for each prediction");
        run(self.kernel.arch, Step { stepper: self, inputs, elapsed, predictions });
    }

    /// Resets the state to zero, as before the first step.
    pub fn reset(&mut self) {
        self.buffers.state.iter_mut().for_each(|layer| layer.fill(Row::ZERO));
    }

    /// Sets the state, `[layers,H]`.
    ///
    /// # Panics
    /// If it is not as long as the shape says.
    pub fn set_state(&mut self, state: &[f32]) {
        let units = self.kernel.shape.features();
        assert_eq!(state.len(), self.buffers.state.len() * units, "the state must be [layers,H]");
        for (layer, values) in self.buffers.state.iter_mut().zip(state.chunks(units)) {
            spread(values, layer);
        }
    }

    /// Writes the state, `[layers,H]`.
    ///
    /// # Panics
    /// If it is not as long as the shape says.
    pub fn state(&self, state: &mut [f32]) {
        let units = self.kernel.shape.features();
        assert_eq!(state.len(), self.buffers.state.len() * units, "the state must be [layers,H]");
        for (layer, values) in self.buffers.state.iter().zip(state.chunks_mut(units)) {
            collect(layer, values);
        }
    }
}

struct Step<'a> {
    stepper: &'a mut Stepper,
    inputs: &'a [f32],
    elapsed: f32,
    predictions: &'a mut [f32],
}

impl WithSimd for Step<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, s: S) {
        let Stepper { kernel, matrices, constants, buffers } = self.stepper;
        // Each body leaves the features (1, h) of the layer over it.
        let features = match &kernel.model.body {
            AnyBody::Cfc(cfc) => cfc.step(s, matrices, constants, buffers, self.inputs, self.elapsed),
            AnyBody::Gru(gru) => gru.step(s, matrices, buffers, self.inputs),
            AnyBody::Mlp(mlp) => mlp.step(s, matrices, buffers, self.inputs),
        };
        match &kernel.model.head {
            Some(head) => {
                matrices[head.forward].times(s, &buffers.features[..features], &mut buffers.y);
                collect(&buffers.y, self.predictions);
            }
            None => self.predictions.copy_from_slice(&buffers.features[1..features]),
        }
    }
}
