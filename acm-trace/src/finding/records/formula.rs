//! A formula for the residual that no known effect explains.

use serde::{Deserialize, Serialize};

/// A sparse formula.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Symbolic {
    /// Formula such as `Δq1 = −0.090·q1·q2`.
    pub formula: String,
    /// Cross-validated error with the formula, in the unit of the errors.
    pub error: f64,
    /// Terms of the formula.
    pub terms: Vec<SymbolicTerm>,
}

/// One term of the formula.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SymbolicTerm {
    /// Actuator or output that the term acts on: `Δq1` or `Δx`.
    pub on: String,
    /// Term such as `q1·q2`.
    pub term: String,
    /// Coefficient, SI.
    pub coefficient: f64,
}
