//! Initial values of trainable parameters.
//!
//! They are uniform on (−bound, bound):
//!
//! | rule    | layer                     | bound            | source                          |
//! | ------- | ------------------------- | ---------------- | ------------------------------- |
//! | `Torch` | linear, weight and bias   | 1/√inputs        | `torch.nn.Linear`               |
//! |         | Xavier weight             | √(6/(in + out))  | Glorot and Bengio (2010), eq 16 |
//! |         | recurrent, all parameters | 1/√units         | `torch.nn.GRU`                  |
//! | `Lecun` | any weight                | √(3/inputs)      | LeCun et al. (1998), Efficient BackProp, eq 16 |
//! |         | any bias                  | 0                |                                 |
//!
//! Torch's recurrent bound depends on the number of units only. With few channels the first gates then hardly depend on them.
//!
//! With a seed, parameter i draws from stream i of ChaCha8 under it, in torch's order and layout. Its values depend on
//! nothing else: not on which thread builds the network, nor on which parameter is used first. Without one they come from
//! burn's generator, of which a process has one.

use burn::module::{Initializer, Param};
use burn::nn::Linear;
use burn::tensor::{Device, Tensor, TensorData};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};

/// Rule for initial values: the table above.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FirstRule {
    /// Bounds of torch.
    #[default]
    Torch,
    /// Weights of variance 1/inputs, biases of 0.
    Lecun,
}

/// Source of parameters with their initial values.
#[derive(Debug)]
pub(crate) struct FirstValues<'a> {
    device: &'a Device,
    rule: FirstRule,
    /// Seed of the initial values; none for burn's generator.
    seed: Option<u64>,
    stream: u64,
}

impl<'a> FirstValues<'a> {
    /// Returns the initial values from burn's generator.
    pub fn of_burn(device: &'a Device) -> Self {
        Self { device, rule: FirstRule::Torch, seed: None, stream: 0 }
    }

    /// Returns the initial values by torch's rule from `seed` alone.
    pub fn seeded(seed: u64, device: &'a Device) -> Self {
        Self::by(FirstRule::Torch, seed, device)
    }

    /// Returns the initial values by `rule` from `seed` alone.
    pub fn by(rule: FirstRule, seed: u64, device: &'a Device) -> Self {
        Self { device, rule, seed: Some(seed), stream: 0 }
    }

    /// Returns the next parameter, in torch's layout: `bound` is torch's.
    pub fn next<const D: usize>(&mut self, shape: [usize; D], bound: f64) -> Param<Tensor<D>> {
        let bound = match (self.rule, shape.as_slice()) {
            (FirstRule::Torch, _) => bound,
            (FirstRule::Lecun, [_, inputs]) => lecun_bound(*inputs),
            (FirstRule::Lecun, _) => 0.0,
        };
        match self.drawn(shape.iter().product(), bound) {
            Some(values) => Param::from_data(TensorData::new(values, shape), self.device),
            None => uniform(bound).init(shape, self.device),
        }
    }

    /// Returns the weight and bias as `torch.nn.Linear` draws them.
    pub fn linear(&mut self, inputs: usize, outputs: usize) -> Linear {
        self.linear_within(inputs, outputs, linear_bound(inputs))
    }

    /// Returns the weight and bias as [`linear`](Self::linear), with Xavier's bound on the weight.
    pub fn xavier_linear(&mut self, inputs: usize, outputs: usize) -> Linear {
        self.linear_within(inputs, outputs, xavier_bound(inputs, outputs))
    }

    /// Returns the linear layer with weights within `bound`. burn holds a weight as [inputs, outputs], torch as
    /// [outputs, inputs].
    fn linear_within(&mut self, inputs: usize, outputs: usize, bound: f64) -> Linear {
        let bound = if self.rule == FirstRule::Lecun { lecun_bound(inputs) } else { bound };
        let weight = match self.drawn(outputs * inputs, bound) {
            Some(values) => {
                let turned = transposed(&values, inputs);
                Param::from_data(TensorData::new(turned, [inputs, outputs]), self.device)
            }
            None => uniform(bound).init([inputs, outputs], self.device),
        };
        Linear { weight, bias: Some(self.next([outputs], linear_bound(inputs))) }
    }

