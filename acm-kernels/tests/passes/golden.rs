//! Oracle: torch 2.15 and ncps 1.0.1 in double precision (`acm-models/tests/golden`).
//!
//! Parameter i is 0.3 sin(0.7 i + 0.1) in torch's order, x[b,t,f] = sin(0.5 (b+1) + 0.3 t + 0.9 f),
//! Δt[b,t] = 0.02 (1 + ((3b + 2t) mod 5)); B = 3, W = 6, C = 4, H = 5, backbone 7. The states come out through a
//! linear layer that is the identity.

use acm_kernels::{Activation, Body, CfcMode, CfcShape, GruShape, Keep, Kernel, Sequences, Shape};
use serde_json::Value;

const BATCH: usize = 3;
const STEPS: usize = 6;
const CHANNELS: usize = 4;
const UNITS: usize = 5;
const HEAD: usize = UNITS * UNITS + UNITS;

fn golden() -> Value {
    let path = "../acm-models/tests/golden/networks.json";
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{path}: {error}"));
    serde_json::from_str(&text).expect("golden numbers are JSON")
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn near(what: &str, found: f64, golden: f64) {
    let off = (found - golden).abs();
    assert!(off < 1e-5, "{what}: {found} instead of {golden}");
}

/// A kernel, its parameters by the rule, and the batch by the rule.
struct Fixture {
    kernel: Kernel,
    parameters: Vec<f32>,
    inputs: Vec<f32>,
    elapsed: Vec<f32>,
}

impl Fixture {
    fn new(body: Body) -> Self {
        let shape = Shape { body, inputs: CHANNELS, outputs: UNITS };
        let kernel = Kernel::new(&shape).expect("sizes are positive");
        let own = kernel.parameters() - HEAD;
        let rule = (0..own).map(|i| (0.3 * (0.7 * i as f64 + 0.1).sin()) as f32);
        let identity = (0..HEAD).map(|i| if i < UNITS * UNITS && i % (UNITS + 1) == 0 { 1.0 } else { 0.0 });
        let at = |i: usize| {
            let (b, t, f) = (i / (STEPS * CHANNELS), i / CHANNELS % STEPS, i % CHANNELS);
            (0.5 * (b as f64 + 1.0) + 0.3 * t as f64 + 0.9 * f as f64).sin() as f32
        };
        let elapsed = |i: usize| 0.02 * (1.0 + ((3 * (i / STEPS) + 2 * (i % STEPS)) % 5) as f32);
        Self {
            parameters: rule.chain(identity).collect(),
            inputs: (0..BATCH * STEPS * CHANNELS).map(at).collect(),
            elapsed: (0..BATCH * STEPS).map(elapsed).collect(),
            kernel,
        }
    }

    fn own(&self) -> usize {
        self.parameters.len() - HEAD
    }

    fn sequences<'a>(&'a self, keep: Keep, state: Option<&'a [f32]>) -> Sequences<'a> {
        let Self { inputs, elapsed, .. } = self;
        Sequences { inputs, elapsed, state, batch: BATCH, steps: STEPS, keep }
    }

    fn states(&self, sequences: &Sequences) -> Vec<f32> {
        let mut states = vec![0.0; self.kernel.predictions(sequences)];
        self.kernel.infer(&self.parameters, sequences, &mut self.kernel.workspace(), &mut states);
        states
    }
}

fn sum(values: &[f32]) -> f64 {
    values.iter().map(|&v| f64::from(v)).sum()
}

fn cfc(mode: CfcMode, backbone_layers: usize) -> Body {
    Body::Cfc(CfcShape { units: UNITS, mode, backbone_units: 7, backbone_layers, activation: Activation::LecunTanh })
}

#[test]
fn cfc_states_loss_and_gradient() {
    let golden = golden();
    for (name, mode) in [("default", CfcMode::Default), ("no_gate", CfcMode::NoGate), ("pure", CfcMode::Pure)] {
        for layers in [1, 2] {
            let what = format!("cfc_{name}_L{layers}");
            let expected = &golden[&what];
            let fixture = Fixture::new(cfc(mode, layers));
            assert_eq!(fixture.own() as u64, expected["params"].as_u64().expect("a count"));
            let sequences = fixture.sequences(Keep::Last, None);
            let states = fixture.states(&sequences);
            for (found, golden) in states.iter().zip(expected["h0"].as_array().expect("a list")) {
                near(&what, f64::from(*found), number(golden));
            }
            near(&what, sum(&states), number(&expected["sum"]));

            let mean_square = |_: usize, p: &[f32], d: &mut [f32]| {
                let count = (BATCH * UNITS) as f32;
                d.iter_mut().zip(p).for_each(|(d, p)| *d = 2.0 * p / count);
                p.iter().map(|p| f64::from(p * p / count)).sum()
            };
            let mut gradient = vec![0.0; fixture.parameters.len()];
            let mut work = fixture.kernel.workspace();
            let loss = fixture.kernel.train(&fixture.parameters, &sequences, &mean_square, &mut work, &mut gradient);
            near(&what, loss, number(&expected["loss"]));
            let norm = gradient[..fixture.own()].iter().map(|&g| f64::from(g).powi(2)).sum::<f64>().sqrt();
            near(&what, norm, number(&expected["gradnorm"]));
        }
    }
    let fixture = Fixture::new(cfc(CfcMode::Default, 0));
    let states = fixture.states(&fixture.sequences(Keep::Last, None));
    near("no backbone", sum(&states), number(&golden["cfc_default_L0"]["sum"]));
}

/// A cell that ignores the elapsed time cannot pass both of these and the fixture before.
#[test]
fn cfc_reads_elapsed_time() {
    let golden = golden();
    let mut fixture = Fixture::new(cfc(CfcMode::Default, 1));
    fixture.elapsed.iter_mut().for_each(|t| *t *= 10.0);
    let states = fixture.states(&fixture.sequences(Keep::Last, None));
    near("ten times", sum(&states), number(&golden["cfc_default_L1_dtx10_sum"]));
    fixture.elapsed.fill(1.0);
    let states = fixture.states(&fixture.sequences(Keep::Last, None));
    near("one second", sum(&states), number(&golden["cfc_default_L1_dt1_sum"]));
}

#[test]
fn gru_outputs_from_zero_and_from_a_given_state() {
    let golden = golden();
    for layers in [1, 2] {
        let what = format!("gru_{layers}");
        let expected = &golden[&what];
        let fixture = Fixture::new(Body::Gru(GruShape { units: UNITS, layers }));
        assert_eq!(fixture.own() as u64, expected["params"].as_u64().expect("a count"));
        let all = fixture.states(&fixture.sequences(Keep::Every, None));
        near(&what, sum(&all), number(&expected["sum_zero"]));
        let state: Vec<_> = (0..layers * BATCH * UNITS).map(|k| 0.1 * (k as f32).cos()).collect();
        let from = fixture.states(&fixture.sequences(Keep::Every, Some(&state)));
        near(&what, sum(&from), number(&expected["sum_h0"]));
        let last = &from[(STEPS - 1) * UNITS..STEPS * UNITS];
        for (found, golden) in last.iter().zip(expected["y_last0"].as_array().expect("a list")) {
            near(&what, f64::from(*found), number(golden));
        }
    }
}
