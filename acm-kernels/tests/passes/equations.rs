//! Oracle: the networks in double precision, one sample and one unit at a time, straight from the equations
//! in the documentation of torch and ncps. It shares no code with the crate but the names of its shapes.

use acm_kernels::{Activation, Body, CfcMode, CfcShape, GruShape, Keep, MlpShape, Shape};

/// Hands out the flat parameters in torch's order.
struct Reader<'a>(&'a [f64]);

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> &'a [f64] {
        let (own, rest) = self.0.split_at(count);
        self.0 = rest;
        own
    }

    fn linear(&mut self, inputs: usize, outputs: usize) -> Linear<'a> {
        Linear { weight: self.take(outputs * inputs), bias: self.take(outputs), inputs }
    }
}

struct Linear<'a> {
    weight: &'a [f64],
    bias: &'a [f64],
    inputs: usize,
}

impl Linear<'_> {
    fn at(&self, x: &[f64]) -> Vec<f64> {
        assert_eq!(x.len(), self.inputs);
        let row = |o: usize| {
            let weight = &self.weight[o * self.inputs..(o + 1) * self.inputs];
            self.bias[o] + weight.iter().zip(x).map(|(w, x)| w * x).sum::<f64>()
        };
        (0..self.bias.len()).map(row).collect()
    }
}

fn sigmoid(x: f64) -> f64 {
    1.0 / (1.0 + (-x).exp())
}

/// erf by its Taylor series near zero and by its continued fraction beyond.
pub fn erf(x: f64) -> f64 {
    if x.abs() < 2.5 {
        let (mut term, mut sum) = (x, x);
        for n in 1..80 {
            term *= -x * x / f64::from(n);
            sum += term / f64::from(2 * n + 1);
        }
        return sum * 2.0 / std::f64::consts::PI.sqrt();
    }
    let a = x.abs();
    let fraction = (1..200).rev().fold(a, |rest, n| a + f64::from(n) / 2.0 / rest);
    x.signum() * (1.0 - (-a * a).exp() / (fraction * std::f64::consts::PI.sqrt()))
}

pub fn activation(kind: Activation, x: f64) -> f64 {
    match kind {
        Activation::LecunTanh => 1.7159 * (0.666 * x).tanh(),
        Activation::Tanh => x.tanh(),
        Activation::Relu => x.max(0.0),
        Activation::Silu => x * sigmoid(x),
        Activation::Gelu => x * 0.5 * (1.0 + erf(x / 2f64.sqrt())),
    }
}

/// A batch in double precision.
pub struct Batch {
    pub inputs: Vec<f64>,
    pub elapsed: Vec<f64>,
    pub state: Option<Vec<f64>>,
    pub batch: usize,
    pub steps: usize,
    pub keep: Keep,
}

/// Predictions [B,O] or [B,W,O].
pub fn predictions(shape: &Shape, parameters: &[f64], batch: &Batch) -> Vec<f64> {
    let mut all = Vec::new();
    for b in 0..batch.batch {
        let mut reader = Reader(parameters);
        let features = match &shape.body {
            Body::Cfc(cfc) => cfc_features(cfc, shape.inputs, &mut reader, batch, b),
            Body::Gru(gru) => gru_features(gru, shape.inputs, &mut reader, batch, b),
            Body::Mlp(mlp) => mlp_features(mlp, shape.inputs, &mut reader, batch, b),
        };
        let head = reader.linear(features[0].len(), shape.outputs);
        assert!(reader.0.is_empty(), "all parameters are used");
        let first = if batch.keep == Keep::Last { batch.steps - 1 } else { 0 };
        features[first..].iter().for_each(|features| all.extend(head.at(features)));
    }
    all
}

fn input(batch: &Batch, channels: usize, b: usize, t: usize) -> &[f64] {
    &batch.inputs[(b * batch.steps + t) * channels..][..channels]
}

