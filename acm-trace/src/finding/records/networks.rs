//! The table with networks: nominal, with effect, with network, with both.

use serde::{Deserialize, Serialize};

/// One row of the table with networks; errors on held-out trials at identical time stamps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NetworkRow {
    /// Name of the model: `nominal`, `nominal + effect`, `nominal + network`, `nominal + effect + network`.
    pub model: String,
    /// Mean over seeds.
    pub error: f64,
    /// Standard deviation over seeds, where there are several.
    pub sd: Option<f64>,
}