    /// Returns the values of the next stream, where there is a seed.
    fn drawn(&mut self, count: usize, bound: f64) -> Option<Vec<f32>> {
        let mut generator = ChaCha8Rng::seed_from_u64(self.seed?);
        generator.set_stream(self.stream);
        self.stream += 1;
        Some((0..count).map(|_| (bound * symmetric(&mut generator)) as f32).collect())
    }
}

/// Returns the rows for columns of a matrix with `columns` of them.
pub(crate) fn transposed(values: &[f32], columns: usize) -> Vec<f32> {
    (0..columns).flat_map(|column| values.iter().skip(column).step_by(columns).copied()).collect()
}

fn uniform(bound: f64) -> Initializer {
    Initializer::Uniform { min: -bound, max: bound }
}

/// Returns the bound 1/√inputs.
fn linear_bound(inputs: usize) -> f64 {
    1.0 / (inputs as f64).sqrt()
}

/// Returns the bound √(6/(in + out)).
pub(crate) fn xavier_bound(inputs: usize, outputs: usize) -> f64 {
    (6.0 / (inputs + outputs) as f64).sqrt()
}

/// Returns the bound √(3/in): uniform values within it have the variance 1/in.
fn lecun_bound(inputs: usize) -> f64 {
    (3.0 / inputs as f64).sqrt()
}

/// Draws a number uniformly from [−1, 1), from the top 53 bits.
fn symmetric(generator: &mut ChaCha8Rng) -> f64 {
    (generator.next_u64() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn draw(seed: u64, skipped: usize) -> Vec<f32> {
        let device = Device::flex();
        let mut first = FirstValues::seeded(seed, &device);
        (0..skipped).for_each(|_| drop(first.next([1], 1.0)));
        first.next([100, 100], linear_bound(100)).val().into_data().try_to_vec().expect("f32")
    }

    fn check(values: &[f32]) {
        let largest = values.iter().fold(0.0f32, |m, v| m.max(v.abs()));
        let mean = values.iter().map(|&v| f64::from(v)).sum::<f64>() / 1e4;
        let sd = (values.iter().map(|&v| (f64::from(v) - mean).powi(2)).sum::<f64>() / 1e4).sqrt();
        assert!(largest <= 0.1 && largest > 0.0999, "largest {largest}");
        assert!(mean.abs() < 0.002, "mean {mean}");
        assert!((sd - 0.1 / 3f64.sqrt()).abs() < 0.001, "sd {sd}");
    }

    /// Oracle: a uniform distribution on (−b, b) has standard deviation b/√3.
    #[test]
    fn first_values_fill_their_interval() {
        check(&draw(7, 0));
        let device = Device::flex();
        let linear = FirstValues::of_burn(&device).linear(100, 100);
        check(&linear.weight.val().into_data().try_to_vec::<f32>().expect("f32"));
    }

    /// Oracle: variance 1/inputs, whatever the number of outputs; biases are zero.
    #[test]
    fn lecun_values_depend_on_the_inputs_alone() {
        let device = Device::flex();
        let mut first = FirstValues::by(FirstRule::Lecun, 3, &device);
        let numbers = |values: Tensor<2>| values.into_data().try_to_vec::<f32>().expect("f32");
        let recurrent = numbers(first.next([2000, 4], 7.0).val());
        let linear = first.linear(4, 2000);
        assert_eq!(linear.bias.expect("a bias").val().into_data().try_to_vec::<f32>().expect("f32"), [0.0; 2000]);
        for values in [recurrent, numbers(linear.weight.val())] {
            let variance = values.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>() / values.len() as f64;
            assert!((variance - 0.25).abs() < 0.01, "{variance}");
        }
    }

    #[test]
    fn streams_and_seeds_differ() {
        assert_eq!(draw(7, 0), draw(7, 0));
        assert_ne!(draw(7, 0), draw(7, 1));
        assert_ne!(draw(7, 0), draw(8, 0));
    }

    #[test]
    fn rows_become_columns() {
        assert_eq!(transposed(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], 3), [1.0, 4.0, 2.0, 5.0, 3.0, 6.0]);
    }
}
