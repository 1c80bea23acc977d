//! The remaining residual: probes, events, autocorrelation, and effects that were not tried.

use serde::{Deserialize, Serialize};

/// The remaining residual.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Left {
    /// Remaining error √(after² − floor²) on development trials, cross-validated.
    pub rms: f64,
    /// Probe whether recorded inputs predict the remaining residual on blocks left out.
    pub probe: Option<Probe>,
    /// Probe by a small recurrent network: [`crate::diagnose::recurrent`].
    pub network: Option<Probe>,
    /// Signatures of events that do not transfer between trials.
    pub events: Vec<Event>,
    /// Autocorrelation of the residual.
    pub autocorrelation: Autocorrelation,
    /// Names of effects that were not tried, with the reason.
    pub not_tried: Vec<NotTried>,
}

/// Ridge regression on features with memory or on the states of a network, compared with the same regression on
/// residuals shifted in time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Probe {
    /// Share of the variance explained on blocks left out.
    pub explained: f64,
    /// 95 % quantile of `explained` on shifted residuals.
    pub by_chance: f64,
    /// Share of shifted residuals that are explained at least as well.
    pub p: f64,
    /// Root mean square of the explained part, in the unit of the errors.
    pub rms: f64,
}

impl Probe {
    /// Returns whether the probe explains more than it would by chance in one case of twenty.
    pub fn finds(&self) -> bool {
        self.p < 0.05 && self.explained > self.by_chance
    }
}

/// Event that happened once, or that no input explains.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Kind: `slip`, `spectral line`, `offset of one trial`, `offset of each trial`.
    pub kind: String,
    /// Share of the variance above the noise that it explains.
    pub share: f64,
    /// Trial, time and size, in words.
    pub what: String,
}

/// Autocorrelation of the residual, mean over outputs and trials.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Autocorrelation {
    /// Lags, s.
    pub lag: Vec<f64>,
    /// Autocorrelation of the nominal residual.
    pub before: Vec<f64>,
    /// Autocorrelation of the final residual.
    pub after: Vec<f64>,
    /// Bound within which white noise stays in 95 % of lags.
    pub white: f64,
}

/// An effect that was not tried.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NotTried {
    /// Stable name.
    pub name: String,
    /// Reason: `needs a strain model`, `needs a throttle signal`, ….
    pub reason: String,
}
