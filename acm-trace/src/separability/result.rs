//! Result of a separability analysis, as written to `separability.json`.

use serde::{Deserialize, Serialize};

use crate::finding::Data;

/// Effects that these data cannot distinguish, as written to `separability.json`.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Separability {
    /// Version of this layout.
    pub format: u32,
    /// Size that every effect was given, in the unit of the errors.
    pub size: f64,
    /// SI unit of the outputs, or `of each range` where they have several.
    pub unit: String,
    /// Names of the effects, with carriers where there are several.
    pub effects: Vec<String>,
    /// `imitated[a][b]`: share of effect a's mean square that effect b (with calibration) can imitate, 0 to 1.
    pub imitated: Vec<Vec<f64>>,
    /// Share that recalibration alone can imitate, one for each effect.
    pub by_recalibration: Vec<f64>,
    /// Groups of effects that cannot be distinguished, each in words with the cheapest experiment that would.
    pub groups: Vec<Group>,
    /// Description of the data.
    pub data: Data,
    /// Version of the program.
    pub version: String,
}

/// Effects that these data cannot distinguish.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Group {
    /// Names of the effects.
    pub effects: Vec<String>,
    /// Experiment in words.
    pub experiment: String,
}
