//! A module of your own around a CfC, trained with burn's Adam on samples at irregular times.
//!
//! ```text
//! cargo run -p acm-models --example own_module
//! ```
//!
//! The task: the running mean of a noisy signal over the last second, from samples that come 0.02 to 0.4 s apart. A network
//! that does not know the elapsed time cannot know how many samples a second holds.
//!
//! ```text
//! y_k = Σ_j w_j x_j / Σ_j w_j,   w_j = exp(−(t_k − t_j) / 1 s)
//! ```

use acm_models::burn;
use acm_models::burn::module::Module;
use acm_models::burn::nn::{Linear, LinearConfig};
use acm_models::burn::tensor::{Device, Tensor, TensorData};
use acm_models::{Cfc, CfcConfig};
use burn_optim::{AdamConfig, GradientsParams};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

const BATCH: usize = 64;
const STEPS: usize = 40;

/// A smoother of irregular samples.
#[derive(Module, Debug)]
struct Smoother {
    cfc: Cfc,
    head: Linear,
}

impl Smoother {
    fn new(device: &Device) -> Self {
        Self {
            cfc: CfcConfig::new(1).with_units(16).init_seeded(1, device),
            head: LinearConfig::new(16, 1).init(device),
        }
    }

    /// # Shapes
    /// - samples: `[B,W,1]`
    /// - elapsed: `[B,W]`, s
    /// - result: `[B,W,1]`
    fn forward(&self, samples: Tensor<3>, elapsed: Tensor<2>) -> Tensor<3> {
        self.head.forward(self.cfc.forward(samples, elapsed))
    }

    fn loss(&self, batch: &Batch, elapsed: Tensor<2>) -> Tensor<1> {
        let residual = self.forward(batch.samples.clone(), elapsed) - batch.means.clone();
        (residual.clone() * residual).mean()
    }
}

struct Batch {
    samples: Tensor<3>,
    elapsed: Tensor<2>,
    means: Tensor<3>,
}

impl Batch {
    fn new(seed: u64, device: &Device) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let mut uniform = || (generator.next_u64() >> 11) as f32 / (1u64 << 53) as f32;
        let (mut samples, mut elapsed, mut means) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..BATCH {
            let (mut sum, mut weight) = (0.0, 0.0);
            for _ in 0..STEPS {
                let (x, dt) = (2.0 * uniform() - 1.0, 0.02 + 0.38 * uniform().powi(2));
                let fade = (-dt).exp();
                (sum, weight) = (sum * fade + x, weight * fade + 1.0);
                samples.push(x);
                elapsed.push(dt);
                means.push(sum / weight);
            }
        }
        let shaped = |values| Tensor::from_data(TensorData::new(values, [BATCH, STEPS, 1]), device);
        let elapsed = Tensor::from_data(TensorData::new(elapsed, [BATCH, STEPS]), device);
        Self { samples: shaped(samples), elapsed, means: shaped(means) }
    }
}

fn main() {
    let device = Device::flex().autodiff();
    device.seed(1);
    let mut smoother = Smoother::new(&device);
    let mut optimizer = AdamConfig::new().init();
    for step in 0..=1000 {
        let batch = Batch::new(step, &device);
        let loss = smoother.loss(&batch, batch.elapsed.clone());
        if step % 200 == 0 {
            println!("step {step:4}: root mean square error {:.4}", loss.clone().into_scalar::<f32>().sqrt());
        }
        let gradients = GradientsParams::from_grads(loss.backward(), &smoother);
        smoother = optimizer.step(3e-3, smoother, gradients);
    }
    let unseen = Batch::new(u64::MAX, &device.inner());
    let smoother = smoother.valid();
    let error = |elapsed: Tensor<2>| smoother.loss(&unseen, elapsed).into_scalar::<f32>().sqrt();
    let even = unseen.elapsed.clone().mean().expand([BATCH, STEPS]);
    println!("unseen samples: {:.4}; with even elapsed times {:.4}", error(unseen.elapsed.clone()), error(even));
}
