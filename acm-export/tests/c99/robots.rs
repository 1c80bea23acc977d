//! A robot of two actuators, two contexts and an arm with two markers; networks of every kind.

use acm_core::effects::{Carrier, find, instance::Instance, instance::Term};
use acm_core::rig::{Mounting, Rig, Signal};
use acm_core::strain::StrainBasis;
use acm_core::{ArmSpec, NominalModel, StrainModel, augmented::AugmentedModel, axis::Axis};
use acm_kernels::{Activation, Body, CfcMode, CfcShape, GruShape, Kernel, MlpShape, Shape};
use acm_stream::{Channel, ChannelRange, Nominal, Parts, Scaler, Signals, Source, StateRule};
use nalgebra::Vector3;

pub fn cfc(units: usize, mode: CfcMode, backbone_layers: usize, activation: Activation) -> Body {
    Body::Cfc(CfcShape { units, mode, backbone_units: 12, backbone_layers, activation })
}

pub fn small() -> Body {
    cfc(3, CfcMode::Default, 1, Activation::LecunTanh)
}

pub fn bodies() -> Vec<Body> {
    let mut all: Vec<Body> = [CfcMode::Default, CfcMode::NoGate, CfcMode::Pure]
        .into_iter()
        .flat_map(|mode| [0, 1, 2].map(|layers| cfc(9, mode, layers, Activation::LecunTanh)))
        .collect();
    all.extend(Activation::ALL.map(|activation| cfc(32, CfcMode::Default, 1, activation)));
    all.extend([1, 3].map(|layers| Body::Gru(GruShape { units: 7, layers })));
    all.push(Body::Gru(GruShape { units: 16, layers: 1 }));
    all.extend(
        [vec![], vec![9], vec![40, 5]].map(|hidden| Body::Mlp(MlpShape { hidden, activation: Activation::Tanh })),
    );
    all.extend(Activation::ALL.map(|activation| Body::Mlp(MlpShape { hidden: vec![11, 6], activation })));
    all
}

/// Weights without a pattern, of a size at which a state matters for a while and nothing saturates: wide networks have
/// smaller ones, or their state would amplify what is rounded.
fn weights(count: usize) -> Vec<f32> {
    let size = if count > 1000 { 0.5 } else { 1.0 };
    (1..=count).map(|j| size * ((j * 2_654_435_761 % 1_000_003) as f32 / 1_000_003.0 - 0.5)).collect()
}

/// The same with `count` networks, whose weights differ.
pub fn ensemble(one: Parts, count: usize) -> Parts {
    let other = |k: usize| one.weights.iter().map(|weight| weight * (1.0 - 0.3 * k as f32)).collect();
    Parts { members: (1..count).map(other).collect(), ..one }
}

pub fn arm(strain: StrainBasis, axis: Axis, at: &[f64]) -> StrainModel {
    let arm = ArmSpec { length: 0.6, strain, axis, ..ArmSpec::default() };
    let model = StrainModel::new(&arm, 2, at).expect("an arm");
    let theta: Vec<f64> = (0..model.parameters().len()).map(|j| 0.5 * (1.7 * j as f64 + 0.3).sin()).collect();
    model.with_parameters(&theta)
}

pub fn hanging() -> NominalModel {
    NominalModel::Strain(arm(StrainBasis::default(), Axis::MinusZ, &[0.5, 1.0]))
}

pub fn rig() -> Rig {
    let signal = |name: &str, unit: &str, low, high| Signal { name: name.into(), unit: unit.into(), low, high };
    Rig {
        actuators: vec![signal("q1", "rad", -0.6, 0.7), signal("q2", "m", -0.4, 0.5)],
        contexts: vec![signal("throttle", "1", 0.1, 0.6), signal("altitude", "m", 0.2, 1.5)],
        outputs: ["x1", "y1", "z1", "x2", "y2", "z2"].map(|name| signal(name, "m", -0.5, 0.5)).to_vec(),
        throttle: Some(0),
        altitude: Some(1),
        payload: None,
        carried: true,
        arm: Some(Mounting { length: 0.6, down: Vector3::new(0.1, -0.2, -1.0).normalize() }),
        step: 0.1,
        duration: 60.0,
    }
}

/// An effect in the middle of where a search would begin.
pub fn term(name: &str, carrier: Carrier, rig: &Rig) -> Term {
    let instance = Instance::new(find(name).expect("an effect"), carrier, rig);
    let guesses = instance.initial_guesses(rig);
    instance.term(&guesses[guesses.len() / 2])
}

pub fn augmented(effects: Vec<Term>) -> AugmentedModel {
    augmented_on(rig(), effects)
}

pub fn augmented_on(rig: Rig, effects: Vec<Term>) -> AugmentedModel {
    AugmentedModel::new(rig, hanging(), None, None, effects).expect("a model")
}

pub fn parts(body: Body, nominal: Nominal, state: StateRule) -> Parts {
    let tip = if nominal.outputs() == 6 { 3..6 } else { 0..3 };
    let network = Shape { body, inputs: 5, outputs: 3 };
    let parameters = Kernel::new(&network).expect("a network").parameters();
    let channel = |source, rate| Channel { source, rate };
    let range = |low, high| ChannelRange { low, high };
    Parts {
        signals: Signals {
            actuators: vec!["q1".into(), "q2".into()],
            contexts: vec!["throttle".into(), "altitude".into()],
        },
        nominal,
        tip,
        channels: vec![
            channel(Source::Actuator(0), false),
            channel(Source::Actuator(1), false),
            channel(Source::Actuator(0), true),
            channel(Source::Context(0), false),
            channel(Source::Context(1), false),
        ],
        ranges: Some(vec![range(-0.6, 0.7), range(-0.4, 0.5), range(-3.0, 3.0), range(0.1, 0.6), range(0.2, 1.5)]),
        inputs: Scaler { mean: vec![0.05, 0.1, 0.0, 0.3, 1.0], spread: vec![0.4, 0.3, 0.5, 0.1, 0.4] },
        targets: Scaler { mean: vec![0.001, 0.0, -0.002], spread: vec![0.02, 0.03, 0.01] },
        weights: weights(parameters),
        network,
        factor: 0.8,
        straight: (0..6).map(|c| (0..3).map(|o| 0.004 * f64::from(c - 2 * o)).collect()).collect(),
        members: vec![],
        actuators: vec![],
        interval: None,
        labels: None,
        max_gap: 0.3,
        first_elapsed: 0.1,
        state,
    }
}
