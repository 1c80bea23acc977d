//! A campaign with a planted residual: smooth inputs, irregular time stamps, slopes that depend on the actuators,
//! noise.

use std::f64::consts::TAU;

use acm_core::record::Record;
use acm_core::rig::{Rig, Signal};
use acm_trace::diagnose::remainder::{Remainder, TrialRemainder};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

/// Sizes of a campaign.
#[derive(Debug, Clone, Copy)]
pub struct Shape {
    pub trials: usize,
    pub samples: usize,
    pub actuators: usize,
    /// The first is a throttle, which jumps; the second is a payload, which is constant in a trial.
    pub contexts: usize,
    pub outputs: usize,
    /// Blocks in each trial.
    pub blocks: usize,
    /// Mean time between samples, s.
    pub step: f64,
}

/// Four trials of 50 s.
pub const SMALL: Shape = Shape { trials: 4, samples: 250, actuators: 2, contexts: 2, outputs: 3, blocks: 1, step: 0.2 };

/// The size that the speed is asked for: 16 trials of 50 s.
pub const LARGE: Shape = Shape { trials: 16, samples: 500, step: 0.1, ..SMALL };

/// See the head.
pub struct Campaign {
    pub rig: Rig,
    pub names: Vec<String>,
    pub records: Vec<Record>,
    pub residuals: Vec<Vec<f64>>,
    pub counts: Vec<Vec<bool>>,
    pub slopes: Vec<Vec<f64>>,
    pub blocks: Vec<Vec<usize>>,
    pub floor: f64,
    random: ChaCha8Rng,
}

impl Campaign {
    /// Nothing is left yet.
    pub fn new(shape: Shape, seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let records: Vec<Record> = (0..shape.trials).map(|_| record(shape, &mut random)).collect();
        let slopes = records.iter().map(|record| slopes(shape, record)).collect();
        let block =
            |k: usize| (0..shape.samples).map(|t| k * shape.blocks + t * shape.blocks / shape.samples).collect();
        Self {
            rig: rig(shape, &records),
            names: (1..=shape.trials).map(|k| k.to_string()).collect(),
            residuals: vec![vec![0.0; shape.samples * shape.outputs]; shape.trials],
            // The first samples warm up.
            counts: vec![(0..shape.samples).map(|t| t >= 3).collect(); shape.trials],
            blocks: (0..shape.trials).map(block).collect(),
            records,
            slopes,
            floor: 0.0,
            random,
        }
    }

    /// Noise of standard deviation `sd` in each output, with correlation `phi` from one sample to the next.
    pub fn noise(mut self, sd: f64, phi: f64) -> Self {
        let outputs = self.rig.outputs.len();
        for residual in &mut self.residuals {
            let mut state: Vec<f64> = (0..outputs).map(|_| sd * normal(&mut self.random)).collect();
            for row in residual.chunks_exact_mut(outputs) {
                for (r, state) in row.iter_mut().zip(&mut state) {
                    *r += *state;
                    *state = phi * *state + (1.0 - phi * phi).sqrt() * sd * normal(&mut self.random);
                }
            }
        }
        let white = if phi == 0.0 { sd } else { 0.0 };
        self.floor = self.floor.hypot(white * (outputs as f64).sqrt());
        self
    }

    /// Adds `of(trial, record)` [T] as an offset of actuator `a`.
    pub fn on_actuator(mut self, a: usize, of: impl Fn(usize, &Record) -> Vec<f64>) -> Self {
        let (actuators, outputs) = (self.rig.actuators.len(), self.rig.outputs.len());
        for k in 0..self.records.len() {
            let offset = of(k, &self.records[k]);
            for (row, r) in self.residuals[k].iter_mut().enumerate() {
                *r += self.slopes[k][row * actuators + a] * offset[row / outputs];
            }
        }
        self
    }

    /// Adds `of(trial, record)` [T] to output `m`.
    pub fn on_output(mut self, m: usize, of: impl Fn(usize, &Record) -> Vec<f64>) -> Self {
        let outputs = self.rig.outputs.len();
        for k in 0..self.records.len() {
            let offset = of(k, &self.records[k]);
            for (row, offset) in self.residuals[k].chunks_exact_mut(outputs).zip(offset) {
                row[m] += offset;
            }
        }
        self
    }

