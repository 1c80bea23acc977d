//! The training loop on a small invented recording.

use std::path::Path;

use acm_datasets::{Series, WindowSpec, windows};
use acm_models::burn::tensor::Device;
use acm_models::{CfcConfig, GruConfig, Keep, MlpConfig, Network, NetworkConfig};
use acm_train::config::Schedule;
use acm_train::learn::checkpoint::{self, Identity};
use acm_train::{
    config::{TrainingConfig, device},
    learn::{Control, Ended, Fitted, LearnError, Scalers, Task, WindowSet, fit, predict},
};
use nalgebra::DMatrix;

const LENGTH: usize = 5;

/// Two channels and a residual that remembers: y_k = 0.7 y_{k−1} + 0.01 u_k v_k, in m, sampled unevenly.
fn recording(samples: usize, phase: f64) -> Series {
    let time: Vec<f64> = (0..samples).map(|k| 0.1 * k as f64 + 0.02 * (1.7 * k as f64).sin()).collect();
    let inputs =
        DMatrix::from_fn(samples, 2, |k, c| 20.0 * c as f64 + (0.3 * k as f64 * (1.0 + c as f64) + phase).sin());
    let mut residual = 0.0;
    let rows: Vec<f64> = (0..samples)
        .map(|k| {
            residual = 0.7 * residual + 0.01 * inputs[(k, 0)] * (inputs[(k, 1)] - 20.0);
            residual
        })
        .collect();
    let target = DMatrix::from_column_slice(samples, 1, &rows);
    let elapsed = (0..samples).map(|k| if k == 0 { 0.1 } else { time[k] - time[k - 1] }).collect();
    Series {
        trial: format!("phase {phase}"),
        nominal: DMatrix::zeros(samples, 1),
        measured: target.clone(),
        segments: vec![0..samples],
        slopes: DMatrix::zeros(0, 0),
        time,
        elapsed,
        inputs,
        target,
    }
}

struct Parts {
    training: WindowSet,
    validation: WindowSet,
    truth: Vec<f64>,
}

fn parts() -> Parts {
    let spec = WindowSpec { length: LENGTH, reach: LENGTH, stride: 1 };
    let (training, validation) = ([recording(150, 0.0), recording(80, 1.0)], [recording(90, 2.0)]);
    let scalers = Scalers::of(&training);
    let set = |series: &[Series]| WindowSet::new(series, windows(series, &spec), LENGTH, &scalers);
    let truth = windows(&validation, &spec).iter().map(|w| validation[0].target[(w.end, 0)]).collect();
    Parts { training: set(&training), validation: set(&validation), truth }
}

fn networks() -> [NetworkConfig; 3] {
    [
        NetworkConfig::Mlp(MlpConfig { hidden: vec![16], ..MlpConfig::default() }),
        NetworkConfig::Gru(GruConfig::default().with_units(8)),
        NetworkConfig::Cfc(CfcConfig { units: 8, backbone_units: 12, ..CfcConfig::default() }),
    ]
}

fn short() -> TrainingConfig {
    TrainingConfig { epochs: 4, batch: 32, learning_rate: 5e-3, ..TrainingConfig::default() }
}

fn fitted(network: &NetworkConfig, training: &TrainingConfig, seed: u64, checkpoint: Option<&Path>) -> Fitted {
    until(network, training, seed, checkpoint, usize::MAX).unwrap()
}

/// Asks to stop after epoch `last`.
fn until(
    network: &NetworkConfig,
    training: &TrainingConfig,
    seed: u64,
    checkpoint: Option<&Path>,
    last: usize,
) -> Result<Fitted, LearnError> {
    let device = Device::flex();
    let task = Task { network, training, supervise: Keep::Last, seed, device: &device };
    let parts = parts();
    fit(&task, &parts.training, &parts.validation, checkpoint, &mut |epoch| {
        if epoch.epoch >= last { Control::Stop } else { Control::Continue }
    })
}

