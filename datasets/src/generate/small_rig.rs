//! A small rig as a data set: table, manifest, and a sealed truth file.

use super::store::write_json;
use super::undeclared::store::{TABLE, TRUTH, write_manifest};
use super::undeclared::{hash, role};
use crate::Campaign;
use crate::error::DataError;
use crate::files::table::{Column, write_parquet};
use crate::manifest::{Manifest, Measured, Roles, Signal, Table, Time, TrialName};
use crate::trial::Trial;
use acm_sim::small_rigs::{self, Oracle, Recorded, SimTrial};
use nalgebra::DMatrix;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The data set as [`Campaign::read`] would give it, but for the folder, which is empty, and the hash, which is over the
/// numbers and not over files.
pub fn campaign(recorded: &Recorded) -> Campaign {
    let trials: Vec<Trial> = recorded.trials.iter().map(trial).collect();
    let hash = hash(&trials);
    Campaign {
        manifest: manifest(recorded),
        trials,
        hash,
        warnings: vec![],
        folder: PathBuf::new(),
        alignments: vec![],
    }
}

/// Writes the data set; the same rig gives the same bytes.
///
/// # Errors
/// The file system.
pub fn write(recorded: &Recorded, oracle: &Oracle, folder: &Path) -> Result<(), DataError> {
    let sealed = folder.join(TRUTH);
    if let Some(parent) = sealed.parent() {
        std::fs::create_dir_all(parent).map_err(|e| DataError::file_system("create", parent, &e))?;
    }
    write_parquet(&folder.join(TABLE), &columns(recorded))?;
    write_manifest(&manifest(recorded), "Simulated.", folder)?;
    write_json(&truth(recorded, oracle), &sealed)
}

fn trial(trial: &SimTrial) -> Trial {
    let matrix =
        |columns: &[Vec<f64>]| DMatrix::from_fn(trial.time.len(), columns.len(), |row, column| columns[column][row]);
    Trial {
        name: trial.name.clone(),
        role: role(trial.role),
        time: trial.time.clone(),
        actuators: matrix(&trial.actuators),
        context: matrix(&trial.contexts),
        measured: matrix(&trial.outputs),
        predicted: None,
        vehicle: None,
        conditions: BTreeMap::new(),
        dropped: BTreeMap::new(),
        file: TABLE.into(),
        unmeasured: None,
    }
}

fn manifest(recorded: &Recorded) -> Manifest {
    let signals = |signals: &[small_rigs::Signal]| -> Vec<Signal> {
        let one = |s: &small_rigs::Signal| Signal { column: s.name.clone(), unit: s.unit.clone(), ..Signal::default() };
        signals.iter().map(one).collect()
    };
    let output =
        |s: &small_rigs::Signal| Measured { column: s.name.clone(), unit: s.unit.clone(), ..Measured::default() };
    let of = |wanted| recorded.trials(wanted).map(|trial| trial.name.clone()).collect();
    Manifest {
        name: recorded.name.clone(),
        title: recorded.title.clone(),
        licence: "CC0-1.0".into(),
        source: format!("the simulator of this project (acm-datasets {})", env!("CARGO_PKG_VERSION")).into(),
        synthetic: true,
        table: Table {
            files: vec![TABLE.into()],
            ignore: vec!["sealed/*".into()],
            trial: TrialName { column: Some("trial".into()), file: None },
            time: Time { column: Some("t".into()), unit: Some("s".into()), rate_hz: None },
            ..Table::default()
        },
        actuator: signals(&recorded.actuators),
        context: signals(&recorded.contexts),
        measured: recorded.outputs.iter().map(output).collect(),
        roles: Roles {
            development: of(small_rigs::Role::Development),
            held_out: of(small_rigs::Role::HeldOut),
            ..Roles::default()
        },
        ..Manifest::default()
    }
}

/// Columns of the table, trials below each other.
fn columns(recorded: &Recorded) -> Vec<(String, Column)> {
    let trials = &recorded.trials;
    let names = trials.iter().flat_map(|trial| std::iter::repeat_n(trial.name.clone(), trial.time.len()));
    let numbers = |of: &dyn Fn(&SimTrial) -> Vec<f64>| Column::Number(trials.iter().flat_map(of).collect());
    let mut all = vec![
        ("trial".to_string(), Column::Text(names.collect())),
        ("t".to_string(), numbers(&|trial| trial.time.clone())),
    ];
    let kinds: [(&[small_rigs::Signal], fn(&SimTrial) -> &Vec<Vec<f64>>); 3] = [
        (&recorded.actuators, |trial| &trial.actuators),
        (&recorded.contexts, |trial| &trial.contexts),
        (&recorded.outputs, |trial| &trial.outputs),
    ];
    for (signals, columns) in kinds {
        for (k, signal) in signals.iter().enumerate() {
            all.push((signal.name.clone(), numbers(&|trial| columns(trial)[k].clone())));
        }
    }
    all
}

/// Causes with their true values, noise, and what a fit that knows the structure is left with.
fn truth(recorded: &Recorded, oracle: &Oracle) -> Value {
    let cause = |(cause, separable): (&small_rigs::Cause, &bool)| {
        let value = |v: &small_rigs::Value| json!({ "name": v.name, "value": v.value, "unit": v.unit });
        json!({
            "mechanism": cause.mechanism,
            "effect": cause.counterpart.as_ref().map(|c| &c.effect),
            "signal": cause.counterpart.as_ref().and_then(|c| c.signal.as_ref()),
            "parameters": cause.parameters.iter().map(value).collect::<Vec<Value>>(),
            "separable": separable,
        })
    };
    json!({
        "rig": recorded.name,
        "causes": recorded.truth.causes.iter().zip(&oracle.separable).map(cause).collect::<Vec<Value>>(),
        "noise": recorded.truth.noise,
        "oracle_error": oracle.error,
    })
}
