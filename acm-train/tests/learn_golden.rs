//! Oracle: torch 2.15 in double precision (`acm-models/tests/golden`).

use acm_models::burn::tensor::{Device, Tensor, TensorData};
use acm_models::optimizer::clip::clip;
use acm_models::optimizer::moments::Moments;
use acm_models::{CfcConfig, Network, NetworkConfig};
use acm_train::config::OptimizerKind;
use acm_train::learn::optimizer::step;
use serde_json::Value;

const TOLERANCE: f64 = 1e-5;

fn golden() -> Value {
    let path = "../acm-models/tests/golden/networks.json";
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{path}: {error}"));
    serde_json::from_str(&text).expect("golden numbers are JSON")
}

fn near(what: &str, found: f64, golden: &Value) {
    let golden = golden.as_f64().expect("a number");
    let off = (found - golden).abs();
    eprintln!("{what}: off by {off:.1e}");
    assert!(off < TOLERANCE, "{what}: {found} instead of {golden}");
}

/// p = (0.5, −0.3, 2), loss Σ k (p − 1)² with k = (1, 2, 3), learning rate 0.01, 100 steps; weight decay 0.1 where there is one.
#[test]
fn a_hundred_steps_of_each_optimizer() {
    let golden = golden();
    let optimizers = [
        ("adam_100", OptimizerKind::Adam, 0.0),
        ("adam_l2_100", OptimizerKind::Adam, 0.1),
        ("adamw_100", OptimizerKind::Adamw, 0.1),
        ("rmsprop_100", OptimizerKind::Rmsprop, 0.0),
    ];
    for (name, kind, decay) in optimizers {
        let mut values = [0.5f32, -0.3, 2.0];
        let mut moments = Moments::new(3);
        for _ in 0..100 {
            let gradient = [0, 1, 2].map(|i| 2.0 * (i + 1) as f32 * (values[i] - 1.0));
            step(kind, decay, 0.01, &mut moments, &mut values, &gradient);
        }
        for (i, value) in values.into_iter().enumerate() {
            near(&format!("{name}[{i}]"), value.into(), &golden[name][i]);
        }
    }
}

/// (3, 4) and (6, 8) are two tensors: their common norm is limited, not each one's.
#[test]
fn clipping_is_by_the_global_norm() {
    let golden = golden();
    let mut gradient = [3.0, 4.0, 6.0, 8.0];
    near("norm", clip(&mut gradient, 1.0), &golden["clip_global"][0]);
    for (i, found) in gradient.into_iter().enumerate() {
        near("clipped", found.into(), &golden["clip_global"][1 + i / 2][i % 2]);
    }
}

/// CfC cell and output layer, each filled by the rule of the fixtures from i = 0; 20 steps of Adam; the loss at steps 1,
/// 10 and 20.
#[test]
fn twenty_training_steps() {
    let golden = golden();
    let (batch, steps, channels) = (3, 6, 4);
    let device = Device::flex();
    let config = NetworkConfig::Cfc(CfcConfig { units: 5, backbone_units: 7, ..CfcConfig::default() });
    let mut network = Network::new(&config, channels, 2, 0, &device.clone().autodiff());
    let head = 5 * 2 + 2;
    let rule = |i: usize| (0.3 * (0.7 * i as f64 + 0.1).sin()) as f32;
    let mut values: Vec<f32> = (0..network.parameter_count() - head).chain(0..head).map(rule).collect();

    let input = |i: usize| {
        let (b, t, f) = (i / (steps * channels), i / channels % steps, i % channels);
        (0.5 * (b as f64 + 1.0) + 0.3 * t as f64 + 0.9 * f as f64).sin() as f32
    };
    let inputs: Vec<f32> = (0..batch * steps * channels).map(input).collect();
    let elapsed: Vec<f32> =
        (0..batch * steps).map(|i| 0.02 * (1.0 + ((3 * (i / steps) + 2 * (i % steps)) % 5) as f32)).collect();
    let target = |b: usize| [(0.5 * (b as f32 + 1.0)).cos(), (b as f32 + 1.0).sin()];
    let targets: Vec<f32> = (0..batch).flat_map(target).collect();
    let inputs = Tensor::<3>::from_data(TensorData::new(inputs, [batch, steps, channels]), &device);
    let elapsed = Tensor::<2>::from_data(TensorData::new(elapsed, [batch, steps]), &device);
    let targets = Tensor::<2>::from_data(TensorData::new(targets, [batch, 2]), &device);

    let mut moments = Moments::new(values.len());
    let mut losses = Vec::new();
    for _ in 0..20 {
        network.set_values(&values);
        let residual = network.forward_last(inputs.clone(), elapsed.clone()) - targets.clone();
        let loss = (residual.clone() * residual).mean();
        losses.push(f64::from(loss.clone().into_scalar::<f32>()));
        let gradient = network.gradient(&mut loss.backward());
        step(OptimizerKind::Adam, 0.0, 1e-3, &mut moments, &mut values, &gradient);
    }
    for (i, number) in [1, 10, 20].into_iter().enumerate() {
        near(&format!("loss at step {number}"), losses[number - 1], &golden["cfc_train20"][i]);
    }
}
