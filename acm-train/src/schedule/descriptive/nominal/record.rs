//! `study.json` of a nominal study. Lengths are metres.

use std::collections::BTreeMap;

use acm_core::{Parameter, Stage};
use serde::{Deserialize, Serialize};

use super::asked::Asked;
use crate::{
    config::{Experiment, Kind},
    run::record::{DataStamp, Versions},
    schedule::descriptive::{rms::Rms, sweep::Signal},
};

/// The whole record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NominalStudy {
    /// Version of this format.
    pub format: u32,
    /// Kind of the study: `nominal`.
    pub kind: Kind,
    /// Question of the study.
    pub question: String,
    /// Name of the file of the study.
    pub config: String,
    /// Configuration of the study, with the trial named.
    pub asked: Asked,
    /// The base experiment, defaults included.
    pub experiment: Experiment,
    /// Origin of the data.
    pub data: DataStamp,
    /// Versions of the code.
    pub versions: Versions,
    /// Names of the outputs, in order.
    pub outputs: Vec<String>,
    /// The actuators, in order.
    pub actuators: Vec<Signal>,
    /// Index of the swept actuator among them.
    pub swept: usize,
    /// Middle of the swept actuator's range over the calibration trials, from which q* is counted, SI.
    pub middle: f64,
    /// Study of the strain orders.
    pub orders: OrderStudy,
    /// Rows of the polynomial and strain models on all calibration trials.
    pub models: Vec<ModelRow>,
    /// SHA-256 of each table of predictions, by its name.
    pub tables: BTreeMap<String, String>,
    /// Parts that were left out, with reasons.
    pub notes: Vec<String>,
}

/// Legendre orders on one trial.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OrderStudy {
    /// Name of the trial.
    pub trial: String,
    /// Number of samples of the trial.
    pub samples: usize,
    /// Number of bins that were fitted to: those with enough samples.
    pub bins: usize,
    /// The two outputs that vary most in the trial: the plane of the errors.
    pub plane: [String; 2],
    /// Rows, one per order.
    pub rows: Vec<OrderRow>,
}

/// One order under both protocols.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OrderRow {
    /// Highest Legendre order.
    pub order: usize,
    /// Fit of the strain parameters, with the actuation map from the linear fit.
    pub frozen: Fitted,
    /// Fit of actuation map and strain parameters.
    pub refitted: Fitted,
}

/// Errors of one fit to the bins, in the plane, m.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fitted {
    /// Parameters that were free.
    pub parameters: usize,
    /// Root mean square distance over the bins.
    pub binned: f64,
    /// Root mean square over all samples of the trial.
    pub raw: f64,
}

/// One model on the calibration trials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelRow {
    /// Key `polynomial`, `strain` or `strain_joint`: the start of its columns.
    pub key: String,
    /// Label for people.
    pub label: String,
    /// Identified values, fitted to all calibration trials.
    pub parameters: Vec<Parameter>,
    /// Stages of the fit.
    pub stages: Vec<Stage>,
    /// Errors on the trials that the model was fitted to.
    pub fitted: Errors,
    /// Errors on each trial as predicted by a fit to the others; `None` where that cannot be done.
    pub left_out: Option<Errors>,
}

/// Errors over all trials and on each.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Errors {
    /// Root mean squares over all samples.
    pub all: Rms,
    /// Trial by trial, in the order of the data.
    pub trials: Vec<TrialErrors>,
}

/// Errors on one trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrialErrors {
    /// Name of the trial.
    pub trial: String,
    /// Errors on the trial.
    pub rms: Rms,
}
