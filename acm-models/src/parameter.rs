//! Trainable parameters: their names, shapes and first values.
//!
//! Names, order and layout are torch's, so a weight matrix is [outputs, inputs]. First values are
//! uniform on (−bound, bound) with torch's bounds:
//!
//! | layer                     | bound            | source                          |
//! | ------------------------- | ---------------- | ------------------------------- |
//! | linear, weight and bias   | 1/√inputs        | `torch.nn.Linear`               |
//! | Xavier weight             | √(6/(in + out))  | Glorot and Bengio (2010), eq 16 |
//! | recurrent, all parameters | 1/√units         | `torch.nn.GRU`                  |
//!
//! Parameter i draws from stream i of ChaCha8 under the run's seed. Its values depend on nothing
//! else: not on which thread builds the network, nor on which parameter is used first.

use burn::tensor::{Device, Tensor, TensorData};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// What is known of a parameter before it has values.
#[derive(Clone, Debug, PartialEq)]
pub struct Blueprint {
    /// Name in torch's `named_parameters`.
    pub name: String,
    /// Shape in torch: one or two axes.
    pub shape: Vec<usize>,
    /// First values are uniform on (−bound, bound).
    pub bound: f64,
}

impl Blueprint {
    pub(crate) fn new(name: impl Into<String>, shape: &[usize], bound: f64) -> Self {
        Self { name: name.into(), shape: shape.to_vec(), bound }
    }

    /// Weight and bias of `torch.nn.Linear`.
    pub(crate) fn linear(name: &str, inputs: usize, outputs: usize) -> [Self; 2] {
        let bound = 1.0 / (inputs as f64).sqrt();
        [
            Self::new(format!("{name}.weight"), &[outputs, inputs], bound),
            Self::new(format!("{name}.bias"), &[outputs], bound),
        ]
    }

    /// As [`linear`](Self::linear), with Xavier's bound on the weight.
    pub(crate) fn xavier_linear(name: &str, inputs: usize, outputs: usize) -> [Self; 2] {
        let [mut weight, bias] = Self::linear(name, inputs, outputs);
        weight.bound = xavier_bound(inputs, outputs);
        [weight, bias]
    }

    /// Number of values.
    pub fn len(&self) -> usize {
        self.shape.iter().product()
    }

    /// Whether there are no values.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn draw(&self, seed: u64, stream: u64) -> Vec<f32> {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(stream);
        (0..self.len()).map(|_| (self.bound * symmetric(&mut generator)) as f32).collect()
    }
}

/// √(6/(in + out)).
pub(crate) fn xavier_bound(inputs: usize, outputs: usize) -> f64 {
    (6.0 / (inputs + outputs) as f64).sqrt()
}

/// Uniform on [−1, 1) from the top 53 bits.
fn symmetric(generator: &mut ChaCha8Rng) -> f64 {
    (generator.next_u64() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// One trainable tensor. A vector is held as one row, ready to broadcast over a batch.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Name in torch's `named_parameters`.
    pub name: String,
    /// Shape in torch: one or two axes.
    pub shape: Vec<usize>,
    /// The values, [rows, columns].
    pub(crate) tensor: Tensor<2>,
}

impl Parameter {
    /// A parameter with its first values.
    pub(crate) fn new(blueprint: &Blueprint, seed: u64, stream: u64, device: &Device) -> Self {
        Self::from_values(&blueprint.name, &blueprint.shape, blueprint.draw(seed, stream), device)
    }

    fn from_values(name: &str, shape: &[usize], values: Vec<f32>, device: &Device) -> Self {
        let [rows, columns] = match *shape {
            [columns] => [1, columns],
            [rows, columns] => [rows, columns],
            _ => panic!("parameter {name} has {} axes", shape.len()),
        };
        let tensor = Tensor::from_data(TensorData::new(values, [rows, columns]), device);
        let tensor = if device.is_autodiff() { tensor.require_grad() } else { tensor };
        Self { name: name.to_owned(), shape: shape.to_vec(), tensor }
    }

    /// The same parameter with other values.
    pub(crate) fn with_values(&self, values: &[f32], device: &Device) -> Self {
        Self::from_values(&self.name, &self.shape, values.to_vec(), device)
    }

    /// Number of values.
    pub fn len(&self) -> usize {
        self.shape.iter().product()
    }

    /// Whether there are no values.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The values, row by row.
    pub fn values(&self) -> Vec<f32> {
        read(self.tensor.clone().inner())
    }
}

/// A tensor's values, row by row.
pub(crate) fn read(tensor: Tensor<2>) -> Vec<f32> {
    tensor.into_data().try_to_vec().expect("parameters are f32 by construction")
}

/// The parameters by name.
#[derive(Debug)]
pub struct Weights<'a>(pub(crate) &'a [Parameter]);

impl Weights<'_> {
    /// The tensor called `name`, [rows, columns].
    ///
    /// # Panics
    /// If no parameter has that name: a fault in the network's own file.
    pub fn get(&self, name: &str) -> Tensor<2> {
        match self.0.iter().find(|parameter| parameter.name == name) {
            Some(parameter) => parameter.tensor.clone(),
            None => panic!("no parameter is called {name}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a uniform distribution on (−b, b) has standard deviation b/√3.
    #[test]
    fn first_values_fill_their_interval() {
        let [weight, _] = Blueprint::linear("layer", 100, 100);
        let values = weight.draw(7, 0);
        let largest = values.iter().fold(0.0f32, |m, v| m.max(v.abs()));
        let mean = values.iter().map(|&v| f64::from(v)).sum::<f64>() / 1e4;
        let sd = (values.iter().map(|&v| (f64::from(v) - mean).powi(2)).sum::<f64>() / 1e4).sqrt();
        assert!(largest <= 0.1 && largest > 0.0999, "largest {largest}");
        assert!(mean.abs() < 0.002, "mean {mean}");
        assert!((sd - 0.1 / 3f64.sqrt()).abs() < 0.001, "sd {sd}");
    }

    #[test]
    fn streams_and_seeds_differ() {
        let [weight, _] = Blueprint::linear("layer", 4, 4);
        assert_eq!(weight.draw(7, 0), weight.draw(7, 0));
        assert_ne!(weight.draw(7, 0), weight.draw(7, 1));
        assert_ne!(weight.draw(7, 0), weight.draw(8, 0));
    }
}
