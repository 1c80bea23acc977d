//! Where there is nothing to learn, the nominal model is what one gets; where there is something, it is learned.
//!
//! The truth is planted: the calibration trial is free of noise and lies in the span of the nominal polynomial, so what
//! other trials have beside that polynomial is the whole residual.

mod campaign;

use acm_datasets::{Series, WindowSpec, windows};
use acm_models::burn::tensor::Device;
use acm_models::{GruConfig, Keep, NetworkConfig};
use acm_train::config::{OutputLayer, TrainingConfig};
use acm_train::learn::{Control, Fitted, Scalers, Task, WindowSet, fit, predict};
use acm_train::run::evaluation::verdict::{self, Answer};
use acm_train::run::record::{RunRecord, Stage};
use campaign::{Campaign, inputs};
use nalgebra::DMatrix;
use std::path::Path;

/// Folds, a rate that overfits within the epochs, and a final run.
const EDITS: [&str; 12] = [
    "--set",
    "protocol.cross_validation=true",
    "--set",
    "protocol.seeds=[1]",
    "--set",
    "training.epochs=30",
    "--set",
    "training.learning_rate=0.01",
    "--set",
    "network.units=8",
    "--set",
    "training.patience=0",
];

/// Uniform on [−1, 1), by splitmix64.
fn noise(index: usize) -> f64 {
    let mut z = (index as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ (z >> 31)) as f64 / (1u64 << 63) as f64 - 1.0
}

/// A polynomial of the actuators, and white noise in all trials but the calibration trial.
fn nothing(trial: usize, k: usize) -> [f64; 3] {
    let [q1, q2, _] = inputs(trial, k);
    let white = |o: usize| if trial == 0 { 0.0 } else { 0.02 * noise(3 * (1000 * trial + k) + o) };
    [0.2 * q1 + white(0), 0.15 * q2 + white(1), 0.05 * q1 * q2 + white(2)]
}

fn learned(campaign: &Campaign, more: &[&str]) -> (Vec<RunRecord>, String) {
    let output = campaign.command(&[&EDITS, more].concat()).assert().success().get_output().clone();
    let records = acm_train::run::record::read_records(&campaign.path("runs/tiny")).unwrap();
    (records, String::from_utf8(output.stdout).unwrap())
}

/// Error on held-out trials as a share of the nominal model's, and the record of the final run.
fn held_out(records: &[RunRecord]) -> (f64, &RunRecord) {
    let last = records.iter().find(|record| record.stage == Stage::Final).unwrap();
    let estimators = &last.held_out.as_ref().unwrap().estimators;
    (estimators["gru"].rmse_total / estimators["nominal"].rmse_total, last)
}

fn answer(records: &[RunRecord]) -> Answer {
    verdict::of(&records.iter().collect::<Vec<_>>()).unwrap().answer
}

#[test]
fn white_noise_is_left_alone_and_the_verdict_says_so() {
    let campaign = Campaign::with(nothing);
    let (records, text) = learned(&campaign, &[]);
    let (ratio, last) = held_out(&records);
    assert!(ratio <= 1.01, "{ratio} times the nominal error, epoch {}, factor {}", last.best_epoch, last.factor);
    assert!(last.best_epoch == 0 || last.factor < 0.2, "epoch {}, factor {}", last.best_epoch, last.factor);
    assert_eq!(last.best_epoch == 0, last.factor == 0.0);
    assert_eq!(answer(&records), Answer::NotWorthIt, "{text}");
    assert!(text.contains("No network is worth it here") && text.contains("Use the nominal model"), "{text}");
    let json = String::from_utf8(campaign.read("runs/tiny/verdict.json")).unwrap();
    assert!(json.contains("\"answer\": \"not_worth_it\""), "{json}");
}

/// The same with an offset of each trial: d2 and d3, which are learned from, have one that d1 and h1 have the other way round.
fn offsets(trial: usize, k: usize) -> [f64; 3] {
    let offset = [0.0, -0.01, 0.01, 0.01, -0.01, 0.01][trial];
    nothing(trial, k).map(|value| value + offset)
}

/// With the rule and with the rule removed.
#[test]
fn offsets_of_trials_are_learned_without_the_rule_alone() {
    let campaign = Campaign::with(offsets);
    let (records, text) = learned(&campaign, &[]);
    let (ratio, last) = held_out(&records);
    assert_eq!((last.best_epoch, ratio), (0, 1.0));
    assert_eq!(answer(&records), Answer::NotWorthIt, "{text}");
    let campaign = Campaign::with(offsets);
    let (records, _) = learned(&campaign, &["--set", "training.output_layer=random"]);
    let (ratio, last) = held_out(&records);
    assert!(ratio > 1.01, "{ratio} times the nominal error");
    assert!(last.epoch_zero.is_none() && last.projections.is_empty() && last.factor == 1.0);
}

#[test]
fn what_can_be_learned_is_worth_it() {
    let campaign = Campaign::new();
    let (records, text) = learned(&campaign, &[]);
    let (ratio, last) = held_out(&records);
    assert!(ratio < 0.8, "{ratio} times the nominal error");
    assert!(last.best_epoch > 0 && last.factor > 0.5, "epoch {}, factor {}", last.best_epoch, last.factor);
    assert_eq!(answer(&records), Answer::WorthIt, "{text}");
    assert!(text.contains("The gru is worth it here"), "{text}");
}

