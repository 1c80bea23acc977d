//! Data of the figures of a finding: held-out trials, thinned.

use serde::{Deserialize, Serialize};

/// Data of the figures: held-out trials, thinned.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Figures {
    /// Residual against the signal that carries the effect, one for each effect (at least one: an actuator).
    pub carriers: Vec<CarrierFigure>,
    /// One stretch of a held-out trial.
    pub trace: Option<Trace>,
    /// Error of each held-out trial (or block).
    pub trials: Vec<TrialErrors>,
}

/// Residual against a signal.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct CarrierFigure {
    /// Effect that the signal carries.
    pub effect: String,
    /// Name of the signal on the horizontal axis, such as `q1` or `rate of q1` or `time`.
    pub signal: String,
    /// SI unit.
    pub unit: String,
    /// Output that the effect moves most, such as `x`.
    pub output: String,
    /// Horizontal values `[N]`, in order of time, so that neighbours can be joined to loops.
    pub x: Vec<f64>,
    /// Difference measured − nominal `[N]`, in the unit of the errors.
    pub before: Vec<f64>,
    /// Difference measured − model with effect `[N]`.
    pub after: Vec<f64>,
    /// Whether sample k continues sample k − 1 `[N]`; false starts a new loop.
    pub continues: Vec<bool>,
}

/// Measured and predicted output over time.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Trace {
    /// Name of the trial.
    pub trial: String,
    /// Name of the output.
    pub output: String,
    /// Time stamps, s.
    pub time: Vec<f64>,
    /// Measured values in the unit of the errors.
    pub measured: Vec<f64>,
    /// Prediction of the nominal model.
    pub nominal: Vec<f64>,
    /// Prediction with the effects.
    pub after: Vec<f64>,
}

/// Errors of one held-out trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrialErrors {
    /// Name of the trial.
    pub name: String,
    /// Error of the nominal model.
    pub nominal: f64,
    /// Error of the best baseline.
    pub best_baseline: f64,
    /// Error with the effects.
    pub after: f64,
}
