//! Networks and batches that the tests walk over: every mode, activation and depth, odd sizes, one of everything.

use acm_kernels::{Activation, Body, CfcMode, CfcShape, GruShape, Keep, MlpShape, Sequences, Shape};

use crate::equations::Batch;

/// A network, a batch, and a loss Σ k_i p_i.
pub struct Case {
    pub shape: Shape,
    pub parameters: Vec<f32>,
    pub inputs: Vec<f32>,
    pub elapsed: Vec<f32>,
    pub state: Option<Vec<f32>>,
    pub batch: usize,
    pub steps: usize,
    pub keep: Keep,
}

/// Reproducible numbers in (−1, 1) without a pattern: the fractional parts of multiples of √root.
pub fn noise(count: usize, root: f64) -> Vec<f32> {
    (1..=count).map(|i| (2.0 * (i as f64 * root.sqrt()).fract() - 1.0) as f32).collect()
}

impl Case {
    pub fn new(shape: Shape, batch: usize, steps: usize, keep: Keep, given_state: bool) -> Self {
        let count = acm_kernels::Kernel::new(&shape).expect("sizes are positive").parameters();
        let states = shape.layers_with_state() * batch * shape.features();
        Self {
            parameters: noise(count, 5.0).iter().map(|p| 0.6 * p).collect(),
            inputs: noise(batch * steps * shape.inputs, 2.0),
            elapsed: noise(batch * steps, 3.0).iter().map(|t| 0.5 + 0.4 * t).collect(),
            state: given_state.then(|| noise(states, 7.0)),
            shape,
            batch,
            steps,
            keep,
        }
    }

    pub fn sequences(&self) -> Sequences<'_> {
        Sequences {
            inputs: &self.inputs,
            elapsed: &self.elapsed,
            state: self.state.as_deref(),
            batch: self.batch,
            steps: self.steps,
            keep: self.keep,
        }
    }

    pub fn in_double(&self) -> Batch {
        let double = |values: &[f32]| values.iter().map(|&v| f64::from(v)).collect::<Vec<_>>();
        Batch {
            inputs: double(&self.inputs),
            elapsed: double(&self.elapsed),
            state: self.state.as_deref().map(double),
            batch: self.batch,
            steps: self.steps,
            keep: self.keep,
        }
    }

    /// ∂L/∂p, the k_i.
    pub fn derivatives(&self) -> Vec<f32> {
        let kept = if self.keep == Keep::Last { 1 } else { self.steps };
        noise(self.batch * kept * self.shape.outputs, 11.0)
    }

    pub fn name(&self) -> String {
        let state = if self.state.is_some() { "given" } else { "zero" };
        format!("{:?} batch {} steps {} {:?} state {state}", self.shape, self.batch, self.steps, self.keep)
    }
}

fn cfc(units: usize, mode: CfcMode, width: usize, layers: usize, activation: Activation) -> Body {
    Body::Cfc(CfcShape { units, mode, backbone_units: width, backbone_layers: layers, activation })
}

/// Bodies small enough that each parameter can be moved.
pub fn bodies() -> Vec<Body> {
    let mut all = Vec::new();
    for mode in [CfcMode::Default, CfcMode::NoGate, CfcMode::Pure] {
        all.push(cfc(5, mode, 7, 0, Activation::Tanh));
        all.push(cfc(5, mode, 7, 1, Activation::LecunTanh));
        all.push(cfc(4, mode, 3, 2, Activation::Silu));
    }
    all.extend(Activation::ALL.map(|activation| cfc(3, CfcMode::Default, 6, 1, activation)));
    all.push(cfc(1, CfcMode::Default, 1, 1, Activation::LecunTanh));
    all.push(cfc(13, CfcMode::Default, 3, 1, Activation::LecunTanh));
    for (units, layers) in [(5, 1), (3, 2), (4, 3), (1, 1), (13, 1)] {
        all.push(Body::Gru(GruShape { units, layers }));
    }
    all.extend(Activation::ALL.map(|activation| Body::Mlp(MlpShape { hidden: vec![6, 5], activation })));
    for hidden in [vec![], vec![1], vec![13]] {
        all.push(Body::Mlp(MlpShape { hidden, activation: Activation::Tanh }));
    }
    all
}

/// Bodies wider than a vector, a row, a panel; too many parameters to move each.
pub fn wide_bodies() -> Vec<Body> {
    vec![
        cfc(37, CfcMode::Default, 45, 2, Activation::LecunTanh),
        cfc(32, CfcMode::Default, 64, 1, Activation::LecunTanh),
        cfc(40, CfcMode::NoGate, 5, 0, Activation::Tanh),
        cfc(70, CfcMode::Pure, 33, 1, Activation::Gelu),
        Body::Gru(GruShape { units: 37, layers: 2 }),
        Body::Gru(GruShape { units: 66, layers: 1 }),
        Body::Mlp(MlpShape { hidden: vec![70, 33], activation: Activation::Tanh }),
    ]
}

/// The wide bodies, each with one batch.
pub fn wide_cases() -> Vec<Case> {
    let case = |(i, body)| {
        let keep = if i % 2 == 0 { Keep::Last } else { Keep::Every };
        let mut case = Case::new(Shape { body, inputs: 5, outputs: 3 }, 35, 8, keep, i % 3 == 0);
        case.parameters.iter_mut().for_each(|p| *p *= 0.4);
        case
    };
    wide_bodies().into_iter().enumerate().map(case).collect()
}

/// Every body with batches below, at and above a shard, one step and more steps than a chunk.
pub fn cases() -> Vec<Case> {
    let mut all = Vec::new();
    for (i, body) in bodies().into_iter().enumerate() {
        let sizes = [(1, 1), (3, 6), (32, 2), (33, 3), (2, 35)];
        for (j, &(batch, steps)) in sizes.iter().enumerate() {
            let (inputs, outputs) = [(1, 1), (3, 2), (4, 3)][(i + j) % 3];
            let keep = if (i + j) % 2 == 0 { Keep::Last } else { Keep::Every };
            let shape = Shape { body: body.clone(), inputs, outputs };
            all.push(Case::new(shape, batch, steps, keep, (i / 2 + j) % 2 == 0));
        }
    }
    all
}
