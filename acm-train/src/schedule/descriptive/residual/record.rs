//! `study.json` of a residual study. Lengths are metres.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::asked::Asked;
use crate::{
    config::{Experiment, Kind},
    run::record::{DataStamp, NominalSource, Versions},
    schedule::descriptive::{rms::Rms, sweep::Signal},
};

/// The whole record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ResidualStudy {
    /// Version of this format.
    pub format: u32,
    /// Kind of the study: `residual`.
    pub kind: Kind,
    /// Question of the study.
    pub question: String,
    /// Name of the file of the study.
    pub config: String,
    /// Configuration of the study.
    pub asked: Asked,
    /// The base experiment, defaults included.
    pub experiment: Experiment,
    /// Origin of the data.
    pub data: DataStamp,
    /// Versions of the code.
    pub versions: Versions,
    /// Trials that the nominal model was calibrated on.
    pub calibrated_on: Vec<String>,
    /// Source of the nominal prediction.
    pub nominal: NominalSource,
    /// Names of the outputs, in order.
    pub outputs: Vec<String>,
    /// The actuators, in order.
    pub actuators: Vec<Signal>,
    /// Index of the swept actuator among them.
    pub swept: usize,
    /// Middle of the swept actuator's range over the trials described, from which q* is counted, SI.
    pub middle: f64,
    /// Root mean square residual of all samples.
    pub overall: Rms,
    /// Errors by role.
    pub roles: Vec<RoleErrors>,
    /// Trial by trial, in the order of the data.
    pub trials: Vec<TrialResidual>,
    /// Groups by rising altitude; empty where none is recorded.
    pub altitudes: Vec<AltitudeGroup>,
    /// Slices by rising value of the held actuators.
    pub slices: Vec<Slice>,
    /// Backbones of the nominal model with the mean residual at their tips.
    pub backbones: Vec<Backbone>,
    /// SHA-256 of each table of predictions, by its name.
    pub tables: BTreeMap<String, String>,
    /// Caveats, and parts that were left out, with reasons.
    pub notes: Vec<String>,
}

/// Residual of the trials of one role.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RoleErrors {
    /// Role: `development`, `held_out`, …
    pub role: String,
    /// Names of its trials.
    pub trials: Vec<String>,
    /// Root mean squares.
    pub rms: Rms,
}

/// Residual of one trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrialResidual {
    /// Name of the trial.
    pub trial: String,
    /// Role of the trial.
    pub role: String,
    /// Mean altitude, m.
    pub altitude: Option<f64>,
    /// Index of its slice.
    pub slice: usize,
    /// Mean of each component, which a constant correction would remove.
    pub mean: Vec<f64>,
    /// Root mean squares.
    pub rms: Rms,
}

/// Trials at one altitude.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AltitudeGroup {
    /// Mean over all samples, m.
    pub altitude: f64,
    /// Names of its trials.
    pub trials: Vec<String>,
    /// Root mean squares.
    pub rms: Rms,
}

/// Trials that hold the same configuration.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Slice {
    /// Mean of every actuator; the swept one at the middle of its range in the slice.
    pub actuators: Vec<f64>,
    /// Names of its trials.
    pub trials: Vec<String>,
    /// Root mean squares.
    pub rms: Rms,
    /// Bins with enough samples, by rising q.
    pub bins: Vec<SliceBin>,
}

/// Residual in one bin of the swept actuator.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SliceBin {
    /// Mean of the swept actuator, not centred.
    pub q: f64,
    /// Number of samples.
    pub samples: usize,
    /// Mean residual by component.
    pub mean: Vec<f64>,
    /// Sample standard deviation by component: the spread of samples, not the uncertainty of the mean.
    pub sd: Vec<f64>,
}

/// The nominal arm at one place of a slice.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Backbone {
    /// Index of the slice.
    pub slice: usize,
    /// Index of the bin in the slice, whose mean residual belongs to the tip.
    pub bin: usize,
    /// Points from base to tip in the measurement frame, m.
    pub points: Vec<[f64; 3]>,
}