#[test]
fn one_validation_part_says_nothing() {
    let campaign = Campaign::new();
    let (records, text) = learned(&campaign, &["--set", "protocol.cross_validation=false"]);
    assert_eq!(answer(&records), Answer::CannotBeTold);
    assert!(text.contains("cannot be told from 0 folds"), "{text}");
    assert!(text.contains("Set protocol.cross_validation = true"), "{text}");
    let (records, text) = learned(&Campaign::new(), &["--set", r#"protocol.folds=[["d2"]]"#]);
    assert_eq!(answer(&records), Answer::CannotBeTold);
    assert!(text.contains("cannot be told from 1 fold:") && text.contains("protocol.leave_out = \"block\""), "{text}");
}

/// Without a nominal model there is no epoch 0 that could be one.
#[test]
fn a_network_that_learns_the_measurement_starts_as_ever() {
    let campaign = Campaign::new();
    let records = campaign.learn("run", &["--set", "nominal.model=none", "--set", "protocol.seeds=[1]"]);
    assert_eq!(records[0].experiment.training.output_layer, Some(OutputLayer::Random));
    assert!(records[0].epoch_zero.is_none());
}

const LENGTH: usize = 5;

/// One channel, and a residual of `offset` with noise that has nothing to do with it, m.
fn noisy(samples: usize, from: usize, offset: f64) -> Series {
    let time: Vec<f64> = (0..samples).map(|k| 0.1 * k as f64).collect();
    let target = DMatrix::from_fn(samples, 1, |k, _| offset + 0.01 * noise(from + k));
    Series {
        trial: format!("from {from}"),
        nominal: DMatrix::zeros(samples, 1),
        measured: target.clone(),
        segments: vec![0..samples],
        slopes: DMatrix::zeros(0, 0),
        elapsed: vec![0.1; samples],
        inputs: DMatrix::from_fn(samples, 1, |k, _| (0.3 * k as f64).sin()),
        time,
        target,
    }
}

fn fitted(validation: &[Series], checkpoint: Option<&Path>, last: usize) -> (Fitted, WindowSet) {
    let spec = WindowSpec { length: LENGTH, reach: LENGTH, stride: 1 };
    let training = [noisy(150, 0, 0.004), noisy(80, 1000, 0.004)];
    let scalers = Scalers::of(&training);
    let set = |series: &[Series]| WindowSet::new(series, windows(series, &spec), LENGTH, &scalers);
    let (config, device) =
        (NetworkConfig::Gru(GruConfig { units: 8, layers: 1, ..Default::default() }), Device::flex());
    let asked = TrainingConfig {
        epochs: 6,
        batch: 32,
        learning_rate: 5e-3,
        output_layer: Some(OutputLayer::Zero),
        ..TrainingConfig::default()
    };
    let task = Task { network: &config, training: &asked, supervise: Keep::Last, seed: 1, device: &device };
    let (training, validation) = (set(&training), set(validation));
    let stop = &mut |epoch: &acm_train::learn::Epoch| {
        if epoch.epoch >= last { Control::Stop } else { Control::Continue }
    };
    (fit(&task, &training, &validation, checkpoint, stop).unwrap(), validation)
}

/// Oracle: the mean square of the residual itself, in units of the training part's spread, computed here.
#[test]
fn epoch_0_is_the_nominal_model() {
    // Training has an offset that validation has the other way round, so that whatever is learned is worse.
    let validation = [noisy(90, 2000, -0.004)];
    let (fitted, windows) = fitted(&validation, None, usize::MAX);
    assert_eq!((fitted.best_epoch, fitted.factor), (0, 0.0));
    assert!(predict(&fitted.network, &windows).amax() < 1e-9, "it adds nothing");
    let targets: Vec<f64> = [noisy(150, 0, 0.004), noisy(80, 1000, 0.004)]
        .iter()
        .flat_map(|s| s.target.iter().copied().collect::<Vec<_>>())
        .collect();
    let mean = targets.iter().sum::<f64>() / 230.0;
    let variance = targets.iter().map(|t| (t - mean).powi(2)).sum::<f64>() / 230.0;
    let left: f64 = (LENGTH - 1..90).map(|k| validation[0].target[(k, 0)].powi(2)).sum::<f64>() / 86.0;
    let loss = fitted.zero.unwrap().validation_loss;
    assert!((loss / (left / variance) - 1.0).abs() < 1e-5, "{loss} and {}", left / variance);
    assert!((fitted.projections[0].residual / left - 1.0).abs() < 1e-5);
}

#[test]
fn a_fit_that_was_interrupted_knows_its_epoch_0() {
    let folder = tempfile::tempdir().unwrap();
    for (name, offset) in [("worse", -0.004), ("better", 0.004)] {
        let validation = [noisy(90, 2000, offset)];
        let path = folder.path().join(format!("{name}.safetensors"));
        let (whole, _) = fitted(&validation, None, usize::MAX);
        for stop in [1, 3] {
            fitted(&validation, Some(&path), stop);
        }
        let (resumed, _) = fitted(&validation, Some(&path), usize::MAX);
        assert_eq!(resumed.network.values(), whole.network.values());
        assert_eq!(
            (resumed.zero, resumed.projections, resumed.best_epoch, resumed.factor.to_bits()),
            (whole.zero, whole.projections, whole.best_epoch, whole.factor.to_bits())
        );
        assert_eq!(resumed.best_epoch == 0, name == "worse");
    }
}
