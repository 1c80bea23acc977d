//! Models that the search compared.

use serde::{Deserialize, Serialize};

/// One model of the search.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Step {
    /// Name of the model: `nominal`, `+ backlash`, `− actuator_lag`, `payload → tip_load`.
    pub model: String,
    /// Cross-validated error on development trials.
    pub error: f64,
    /// Improvement in standard errors of the paired difference.
    pub significance: Option<f64>,
    /// Relative reduction of the cross-validated mean square.
    pub gain: Option<f64>,
    /// Largest gain that any candidate reaches by chance in 99 % of cases.
    pub by_chance: Option<f64>,
    /// Whether it was accepted.
    pub accepted: bool,
    /// Results of every candidate of this step that was fitted, best first.
    pub candidates: Vec<Candidate>,
}

/// One candidate of a step.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Candidate {
    /// Stable name, with the carrier where there are several.
    pub name: String,
    /// Cross-validated error on development trials.
    pub error: f64,
}
