//! How long a training step takes: forward, backward and a plain step down the gradient.
//!
//! ```text
//! cargo run -p acm-models --example step_time [-- RUNS_SIDE_BY_SIDE]
//! ```
//!
//! Five channels, three outputs, batch 64; the perceptron sees one step, the GRU 25, the CfC 50.

use std::time::Instant;

use acm_models::burn::tensor::{Device, Tensor};
use acm_models::{Network, NetworkConfig};

const BATCH: usize = 64;

fn main() {
    let threads = std::env::args().nth(1).map_or(1, |count| count.parse().expect("a count"));
    for config in NetworkConfig::all() {
        let length = match config {
            NetworkConfig::Mlp(_) => 1,
            NetworkConfig::Gru(_) => 25,
            NetworkConfig::Cfc(_) => 50,
        };
        let times: Vec<f64> = std::thread::scope(|scope| {
            let runs: Vec<_> = (0..threads).map(|_| scope.spawn(|| median(&config, length))).collect();
            runs.into_iter().map(|run| run.join().expect("no panic")).collect()
        });
        let listed: Vec<_> = times.iter().map(|time| format!("{:.3}", 1e3 * time)).collect();
        println!("{:4} {length:2} steps: {} ms", config.kind(), listed.join(", "));
    }
}

/// Median seconds of a training step.
fn median(config: &NetworkConfig, length: usize) -> f64 {
    let plain = Device::flex();
    let mut network = Network::new(config, 5, 3, 1, &plain.clone().autodiff());
    let inputs = Tensor::<3>::ones([BATCH, length, 5], &plain);
    let elapsed = Tensor::<2>::full([BATCH, length], 0.1, &plain);
    let mut times: Vec<f64> = (0..200)
        .map(|_| {
            let start = Instant::now();
            let prediction = network.forward_last(inputs.clone(), elapsed.clone()).sub_scalar(0.5);
            let loss = (prediction.clone() * prediction).mean();
            let gradient = network.gradient(&mut loss.backward());
            let mut values = network.values();
            values.iter_mut().zip(gradient).for_each(|(value, gradient)| *value -= 1e-3 * gradient);
            network.set_values(&values);
            start.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
