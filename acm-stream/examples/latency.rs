//! Latency of a step on a robot: a million samples, one by one, or the number given as argument.
//!
//! ```text
//! cargo run -p acm-stream --example latency -- [SAMPLES]
//! ```
//!
//! CfC with 32 units and a backbone of 64, five channels, a Legendre arm with a tip marker: alone, and with effects; and the
//! same network over windows of 50 samples, as it is scored.

use std::time::Instant;

use acm_core::augmented::AugmentedModel;
use acm_core::effects::{Carrier, find, instance::Instance};
use acm_core::rig::{Mounting, Rig, Signal};
use acm_core::{ArmSpec, NominalModel, StrainModel};
use acm_kernels::{Activation, Body, CfcMode, CfcShape, Kernel, Shape};
use acm_stream::{Channel, ChannelRange, Estimator, Nominal, Parts, Scaler, Signals, Source, StateRule};
use nalgebra::Vector3;

const SAMPLES: usize = 1_000_000;

/// Factor between the number of samples and the number that is answered over windows, which are slower.
const WINDOW: usize = 20;

/// Time step of a loop at 1 kHz, s.
const STEP: f64 = 1e-3;

fn main() {
    let asked = std::env::args().nth(1).map(|text| text.parse().expect("a number of samples"));
    let samples = asked.unwrap_or(SAMPLES).max(WINDOW);
    println!("{:<34} {:>8} {:>8} {:>8} {:>10}", "step, µs", "median", "p99", "p99.9", "worst");
    let (arm, effects) = (|| Nominal::Model(arm()), || Nominal::Augmented(with_effects()));
    show("network and arm", parts(arm(), StateRule::Running), samples);
    show("network, arm and seven effects", parts(effects(), StateRule::Running), samples);
    show("network over 50 samples, and arm", parts(arm(), StateRule::Window(50)), samples / WINDOW);
    show("network alone", parts(Nominal::Model(NominalModel::None { outputs: 3 }), StateRule::Running), samples);
}

fn show(name: &str, parts: Parts, samples: usize) {
    let mut estimator = Estimator::new(parts).expect("parts that fit");
    let mut times = Vec::with_capacity(samples);
    let mut sum = 0.0;
    for k in 0..samples {
        let t = STEP * k as f64;
        let inputs = [0.6 * (1.3 * t).sin(), 0.4 * (0.7 * t).cos(), 0.5 + 0.1 * (0.3 * t).sin(), 1.0 + 0.5 * t.sin()];
        let start = Instant::now();
        let tip = estimator.step(&inputs, STEP).expect("a sample");
        times.push(start.elapsed().as_nanos() as u64);
        sum += tip[0];
    }
    times.sort_unstable();
    let at = |share: f64| times[((samples - 1) as f64 * share) as usize] as f64 / 1e3;
    assert!(sum.is_finite());
    println!("{name:<34} {:>8.2} {:>8.2} {:>8.2} {:>10.1}", at(0.5), at(0.99), at(0.999), at(1.0));
}

fn arm() -> NominalModel {
    let model = StrainModel::new(&ArmSpec { length: 0.6, ..ArmSpec::default() }, 2, &[1.0]).expect("an arm");
    let theta: Vec<f64> = (0..model.parameters().len()).map(|j| 0.5 * (1.7 * j as f64).sin()).collect();
    NominalModel::Strain(model.with_parameters(&theta))
}

fn rig() -> Rig {
    let signal = |name: &str, low, high| Signal { name: name.into(), unit: "1".into(), low, high };
    Rig {
        actuators: vec![signal("q1", -0.6, 0.6), signal("q2", -0.4, 0.4)],
        contexts: vec![signal("throttle", 0.4, 0.6), signal("altitude", 0.5, 1.5)],
        outputs: ["x", "y", "z"].map(|name| signal(name, -0.5, 0.5)).to_vec(),
        throttle: Some(0),
        altitude: Some(1),
        payload: None,
        carried: false,
        arm: Some(Mounting { length: 0.6, down: -Vector3::z() }),
        step: 0.1,
        duration: 60.0,
    }
}

fn with_effects() -> AugmentedModel {
    let rig = rig();
    let term = |(name, carrier): (&str, Carrier)| {
        let instance = Instance::new(find(name).expect("an effect"), carrier, &rig);
        let guesses = instance.initial_guesses(&rig);
        instance.term(&guesses[guesses.len() / 2])
    };
    let effects = [
        ("dead_time", Carrier::Rig),
        ("backlash", Carrier::Rig),
        ("actuator_lag", Carrier::Rig),
        ("creep", Carrier::Rig),
        ("tip_load", Carrier::Rig),
        ("wake_lag", Carrier::Context(0)),
        ("misregistration", Carrier::Rig),
    ];
    AugmentedModel::new(rig.clone(), arm(), None, None, effects.map(term).to_vec()).expect("a model")
}

fn parts(nominal: Nominal, state: StateRule) -> Parts {
    let (mode, activation) = (CfcMode::Default, Activation::LecunTanh);
    let body = Body::Cfc(CfcShape { units: 32, mode, backbone_units: 64, backbone_layers: 1, activation });
    let network = Shape { body, inputs: 5, outputs: 3 };
    let parameters = Kernel::new(&network).expect("a network").parameters();
    let channel = |source, rate| Channel { source, rate };
    Parts {
        signals: Signals {
            actuators: vec!["q1".into(), "q2".into()],
            contexts: vec!["throttle".into(), "altitude".into()],
        },
        nominal,
        tip: 0..3,
        channels: vec![
            channel(Source::Actuator(0), false),
            channel(Source::Actuator(1), false),
            channel(Source::Actuator(0), true),
            channel(Source::Context(0), false),
            channel(Source::Context(1), false),
        ],
        ranges: Some(vec![ChannelRange { low: -1.0, high: 2.0 }; 5]),
        inputs: Scaler { mean: vec![0.0, 0.0, 0.0, 0.5, 1.0], spread: vec![0.4, 0.3, 0.5, 0.1, 0.4] },
        targets: Scaler { mean: vec![0.0; 3], spread: vec![0.02; 3] },
        weights: (0..parameters).map(|j| 0.2 * (1.3 * j as f32).sin()).collect(),
        network,
        members: vec![],
        interval: None,
        labels: None,
        actuators: vec![],
        factor: 1.0,
        straight: vec![],
        max_gap: 0.5,
        first_elapsed: STEP,
        state,
    }
}
