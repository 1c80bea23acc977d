//! Dropout of the features that the output layer reads.
//!
//! ```text
//! y = W (m ⊙ h) / (1 − p) + b,     m_f = 0 with probability p, else 1
//! ```
//!
//! | symbol | meaning                                   | shape |
//! | ------ | ----------------------------------------- | ----- |
//! | `h`    | features: state, or last hidden layer     | `[F]` |
//! | `W, b` | output layer                              | `[O×F]`, `[O]` |
//! | `m`    | mask, one for each batch                  | `[F]` |
//! | `p`    | share that is left out                    | 1     |
//!
//! One mask holds for all windows and steps of a batch, as in Gal and Ghahramani (2016) for all steps of a sequence. It acts
//! on the columns of W, so that the network itself is unchanged. Validation and prediction use all features.
//!
//! Epoch e draws from stream 2³³ + e of ChaCha8 under the run's seed: a resumed run needs no state.

use acm_models::Network;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Dropout with its buffers.
#[derive(Debug)]
pub struct Dropout {
    share: f64,
    /// Place of the first weight of the output layer among all weights.
    first: usize,
    outputs: usize,
    /// Factor on each feature: 0, or 1/(1 − p).
    mask: Vec<f32>,
    masked: Vec<f32>,
    generator: ChaCha8Rng,
}

impl Dropout {
    /// Returns the dropout of a `share` p of the features of a network; `None` where nothing is left out.
    pub fn new(share: f64, network: &Network) -> Option<Self> {
        // The output layer is the last: its weights, then its biases.
        let (parameters, outputs) = (network.parameter_count(), network.outputs());
        let weights: usize = network.parameters().iter().rev().nth(1)?.shape.iter().product();
        (share > 0.0).then(|| Self::of(share, parameters, outputs, weights / outputs))
    }

    fn of(share: f64, parameters: usize, outputs: usize, features: usize) -> Self {
        Self {
            share,
            first: parameters - outputs * (features + 1),
            outputs,
            mask: vec![1.0; features],
            masked: vec![],
            generator: ChaCha8Rng::seed_from_u64(0),
        }
    }

    /// Begins an epoch of a run with that seed.
    pub fn begin(&mut self, seed: u64, epoch: usize) {
        self.generator = ChaCha8Rng::seed_from_u64(seed);
        self.generator.set_stream((1 << 33) + epoch as u64);
    }

    /// Draws the mask of the next batch, and returns the weights with it.
    pub fn masked(&mut self, weights: &[f32]) -> &[f32] {
        let bound = (self.share * (u64::MAX as f64)) as u64;
        let kept = (1.0 / (1.0 - self.share)) as f32;
        for factor in &mut self.mask {
            *factor = if self.generator.next_u64() < bound { 0.0 } else { kept };
        }
        self.masked.clear();
        self.masked.extend_from_slice(weights);
        scale(&mut self.masked, self.first, self.outputs, &self.mask);
        &self.masked
    }

    /// Turns the gradient by the masked weights into that by the weights.
    pub fn unmask(&self, gradient: &mut [f32]) {
        scale(gradient, self.first, self.outputs, &self.mask);
    }
}

/// Multiplies the columns of W, which begins at `first`, by the mask.
fn scale(values: &mut [f32], first: usize, outputs: usize, mask: &[f32]) {
    let own = &mut values[first..first + outputs * mask.len()];
    for row in own.chunks_exact_mut(mask.len()) {
        row.iter_mut().zip(mask).for_each(|(value, factor)| *value *= factor);
    }
}

#[cfg(test)]
mod tests {
    use acm_models::NetworkConfig;
    use acm_models::burn::tensor::Device;

    use super::*;

    /// Oracle: the shapes of the parameters. Nothing is left out of a share of 0.
    #[test]
    fn the_output_layer_is_found() {
        let network = Network::new(&NetworkConfig::default(), 4, 2, 1, &Device::flex());
        let dropout = Dropout::new(0.5, &network).unwrap();
        let [weights, biases] = [2, 1].map(|back| &network.parameters()[network.parameters().len() - back].shape);
        assert_eq!((weights[..].to_vec(), biases[..].to_vec()), (vec![2, dropout.mask.len()], vec![2]));
        assert_eq!(dropout.first + weights.iter().product::<usize>() + 2, network.parameter_count());
        assert!(Dropout::new(0.0, &network).is_none());
    }

    /// Two outputs of three features behind one other weight; biases stay.
    const WEIGHTS: [f32; 9] = [9.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];

    /// Oracle: by hand. A feature that is left out has a column of zeros, and no gradient there; the others are doubled.
    #[test]
    fn columns_are_left_out_and_the_rest_makes_up_for_them() {
        let mut dropout = Dropout::of(0.5, 9, 2, 3);
        dropout.begin(1, 1);
        let found = dropout.masked(&WEIGHTS).to_vec();
        assert_eq!((found[0], &found[7..]), (9.0, &WEIGHTS[7..]));
        let mut gradient = [1.0_f32; 9];
        dropout.unmask(&mut gradient);
        for feature in 0..3 {
            let (upper, lower) = (1 + feature, 4 + feature);
            assert!([0.0, 2.0].contains(&gradient[upper]) && gradient[upper] == gradient[lower]);
            assert_eq!([found[upper], found[lower]], [upper, lower].map(|place| WEIGHTS[place] * gradient[upper]));
        }
        assert_eq!((gradient[0], &gradient[7..]), (1.0, &[1.0, 1.0][..]));
    }

    /// Oracle: a share of 0.3 of 30,000 draws strays by less than 5 σ = 400; the mean factor is then near 1.
    #[test]
    fn the_share_is_left_out_and_each_batch_has_its_own_mask() {
        let mut dropout = Dropout::of(0.3, 301, 1, 300);
        dropout.begin(7, 1);
        let masks: Vec<Vec<f32>> = (0..100).map(|_| dropout.masked(&[1.0; 301])[..300].to_vec()).collect();
        let left_out = masks.iter().flatten().filter(|factor| **factor == 0.0).count() as f64;
        assert!((left_out - 9000.0).abs() < 400.0, "{left_out}");
        assert_ne!(masks[0], masks[1]);
        dropout.begin(7, 1);
        assert_eq!(masks[0], dropout.masked(&[1.0; 301])[..300]);
        dropout.begin(7, 2);
        assert_ne!(masks[0], dropout.masked(&[1.0; 301])[..300]);
    }
}
