//! What a saved model records of its robot, beside the signals of its [`crate::rig::Rig`]: enough to detect that it is used on
//! another one.

use serde::{Deserialize, Serialize};

use crate::axis::Axis;
use crate::strain::StrainBasis;

/// Facts of the data that a model was made from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Origin {
    /// Short name of the data set; the same robot may have others.
    pub data: String,
    /// Specification of a continuum arm, beside its length and the direction of gravity.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub arm: Option<ArmShape>,
    /// Trials that the model was evaluated on: the calibration trials, or the development trials where there are none.
    pub trials: Vec<String>,
    /// Root mean square error of the model on them, one for each output, SI.
    pub rms: Vec<f64>,
    /// Units that the manifest gives the rig's signals; none in files of earlier versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub units: Option<ManifestUnits>,
}

/// Units of a manifest, in the order of the signals of a [`crate::rig::Rig`]. The model itself is in SI units.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManifestUnits {
    /// One for each actuator.
    pub actuators: Vec<String>,
    /// One for each context signal and condition.
    pub contexts: Vec<String>,
    /// One for each output.
    pub outputs: Vec<String>,
}

/// How a continuum arm is modelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArmShape {
    /// Where the straight arm points in the measurement frame.
    pub axis: Axis,
    /// Basis of the bending strains.
    pub strain: StrainBasis,
}
