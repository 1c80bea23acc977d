//! A formula for the residual that no known effect explains.

use serde::{Deserialize, Serialize};

/// A sparse formula.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Symbolic {
    /// Such as `Δq1 = −0.090·q1·q2`.
    pub formula: String,
    /// Cross-validated error with the formula, in the unit of the errors.
    pub error: f64,
    /// One for each term.
    pub terms: Vec<SymbolicTerm>,
}

/// One term of the formula.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SymbolicTerm {
    /// `Δq1` or `Δx`: on which actuator or output it acts.
    pub on: String,
    /// Such as `q1·q2`.
    pub term: String,
    /// SI.
    pub coefficient: f64,
}