fn bits(fitted: &Fitted) -> Vec<u32> {
    let epochs = fitted.epochs.iter().flat_map(|e| [e.train_loss, e.validation_loss]);
    let losses = epochs.flat_map(|loss| [loss.to_bits() as u32, (loss.to_bits() >> 32) as u32]);
    fitted.network.values().iter().map(|v| v.to_bits()).chain(losses).collect()
}

#[test]
fn a_recurrent_network_learns_what_remembers() {
    let training = TrainingConfig { epochs: 60, patience: 0, ..short() };
    for network in &networks()[1..] {
        let fitted = fitted(network, &training, 1, None);
        let parts = parts();
        let predicted = predict(&fitted.network, &parts.validation);
        let square = |values: Vec<f64>| values.iter().map(|v| v * v).sum::<f64>();
        let mean = parts.truth.iter().sum::<f64>() / parts.truth.len() as f64;
        let left = square(parts.truth.iter().zip(predicted.iter()).map(|(t, p)| t - p).collect());
        let all = square(parts.truth.iter().map(|t| t - mean).collect());
        assert!(1.0 - left / all > 0.9, "{}: R² {}", network.kind(), 1.0 - left / all);
        assert_eq!((fitted.ended, fitted.epochs.len()), (Ended::Epochs, 60));
    }
}

/// Oracle: the mean squared error computed here, in the target's own unit, from the restored predictions.
#[test]
fn the_best_epoch_is_restored() {
    let training = TrainingConfig { epochs: 30, learning_rate: 0.05, patience: 0, ..short() };
    let fitted = fitted(&networks()[1], &training, 3, None);
    let best = fitted.epochs.iter().map(|e| e.validation_loss).fold(f64::INFINITY, f64::min);
    assert_eq!(fitted.epochs[fitted.best_epoch - 1].validation_loss, best);
    assert!(fitted.best_epoch < 30, "the test needs a best epoch that is not the last");

    let parts = parts();
    let predicted = predict(&fitted.network, &parts.validation);
    let scalers = Scalers::of(&[recording(150, 0.0), recording(80, 1.0)]);
    let errors = parts.truth.iter().zip(predicted.iter()).map(|(t, p)| ((t - p) / scalers.targets.spread[0]).powi(2));
    let found = errors.sum::<f64>() / parts.truth.len() as f64;
    assert!((found - best).abs() < 1e-5 * best, "{found} {best}");
}

#[test]
fn patience_ends_training_that_number_of_epochs_after_the_best() {
    let training = TrainingConfig { epochs: 500, learning_rate: 0.05, patience: 3, ..short() };
    let fitted = fitted(&networks()[0], &training, 1, None);
    assert_eq!(fitted.ended, Ended::Patience);
    assert_eq!(fitted.epochs.len(), fitted.best_epoch + 3);
}

#[test]
fn every_step_can_be_supervised() {
    let device = Device::flex();
    let training = TrainingConfig { epochs: 25, ..short() };
    let network = &networks()[1];
    let task = Task { network, training: &training, supervise: Keep::Every, seed: 1, device: &device };
    let parts = parts();
    let last_step_alone = fitted(network, &training, 1, None);
    let fitted = fit(&task, &parts.training, &parts.validation, None, &mut |_| Control::Continue).unwrap();
    let (first, last) = (fitted.epochs[0], fitted.epochs[24]);
    assert!(last.validation_loss < 0.3 * first.validation_loss, "{first:?} {last:?}");
    assert_ne!(bits(&fitted), bits(&last_step_alone));
}

#[test]
fn a_seed_decides_all_bits() {
    for network in networks() {
        let once = bits(&fitted(&network, &short(), 1, None));
        assert_eq!(once, bits(&fitted(&network, &short(), 1, None)), "{}", network.kind());
        assert_ne!(once, bits(&fitted(&network, &short(), 2, None)), "{}", network.kind());
    }
}

