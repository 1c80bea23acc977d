//! Oracle: torch 2.15 and ncps 1.0.1 in double precision (`golden/networks.json` and its README).
//!
//! The rule of every fixture: parameter i is 0.3 sin(0.7 i + 0.1) over all values in torch's order,
//! x[b,t,f] = sin(0.5 (b+1) + 0.3 t + 0.9 f), Δt[b,t] = 0.02 (1 + ((3b + 2t) mod 5)); B = 3, T = 6,
//! F = 4, H = 5, backbone 7. The states come out through an output layer that is the identity.
//!
//! `ACM_DEVICE` names the device (default flex).

use acm_models::burn::tensor::{Device, Tensor, TensorData};
use acm_models::{CfcConfig, CfcMode, GruConfig, Network, NetworkConfig};
use serde_json::Value;

const BATCH: usize = 3;
const STEPS: usize = 6;
const CHANNELS: usize = 4;
const UNITS: usize = 5;
const TOLERANCE: f64 = 1e-5;

fn named_device() -> Device {
    let name = std::env::var("ACM_DEVICE").unwrap_or_else(|_| "flex".into());
    acm_models::device(&name).unwrap_or_else(|error| panic!("{error}"))
}

fn golden() -> Value {
    let path = "tests/golden/networks.json";
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{path}: {error}"));
    serde_json::from_str(&text).expect("golden numbers are JSON")
}

fn rule(count: usize) -> Vec<f32> {
    (0..count).map(|i| (0.3 * (0.7 * i as f64 + 0.1).sin()) as f32).collect()
}

fn inputs(device: &Device) -> Tensor<3> {
    let at = |i: usize| {
        let (b, t, f) = (i / (STEPS * CHANNELS), i / CHANNELS % STEPS, i % CHANNELS);
        (0.5 * (b as f64 + 1.0) + 0.3 * t as f64 + 0.9 * f as f64).sin() as f32
    };
    let values: Vec<f32> = (0..BATCH * STEPS * CHANNELS).map(at).collect();
    Tensor::from_data(TensorData::new(values, [BATCH, STEPS, CHANNELS]), device)
}

fn elapsed(device: &Device) -> Tensor<2> {
    let at = |i: usize| 0.02 * (1.0 + ((3 * (i / STEPS) + 2 * (i % STEPS)) % 5) as f32);
    let values: Vec<f32> = (0..BATCH * STEPS).map(at).collect();
    Tensor::from_data(TensorData::new(values, [BATCH, STEPS]), device)
}

/// The network filled by the rule, with the identity as output layer: by the fused kernels, and in plain tensor operations.
fn filled(config: &NetworkConfig, device: &Device) -> [Network; 2] {
    let mut network = Network::new(config, CHANNELS, UNITS, 0, device);
    let head = UNITS * UNITS + UNITS;
    let mut values = rule(network.parameter_count() - head);
    values.extend((0..head).map(|i| f32::from(i < UNITS * UNITS && i % (UNITS + 1) == 0)));
    network.set_values(&values);
    [network.plain(), network]
}

