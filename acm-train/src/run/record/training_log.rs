//! `training.log`: a text of the data and the epochs of training.
//!
//! The text is a function of the calibrations and of each run's training alone. It holds no clock, no path and nothing
//! of the held-out trials: two logs are equal, bit for bit, when the learning was. Numbers are written in full.

use std::fmt::Write;

use super::{CalibrationPair, NominalRecord, RunRecord};

/// Returns the log of all runs that are finished, in the order given.
pub fn text(nominal: &NominalRecord, records: &[&RunRecord]) -> String {
    let mut log = format!("data {}\n", nominal.data.name);
    for (group, pair) in &nominal.calibrations {
        log += &calibration(group, pair);
    }
    for record in records {
        log += &run(record);
    }
    log
}

fn calibration(group: &str, pair: &CalibrationPair) -> String {
    let mut log = format!("\ncalibrated on {group}: trials {}\n", pair.trials.join(" "));
    let models = [("nominal", pair.nominal.as_ref()), ("polynomial", Some(&pair.polynomial))];
    for (name, fitted) in models.into_iter().filter_map(|(name, fitted)| fitted.map(|f| (name, f))) {
        let _ = writeln!(log, "  {name}: rms {:?} m of {} samples", fitted.rms_total, fitted.samples);
        for p in &fitted.parameters {
            let _ = writeln!(log, "    {} = {:?} {}", p.name, p.value, p.unit);
        }
    }
    log
}

fn run(record: &RunRecord) -> String {
    let split = &record.split;
    let mut log = format!("\nrun {}\n  learns from {}\n", record.id, split.training.join(" "));
    let _ = writeln!(log, "  epoch chosen on {}", split.validation.join(" "));
    let _ = writeln!(
        log,
        "  {} of {} inputs: {}",
        record.experiment.kind(),
        record.channels.len(),
        record.channels.join(" ")
    );
    let _ = writeln!(
        log,
        "  {} parameters, {} training windows, {} validation windows",
        record.parameters, record.windows.training, record.windows.validation
    );
    if let Some(zero) = &record.epoch_zero {
        let _ = writeln!(log, "  epoch 0 training {:?} validation {:?}", zero.train_loss, zero.validation_loss);
    }
    for e in &record.epochs {
        let _ = writeln!(
            log,
            "  epoch {} rate {:?} training {:?} validation {:?}",
            e.epoch, e.learning_rate, e.train_loss, e.validation_loss
        );
    }
    for (m, member) in record.members.iter().enumerate().skip(1) {
        for e in &member.epochs {
            let _ = writeln!(log, "  member {m} epoch {} validation {:?}", e.epoch, e.validation_loss);
        }
        let _ = writeln!(log, "  member {m} best epoch {}", member.best_epoch);
    }
    let _ = writeln!(log, "  best epoch {}", record.best_epoch);
    if record.epoch_zero.is_some() {
        let _ = writeln!(log, "  factor {:?}", record.factor);
    }
    log
}