fn first_state(batch: &Batch, layer: usize, units: usize, b: usize) -> Vec<f64> {
    let start = (layer * batch.batch + b) * units;
    batch.state.as_ref().map_or(vec![0.0; units], |state| state[start..start + units].to_vec())
}

fn cfc_features(shape: &CfcShape, inputs: usize, reader: &mut Reader, batch: &Batch, b: usize) -> Vec<Vec<f64>> {
    let units = shape.units;
    let pure = shape.mode == CfcMode::Pure;
    let (rate, level) = if pure { (reader.take(units), reader.take(units)) } else { (&[][..], &[][..]) };
    let mut width = inputs + units;
    let mut backbone = Vec::new();
    for _ in 0..shape.backbone_layers {
        backbone.push(reader.linear(width, shape.backbone_units));
        width = shape.backbone_units;
    }
    let maps: Vec<_> = (0..if pure { 1 } else { 4 }).map(|_| reader.linear(width, units)).collect();
    let mut h = first_state(batch, 0, units, b);
    let mut all = Vec::new();
    for t in 0..batch.steps {
        let dt = batch.elapsed[b * batch.steps + t];
        let mut x = input(batch, inputs, b, t).to_vec();
        x.extend(&h);
        for layer in &backbone {
            x = layer.at(&x).into_iter().map(|x| activation(shape.activation, x)).collect();
        }
        let y: Vec<_> = maps.iter().map(|map| map.at(&x)).collect();
        h = (0..units)
            .map(|i| match shape.mode {
                CfcMode::Pure => level[i] - level[i] * (-dt * (rate[i].abs() + y[0][i].abs())).exp() * y[0][i],
                mode => {
                    let alpha = sigmoid(y[2][i] * dt + y[3][i]);
                    let first = y[0][i].tanh() * if mode == CfcMode::Default { 1.0 - alpha } else { 1.0 };
                    first + alpha * y[1][i].tanh()
                }
            })
            .collect();
        all.push(h.clone());
    }
    all
}

fn gru_features(shape: &GruShape, inputs: usize, reader: &mut Reader, batch: &Batch, b: usize) -> Vec<Vec<f64>> {
    let units = shape.units;
    let mut x: Vec<Vec<f64>> = (0..batch.steps).map(|t| input(batch, inputs, b, t).to_vec()).collect();
    for l in 0..shape.layers {
        let width = x[0].len();
        let (weight_i, weight_h) = (reader.take(3 * units * width), reader.take(3 * units * units));
        let (bias_i, bias_h) = (reader.take(3 * units), reader.take(3 * units));
        let of_input = Linear { weight: weight_i, bias: bias_i, inputs: width };
        let of_state = Linear { weight: weight_h, bias: bias_h, inputs: units };
        let mut h = first_state(batch, l, units, b);
        for x in &mut x {
            let (i, s) = (of_input.at(x), of_state.at(&h));
            h = (0..units)
                .map(|j| {
                    let r = sigmoid(i[j] + s[j]);
                    let z = sigmoid(i[units + j] + s[units + j]);
                    let n = (i[2 * units + j] + r * s[2 * units + j]).tanh();
                    (1.0 - z) * n + z * h[j]
                })
                .collect();
            x.clone_from(&h);
        }
    }
    x
}

fn mlp_features(shape: &MlpShape, inputs: usize, reader: &mut Reader, batch: &Batch, b: usize) -> Vec<Vec<f64>> {
    let mut layers = Vec::new();
    let mut width = inputs;
    for &hidden in &shape.hidden {
        layers.push(reader.linear(width, hidden));
        width = hidden;
    }
    let features = |t| {
        let first = input(batch, inputs, b, t).to_vec();
        layers
            .iter()
            .fold(first, |x, layer| layer.at(&x).into_iter().map(|x| activation(shape.activation, x)).collect())
    };
    (0..batch.steps).map(features).collect()
}
