//! The data of a result.

use serde::{Deserialize, Serialize};

/// Description of the data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Data {
    /// Name of the campaign.
    pub name: String,
    /// Title in one line.
    pub title: String,
    /// SHA-256 of manifest and files.
    pub hash: String,
    /// Whether they are simulated.
    pub synthetic: bool,
    /// Names of the trials that calibrate.
    pub calibration: Vec<String>,
    /// Names of the trials that effects are found on.
    pub development: Vec<String>,
    /// Names of the held-out trials.
    pub held_out: Vec<String>,
}
