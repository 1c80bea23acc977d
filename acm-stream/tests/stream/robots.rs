//! A robot of two actuators and one context, its network, and a trial with gaps.

use acm_core::NominalModel;
use acm_core::polynomial::Polynomial;
use acm_kernels::{Activation, Body, CfcMode, CfcShape, GruShape, Kernel, MlpShape, Shape};
use acm_stream::{Channel, Estimator, Nominal, Parts, Scaler, Signals, Source, StateRule};
use nalgebra::DMatrix;

/// A longer time between two samples is a gap, s.
pub const MAX_GAP: f64 = 0.3;

/// What the network is told before the first sample, s.
pub const FIRST: f64 = 0.1;

/// Inputs [T][3] and time stamps [T].
pub struct Trial {
    pub time: Vec<f64>,
    pub inputs: Vec<[f64; 3]>,
}

/// Irregular steps of about 0.1 s, with a gap after the 40th sample and after the 47th.
pub fn trial() -> Trial {
    let mut time = vec![];
    let mut now = 2.0;
    for k in 0..130 {
        now += 0.1 + 0.03 * (2.3 * f64::from(k)).sin() + if k == 40 || k == 47 { 0.5 } else { 0.0 };
        time.push(now);
    }
    let at = |t: &f64| [(0.9 * t).sin(), 0.6 * (0.5 * t + 1.0).cos(), 300.0 + 5.0 * (0.2 * t).sin()];
    Trial { inputs: time.iter().map(at).collect(), time }
}

impl Trial {
    /// Stretches of samples without a gap between them.
    pub fn segments(&self) -> [std::ops::Range<usize>; 3] {
        [0..40, 40..47, 47..self.time.len()]
    }

    /// What an estimator answers to each sample.
    pub fn through(&self, estimator: &mut Estimator) -> Vec<Vec<f64>> {
        let elapsed = |t: usize| if t == 0 { f64::NAN } else { self.time[t] - self.time[t - 1] };
        let step = |t: usize| estimator.step(&self.inputs[t], elapsed(t)).expect("a sample").to_vec();
        (0..self.time.len()).map(step).collect()
    }
}

pub fn channels() -> Vec<Channel> {
    let channel = |source, rate| Channel { source, rate };
    vec![
        channel(Source::Actuator(0), false),
        channel(Source::Actuator(1), false),
        channel(Source::Actuator(0), true),
        channel(Source::Context(0), false),
    ]
}

pub fn cfc(units: usize, backbone_units: usize) -> Body {
    Body::Cfc(CfcShape {
        units,
        mode: CfcMode::Default,
        backbone_units,
        backbone_layers: 1,
        activation: Activation::LecunTanh,
    })
}

pub fn bodies() -> Vec<Body> {
    let (gru, mlp) = (GruShape { units: 7, layers: 2 }, MlpShape { hidden: vec![9, 5], activation: Activation::Tanh });
    vec![cfc(8, 12), Body::Gru(gru), Body::Mlp(mlp)]
}

/// The polynomial through a few values; two outputs, of which the second is answered.
pub fn polynomial() -> Polynomial {
    let q = DMatrix::from_fn(40, 2, |t, a| ((0.7 * (a + 1) as f64) * t as f64).sin());
    let y = DMatrix::from_fn(40, 2, |t, o| 0.2 * q[(t, 0)] - 0.1 * q[(t, 1)] * q[(t, o)] + 0.05);
    Polynomial::fit(&q, &y, 2).polynomial
}

/// Weights without a pattern, of a size at which a state matters for a while and nothing saturates.
pub fn weights(count: usize) -> Vec<f32> {
    (1..=count).map(|j| (j * 2_654_435_761 % 1_000_003) as f32 / 1_000_003.0 - 0.5).collect()
}

pub fn parts(body: Body, state: StateRule) -> Parts {
    let network = Shape { body, inputs: 4, outputs: 1 };
    let kernel = Kernel::new(&network).expect("a network");
    Parts {
        signals: Signals { actuators: vec!["q1".into(), "q2".into()], contexts: vec!["temperature".into()] },
        nominal: Nominal::Model(NominalModel::Polynomial(polynomial())),
        tip: 1..2,
        channels: channels(),
        ranges: None,
        inputs: Scaler { mean: vec![0.1, -0.2, 0.0, 300.0], spread: vec![0.7, 0.4, 0.6, 3.0] },
        targets: Scaler { mean: vec![0.002], spread: vec![0.03] },
        weights: weights(kernel.parameters()),
        network,
        members: vec![],
        interval: None,
        labels: None,
        actuators: vec![],
        factor: 1.0,
        straight: vec![],
        max_gap: MAX_GAP,
        first_elapsed: FIRST,
        state,
    }
}
