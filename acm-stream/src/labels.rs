//! Names and units of the numbers of a sample and of an answer, for people and for exports.
//!
//! An estimator takes and returns SI units. A manifest may have others:
//!
//! ```text
//! value in SI = factor · value + offset
//! ```

use acm_core::rig::Signal;
use serde::{Deserialize, Serialize};

use crate::nominal::Nominal;
use crate::parts::Parts;

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

impl Parts {
    /// Returns the labels; where the parts have none, those of the nominal model's signals.
    pub fn labelled(&self) -> Labels {
        self.labels.clone().unwrap_or_else(|| Labels { inputs: self.input_labels(), outputs: self.output_labels() })
    }

    fn input_labels(&self) -> Vec<Label> {
        let signals = self.signals.actuators.iter().chain(&self.signals.contexts);
        let known: Vec<&Signal> = match &self.nominal {
            Nominal::Augmented(model) => model.rig().actuators.iter().chain(&model.rig().contexts).collect(),
            _ => vec![],
        };
        let unit = |k: usize| known.get(k).map_or("", |signal| signal.unit.as_str());
        let mut all: Vec<Label> = signals.enumerate().map(|(k, name)| Label::in_si(name, unit(k))).collect();
        let axes = ["x", "y", "z"].iter().take(self.nominal.acceleration());
        all.extend(axes.map(|axis| Label::in_si(format!("acceleration_{axis}"), "m/s^2")));
        all.extend((0..self.nominal.predicted()).map(|o| self.output_label(o)));
        all
    }

    fn output_labels(&self) -> Vec<Label> {
        self.tip.clone().map(|o| self.output_label(o)).collect()
    }

    fn output_label(&self, o: usize) -> Label {
        let known = match &self.nominal {
            Nominal::Augmented(model) => model.rig().outputs.get(o),
            _ => None,
        };
        known.map_or_else(|| Label::in_si(format!("output_{o}"), ""), |signal| Label::in_si(&signal.name, &signal.unit))
    }
}