/// Side by side, and inside pools of one thread and of two.
#[test]
fn threads_decide_none() {
    for network in networks() {
        let alone = bits(&fitted(&network, &short(), 1, None));
        let beside: Vec<Vec<u32>> = std::thread::scope(|scope| {
            let runs: Vec<_> = (1..=3)
                .map(|seed| {
                    scope.spawn({
                        let network = &network;
                        move || bits(&fitted(network, &short(), seed, None))
                    })
                })
                .collect();
            runs.into_iter().map(|run| run.join().unwrap()).collect()
        });
        assert_eq!(alone, beside[0], "{}", network.kind());
        for threads in [1, 2] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let within = pool.install(|| bits(&fitted(&network, &short(), 1, None)));
            assert_eq!(alone, within, "{} with {threads} threads", network.kind());
        }
    }
}

#[test]
fn an_interrupted_fit_ends_in_the_same_bits() {
    let training = TrainingConfig {
        epochs: 6,
        schedule: Schedule::Plateau { patience: 0, factor: 0.5 },
        weight_decay: Some(0.01),
        clip_norm: Some(0.5),
        warm_up: 2,
        ..short()
    };
    let folder = tempfile::tempdir().unwrap();
    for network in networks() {
        let whole = fitted(&network, &training, 1, None);
        let path = folder.path().join(format!("{}.safetensors", network.kind()));
        for stop in [1, 2, 5] {
            let part = until(&network, &training, 1, Some(&path), stop).unwrap();
            assert_eq!((part.ended, part.epochs.len()), (Ended::Asked, stop));
        }
        let resumed = fitted(&network, &training, 1, Some(&path));
        assert_eq!(bits(&resumed), bits(&whole), "{}", network.kind());
        assert_eq!(resumed.best_epoch, whole.best_epoch);
        let again = fitted(&network, &training, 1, Some(&path));
        assert_eq!(bits(&again), bits(&whole), "a finished fit is not trained further");
        assert_eq!(
            std::fs::read_dir(folder.path())
                .unwrap()
                .filter(|e| { !e.as_ref().unwrap().file_name().to_string_lossy().ends_with(".safetensors") })
                .count(),
            0
        );
    }
}

#[test]
fn every_flipped_bit_of_a_checkpoint_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.safetensors");
    let (config, training) = (NetworkConfig::Gru(GruConfig::default().with_units(2)), short());
    until(&config, &training, 1, Some(&path), 1).unwrap();
    let sound = std::fs::read(&path).unwrap();

    let (device, parts) = (Device::flex(), parts());
    let task = Task { network: &config, training: &training, supervise: Keep::Last, seed: 1, device: &device };
    let identity = Identity::new(&task, &parts.training, Some(&parts.validation));
    let network = Network::new(&config, 2, 1, 1, &device);
    assert!(checkpoint::read(&path, &identity, &network).unwrap().is_some());
    let refused = |bytes: &[u8], what: &str| {
        let error = checkpoint::parse(&path, bytes, &identity, &network).expect_err(what);
        assert!(matches!(error, LearnError::Damaged { .. }), "{what}: {error}");
        assert!(error.to_string().contains("run.safetensors") && error.to_string().contains("delete"), "{error}");
    };
    for (byte, bit) in (0..sound.len()).flat_map(|byte| (0..8).map(move |bit| (byte, bit))) {
        let mut bytes = sound.clone();
        bytes[byte] ^= 1 << bit;
        refused(&bytes, &format!("bit {bit} of byte {byte}"));
    }
    for length in [0, 7, 8, 100, sound.len() - 1] {
        refused(&sound[..length], &format!("cut to {length} bytes"));
    }
    refused(&[sound.as_slice(), b"x"].concat(), "one byte more");
}