    pub fn remainder(&self) -> Remainder<'_> {
        let trial = |k: usize| TrialRemainder {
            name: &self.names[k],
            record: &self.records[k],
            residual: self.residuals[k].clone(),
            counts: &self.counts[k],
            slopes: &self.slopes[k],
            block: &self.blocks[k],
        };
        Remainder { rig: &self.rig, trials: (0..self.records.len()).map(trial).collect(), floor: self.floor }
    }
}

/// Box & Muller, as anywhere.
pub fn normal(random: &mut ChaCha8Rng) -> f64 {
    let radius = (-2.0 * (1.0 - random.random_range(0.0..1.0f64)).ln()).sqrt();
    radius * random.random_range(0.0..TAU).cos()
}

fn record(shape: Shape, random: &mut ChaCha8Rng) -> Record {
    let jitter = 0.04 * shape.step;
    let time: Vec<f64> =
        (0..shape.samples).map(|t| t as f64 * shape.step + jitter * random.random_range(-1.0..1.0)).collect();
    let actuators = (0..shape.actuators).map(|_| wander(&time, random)).collect();
    let contexts =
        (0..shape.contexts).map(|e| if e == 0 { jumps(&time, random) } else { held(&time, random) }).collect();
    Record::new(time, actuators, contexts, vec![])
}

/// Three sines of random frequency and phase, about ±1.5.
fn wander(time: &[f64], random: &mut ChaCha8Rng) -> Vec<f64> {
    let waves: Vec<(f64, f64)> =
        (0..3).map(|_| (random.random_range(0.03..0.25), random.random_range(0.0..TAU))).collect();
    time.iter().map(|t| waves.iter().map(|(f, phase)| 0.6 * (TAU * f * t + phase).sin()).sum()).collect()
}

/// A new level every few seconds, around 0.6.
fn jumps(time: &[f64], random: &mut ChaCha8Rng) -> Vec<f64> {
    let levels: Vec<f64> = (0..1000).map(|_| random.random_range(0.5..0.7)).collect();
    time.iter().map(|t| levels[(t.max(0.0) / 4.0) as usize % levels.len()]).collect()
}

fn held(time: &[f64], random: &mut ChaCha8Rng) -> Vec<f64> {
    vec![random.random_range(0.0..0.05); time.len()]
}

fn slopes(shape: Shape, record: &Record) -> Vec<f64> {
    let mut slopes = Vec::with_capacity(shape.samples * shape.outputs * shape.actuators);
    for t in 0..shape.samples {
        for m in 0..shape.outputs {
            for a in 0..shape.actuators {
                let q = record.actuators[a][t];
                slopes.push(0.2 * (m as f64 + 2.0 * a as f64).cos() + 0.08 * (q + m as f64).sin());
            }
        }
    }
    slopes
}

fn rig(shape: Shape, records: &[Record]) -> Rig {
    let signal = |name: String, unit: &str, of: &dyn Fn(&Record) -> Vec<f64>| {
        let all: Vec<f64> = records.iter().flat_map(of).collect();
        let (low, high) = all.iter().fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(*x), high.max(*x)));
        Signal { name, unit: unit.into(), low, high }
    };
    let contexts = ["throttle", "payload", "pressure", "bend"];
    Rig {
        actuators: (0..shape.actuators)
            .map(|a| signal(format!("q{}", a + 1), "rad", &|r| r.actuators[a].clone()))
            .collect(),
        contexts: (0..shape.contexts).map(|e| signal(contexts[e].into(), "1", &|r| r.contexts[e].clone())).collect(),
        outputs: ["x", "y", "z"][..shape.outputs]
            .iter()
            .map(|name| Signal { name: (*name).into(), unit: "m".into(), low: -1.0, high: 1.0 })
            .collect(),
        throttle: (shape.contexts > 0).then_some(0),
        altitude: None,
        payload: (shape.contexts > 1).then_some(1),
        carried: false,
        arm: None,
        step: shape.step,
        duration: shape.step * shape.samples as f64,
    }
}