fn cfc(mode: CfcMode, backbone_layers: usize) -> NetworkConfig {
    NetworkConfig::Cfc(CfcConfig::default().with_units(UNITS).with_mode(mode).with_backbone(backbone_layers, 7))
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(number).collect()
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn values(tensor: Tensor<2>) -> Vec<f64> {
    let data: Vec<f32> = tensor.into_data().try_to_vec().expect("f32");
    data.into_iter().map(f64::from).collect()
}

fn near(what: &str, found: f64, golden: f64) {
    let off = (found - golden).abs();
    eprintln!("{what}: off by {off:.1e}");
    assert!(off < TOLERANCE, "{what}: {found} instead of {golden}");
}

fn own_count(network: &Network) -> usize {
    network.parameter_count() - (UNITS * UNITS + UNITS)
}

#[test]
fn cfc_states_loss_and_gradient() {
    let golden = golden();
    let device = named_device().autodiff();
    let modes = [("default", CfcMode::Default), ("no_gate", CfcMode::NoGate), ("pure", CfcMode::Pure)];
    for (name, mode) in modes {
        for layers in [1, 2] {
            let what = format!("cfc_{name}_L{layers}");
            let expected = &golden[&what];
            for network in filled(&cfc(mode, layers), &device) {
                assert_eq!(own_count(&network) as u64, expected["params"].as_u64().expect("a count"));

                let last = network.forward_last(inputs(&device), elapsed(&device));
                let states = values(last.clone());
                for (found, golden) in states.iter().zip(numbers(&expected["h0"])) {
                    near(&format!("{what} h0"), *found, golden);
                }
                near(&format!("{what} sum"), states.iter().sum(), number(&expected["sum"]));

                let loss = (last.clone() * last).mean();
                near(&format!("{what} loss"), f64::from(loss.clone().into_scalar::<f32>()), number(&expected["loss"]));
                let gradient = network.gradient(&mut loss.backward());
                let own = &gradient[..own_count(&network)];
                let norm = own.iter().map(|&g| f64::from(g).powi(2)).sum::<f64>().sqrt();
                near(&format!("{what} gradnorm"), norm, number(&expected["gradnorm"]));
            }
        }
    }
}

#[test]
fn cfc_without_backbone() {
    let golden = golden();
    let device = named_device();
    let expected = &golden["cfc_default_L0"];
    for network in filled(&cfc(CfcMode::Default, 0), &device) {
        assert_eq!(own_count(&network) as u64, expected["params"].as_u64().expect("a count"));
        let sum = values(network.forward_last(inputs(&device), elapsed(&device))).iter().sum();
        near("cfc_default_L0", sum, number(&expected["sum"]));
    }
}

/// A cell that ignores the elapsed time cannot pass both of these and the fixture before.
#[test]
fn cfc_reads_elapsed_time() {
    let golden = golden();
    let device = named_device();
    for network in filled(&cfc(CfcMode::Default, 1), &device) {
        let sum = |elapsed| values(network.forward_last(inputs(&device), elapsed)).iter().sum();
        let key = "cfc_default_L1_dtx10_sum";
        near(key, sum(elapsed(&device).mul_scalar(10.0)), number(&golden[key]));
        let key = "cfc_default_L1_dt1_sum";
        near(key, sum(Tensor::ones([BATCH, STEPS], &device)), number(&golden[key]));
    }
}

#[test]
fn gru_outputs_from_zero_and_from_a_given_state() {
    let golden = golden();
    let device = named_device();
    for layers in [1, 2] {
        let what = format!("gru_{layers}");
        let expected = &golden[&what];
        for network in filled(&NetworkConfig::Gru(GruConfig::default().with_units(UNITS).with_layers(layers)), &device)
        {
            assert_eq!(own_count(&network) as u64, expected["params"].as_u64().expect("a count"));

            let all = network.forward(inputs(&device), elapsed(&device));
            let all = values(all.reshape([BATCH * STEPS, UNITS]));
            near(&format!("{what} sum_zero"), all.iter().sum(), number(&expected["sum_zero"]));

            let states = (0..layers).map(|l| {
                let start = l * BATCH * UNITS;
                let k = start..start + BATCH * UNITS;
                let state: Vec<f32> = k.map(|k| 0.1 * (k as f32).cos()).collect();
                Tensor::from_data(TensorData::new(state, [BATCH, UNITS]), &device)
            });
            let from = network.forward_from(inputs(&device), elapsed(&device), states.collect());
            let from = values(from.reshape([BATCH * STEPS, UNITS]));
            near(&format!("{what} sum_h0"), from.iter().sum(), number(&expected["sum_h0"]));
            let first_window = &from[(STEPS - 1) * UNITS..STEPS * UNITS];
            for (found, golden) in first_window.iter().zip(numbers(&expected["y_last0"])) {
                near(&format!("{what} y_last0"), *found, golden);
            }
        }
    }
}

#[test]
fn names_and_shapes_are_those_of_torch() {
    let golden = golden();
    let device = named_device();
    let modes = [("default", CfcMode::Default), ("no_gate", CfcMode::NoGate), ("pure", CfcMode::Pure)];
    let cfcs = modes.map(|(name, mode)| (format!("cfc_{name}_L1"), cfc(mode, 1)));
    let grus = [1, 2].map(|layers| {
        (format!("gru_{layers}"), NetworkConfig::Gru(GruConfig::default().with_units(UNITS).with_layers(layers)))
    });
    for (what, config) in cfcs.into_iter().chain(grus) {
        let network = Network::new(&config, CHANNELS, UNITS, 0, &device);
        let own = &network.parameters()[..network.parameters().len() - 2];
        let found: Vec<_> = own.iter().map(|p| serde_json::json!([p.name, p.shape])).collect();
        assert_eq!(Value::from(found), golden[&what]["names"], "{what}");
    }
}

#[test]
fn parameter_counts() {
    let golden = golden();
    let device = named_device();
    for (inputs, units) in [(6, 64), (17, 64), (4, 32)] {
        let cfc = CfcConfig { units, backbone_units: 128, ..CfcConfig::default() };
        let networks = [
            (format!("count_cfc_{inputs}_{units}_bb128x1"), NetworkConfig::Cfc(cfc)),
            (format!("count_gru_{inputs}_{units}"), NetworkConfig::Gru(GruConfig::default().with_units(units))),
        ];
        for (key, config) in networks {
            let network = Network::new(&config, inputs, 1, 0, &device);
            let own = network.parameter_count() - (units + 1);
            assert_eq!(own as u64, golden[&key].as_u64().expect("a count"), "{key}");
        }
    }
}