#[test]
fn the_checkpoint_of_another_run_is_refused_with_what_differs() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.safetensors");
    let network = NetworkConfig::Gru(GruConfig::default().with_units(8));
    until(&network, &short(), 1, Some(&path), 1).unwrap();
    let said = |network: &NetworkConfig, training: &TrainingConfig, seed| {
        let error = until(network, training, seed, Some(&path), 2).expect_err("refused");
        assert!(matches!(error, LearnError::Another { .. }), "{error}");
        assert_eq!(error.exit_code(), 2);
        error.to_string()
    };
    let wider = NetworkConfig::Gru(GruConfig::default().with_units(16));
    assert!(said(&wider, &short(), 1).contains("network.units is 8 there and 16 here"));
    assert!(said(&networks()[2], &short(), 1).contains("network.kind is \"gru\" there and \"cfc\" here"));
    assert!(said(&network, &short(), 2).contains("seed is 1 there and 2 here"));
    let faster = TrainingConfig { learning_rate: 0.5, ..short() };
    assert!(said(&network, &faster, 1).contains("training.learning_rate is 0.005 there and 0.5 here"));
}

#[test]
fn a_loss_without_bounds_is_reported_with_epoch_and_remedy() {
    let training = TrainingConfig { learning_rate: 1e30, ..short() };
    let error = until(&networks()[0], &training, 1, None, usize::MAX).expect_err("diverges");
    let text = error.to_string();
    let LearnError::NotFinite(found) = error else { panic!("{text}") };
    assert!(matches!(found.epoch, 1 | 2) && found.broken == found.windows && !found.trials.is_empty(), "{found:?}");
    assert!(text.contains("epoch") && text.contains("clip_norm") && text.contains("learning_rate"), "{text}");
}

/// One sample of one recording is no number: five windows see it, and they alone are told of.
#[test]
fn a_broken_recording_is_named_with_its_windows() {
    let spec = WindowSpec { length: LENGTH, reach: LENGTH, stride: 1 };
    let (mut series, scalers) = ([recording(150, 0.0), recording(80, 1.0)], Scalers::of(&[recording(150, 0.0)]));
    series[1].inputs[(40, 0)] = f64::NAN;
    let set = WindowSet::new(&series, windows(&series, &spec), LENGTH, &scalers);
    let (device, training) = (device("flex").unwrap(), TrainingConfig { batch: 1000, ..short() });
    for network in &networks()[1..] {
        let task = Task { network, training: &training, supervise: Keep::Last, seed: 1, device: &device };
        let error = fit(&task, &set, &parts().validation, None, &mut |_| Control::Continue).expect_err("no number");
        assert_eq!(error.exit_code(), 3);
        let text = error.to_string();
        assert!(text.contains("epoch 1, batch 1 of 1") && text.contains("acm-data describe"), "{text}");
        let LearnError::NotFinite(found) = error else { panic!("{text}") };
        assert_eq!((found.broken, found.trials), (LENGTH, vec!["trial phase 1".to_string()]), "{text}");
    }
}

#[test]
fn a_part_without_windows_is_named() {
    let scalers = Scalers::of(&[recording(150, 0.0)]);
    let empty = WindowSet::new(&[], Vec::new(), LENGTH, &scalers);
    let device = device("flex").unwrap();
    let (network, training) = (networks()[0].clone(), short());
    let task = Task { network: &network, training: &training, supervise: Keep::Last, seed: 1, device: &device };
    let error = fit(&task, &parts().training, &empty, None, &mut |_| Control::Continue).expect_err("empty");
    assert!(error.to_string().contains("validation"), "{error}");
    assert_eq!(error.exit_code(), 3);
}

#[test]
fn a_checkpoint_that_cannot_be_written_names_its_path() {
    let path = Path::new("no/such/folder/run.safetensors");
    let error = until(&networks()[0], &short(), 1, Some(path), 1).expect_err("no folder");
    assert!(error.to_string().contains("no/such/folder/run.safetensors"), "{error}");
    assert_eq!(error.exit_code(), 4);
}
