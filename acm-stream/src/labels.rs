//! Names and units of the numbers of a sample and of an answer, for people and for exports.
//!
//! An estimator takes and returns SI units. A manifest may have others:
//!
//! ```text
//! value in SI = factor · value + offset
//! ```

use serde::{Deserialize, Serialize};

/// Labels of all inputs and outputs of an estimator, in order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Labels {
    /// One for each input of a sample.
    pub inputs: Vec<Label>,
    /// One for each output of an answer.
    pub outputs: Vec<Label>,
}

/// Name and unit of one number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Label {
    /// Name of the signal.
    pub name: String,
    /// Name of its column, where that is another.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub column: Option<String>,
    /// SI unit, in which the estimator takes or returns the number; empty where it is not known.
    pub si: String,
    /// Unit in the manifest; none where it is the SI unit, or not known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub manifest: Option<ManifestUnit>,
}

/// A unit of a manifest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ManifestUnit {
    /// Name of the unit.
    pub unit: String,
    /// Number of SI units in one of this unit.
    pub factor: f64,
    /// SI value of 0 of this unit.
    #[serde(default)]
    pub offset: f64,
}

impl Label {
    /// Returns a label of which only the name and the SI unit are known.
    pub fn in_si(name: impl Into<String>, si: impl Into<String>) -> Self {
        Self { name: name.into(), column: None, si: si.into(), manifest: None }
    }
}
