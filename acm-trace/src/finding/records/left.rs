//! The remaining residual: probes, events, autocorrelation, and effects that were not tried.

use serde::{Deserialize, Serialize};

/// The remaining residual.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Left {
    /// √(after² − floor²) on development trials, cross-validated.
    pub rms: f64,
    /// Whether recorded inputs predict what is left on blocks left out.
    pub probe: Option<Probe>,
    /// Probe by a small recurrent network: [`crate::diagnose::recurrent`].
    pub network: Option<Probe>,
    /// Signatures of what does not transfer between trials.
    pub events: Vec<Event>,
    /// Correlation of what is left with itself.
    pub autocorrelation: Autocorrelation,
    /// Names of effects that were not tried, with the reason.
    pub not_tried: Vec<NotTried>,
}

/// A ridge regression on features with memory or on the states of a network, against the same on residuals shifted in time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Probe {
    /// Share of the variance explained on blocks left out.
    pub explained: f64,
    /// 95 % quantile of the same on shifted residuals.
    pub by_chance: f64,
    /// Share of shifted residuals that are explained at least as well.
    pub p: f64,
    /// Root mean square of what the probe explains, in the unit of the errors.
    pub rms: f64,
}

impl Probe {
    /// Whether it explains more than it would by chance in one case of twenty.
    pub fn finds(&self) -> bool {
        self.p < 0.05 && self.explained > self.by_chance
    }
}

/// Something that happened once, or that no input carries.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// `slip`, `spectral line`, `offset of one trial`, `offset of each trial`.
    pub kind: String,
    /// Share of the variance over the noise that it explains.
    pub share: f64,
    /// Where, when and how large, in words.
    pub what: String,
}

/// Autocorrelation of the residual, mean over outputs and trials.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Autocorrelation {
    /// s.
    pub lag: Vec<f64>,
    /// Autocorrelation of the nominal residual.
    pub before: Vec<f64>,
    /// Autocorrelation of the final residual.
    pub after: Vec<f64>,
    /// White noise stays within ± this in 95 % of lags.
    pub white: f64,
}

/// An effect that was not tried.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NotTried {
    /// Stable name.
    pub name: String,
    /// `needs a strain model`, `needs a throttle signal`, …
    pub reason: String,
}
