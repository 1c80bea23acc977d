//! Time of a step in C beside the same step in Rust, in turns within one run.
//!
//! ```text
//! cargo run -p acm-export --example speed -- [PARTS.json] [COMPILER [FLAG …]]
//! ```
//!
//! Of the estimator that `acm-eval stream RUN --save PARTS.json` wrote; else CfC with 32 units and a backbone of 64, five
//! channels, an arm with a tip marker: with the arm, and alone.

use std::process::Command;
use std::time::Instant;

use acm_core::{ArmSpec, NominalModel, StrainModel};
use acm_export::{Origin, c99, rehearsal};
use acm_kernels::{Activation, Body, CfcMode, CfcShape, Kernel, Shape};
use acm_stream::{Channel, Estimator, Nominal, Parts, Scaler, Signals, Source, StateRule};

/// Number of runs of each program, whose medians are compared.
const TURNS: usize = 15;
const STEPS: usize = 200_000;

/// Samples that are sent round and round.
const SAMPLES: usize = 512;

fn main() {
    let mut arguments = std::env::args().skip(1).peekable();
    let file = arguments.next_if(|argument| argument.ends_with(".json"));
    let cc = arguments.next().unwrap_or_else(|| "cc".into());
    let given: Vec<String> = arguments.collect();
    let flags = if given.is_empty() { vec!["-O3".into(), "-march=native".into()] } else { given };
    println!("{cc} {}", flags.join(" "));
    println!("{:<20} {:>9} {:>9} {:>7}", "step, ns", "Rust", "C", "C/Rust");
    if let Some(file) = file {
        let bytes = std::fs::read(&file).expect("a file");
        return show("estimator", &Parts::from_json(&bytes).expect("an estimator"), &cc, &flags);
    }
    show("network and arm", &parts(Nominal::Model(arm())), &cc, &flags);
    show("network alone", &parts(Nominal::Model(NominalModel::None { outputs: 3 })), &cc, &flags);
    show(
        "arm alone",
        &Parts { network: nothing(), weights: vec![0.0; 18], ..parts(Nominal::Model(arm())) },
        &cc,
        &flags,
    );
}

fn show(name: &str, parts: &Parts, cc: &str, flags: &[String]) {
    let folder = tempfile::tempdir().expect("a folder");
    let origin = Origin { name: "estimator".into(), source: "the example speed".into(), recorded: None };
    for file in c99::export(parts, &origin).expect("it can be written") {
        std::fs::write(folder.path().join(file.path), file.bytes).expect("a file");
    }
    let samples = rehearsal::samples(parts, SAMPLES);
    let row = |s: &rehearsal::Sample| {
        let numbers = std::iter::once(&s.elapsed).chain(&s.inputs).map(|value| format!("{value:?}"));
        format!("{{ {} }},\n", numbers.collect::<Vec<_>>().join(", "))
    };
    let rows: String = samples.iter().map(row).collect();
    let driver = include_str!("turns.c").replace("@ROWS", &rows).replace("@STEPS", &STEPS.to_string());
    std::fs::write(folder.path().join("turns.c"), driver).expect("a file");
    let program = folder.path().join("turns");
    let built = Command::new(cc)
        .current_dir(folder.path())
        .arg("-std=gnu99")
        .args(flags)
        .args(["estimator.c", "turns.c", "-o"])
        .arg(&program)
        .status();
    assert!(built.expect("the compiler runs").success());
    let (mut rust, mut c) = (vec![], vec![]);
    for _ in 0..TURNS {
        rust.push(turn(parts, &samples));
        let output = Command::new(&program).output().expect("it runs");
        c.push(String::from_utf8_lossy(&output.stdout).trim().parse::<f64>().expect("a number"));
    }
    let [rust, c] = [rust, c].map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[TURNS / 2]
    });
    println!("{name:<20} {rust:>9.0} {c:>9.0} {:>7.2}", c / rust);
}

/// Returns the nanoseconds of a step.
fn turn(parts: &Parts, samples: &[rehearsal::Sample]) -> f64 {
    let mut estimator = Estimator::new(parts.clone()).expect("parts that fit");
    let mut sum = 0.0;
    let start = Instant::now();
    for k in 0..STEPS {
        let sample = &samples[k % SAMPLES];
        sum += estimator.step(&sample.inputs, sample.elapsed).expect("a sample")[0];
    }
    let time = start.elapsed().as_secs_f64() * 1e9 / STEPS as f64;
    assert!(sum.is_finite());
    time
}

fn arm() -> NominalModel {
    let model = StrainModel::new(&ArmSpec { length: 0.6, ..ArmSpec::default() }, 2, &[1.0]).expect("an arm");
    let theta: Vec<f64> = (0..model.parameters().len()).map(|j| 0.5 * (1.7 * j as f64).sin()).collect();
    NominalModel::Strain(model.with_parameters(&theta))
}

/// Returns a network that adds nothing.
fn nothing() -> Shape {
    Shape {
        body: Body::Mlp(acm_kernels::MlpShape { hidden: vec![], activation: Activation::Tanh }),
        inputs: 5,
        outputs: 3,
    }
}

fn parts(nominal: Nominal) -> Parts {
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
        ranges: None,
        inputs: Scaler { mean: vec![0.0, 0.0, 0.0, 0.5, 1.0], spread: vec![0.4, 0.3, 0.5, 0.1, 0.4] },
        targets: Scaler { mean: vec![0.0; 3], spread: vec![0.02; 3] },
        weights: (0..parameters).map(|j| 0.2 * (1.3 * j as f32).sin()).collect(),
        network,
        factor: 0.8,
        straight: vec![],
        members: vec![],
        actuators: vec![],
        interval: None,
        labels: None,
        max_gap: 0.5,
        first_elapsed: 1e-3,
        state: StateRule::Running,
    }
}
