//! Errors on held-out trials, of the baselines and of the result, and the confirmation.

use acm_core::display::Display;
use serde::{Deserialize, Serialize};

/// A number with its 95 % interval: bootstrap over blocks.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Root mean square error.
    pub value: f64,
    /// Interval of 95 %.
    pub interval: [f64; 2],
}

/// Models without the effects that the result is compared with.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Baselines {
    /// The nominal model as calibrated.
    pub nominal: Estimate,
    /// Error with the static map from the calibration trials.
    pub static_map: Estimate,
    /// Error of the model that is calibrated again on everything but the held-out trials.
    pub recalibrated: Estimate,
}

impl Baselines {
    /// Returns the one with the smallest error.
    pub fn best(&self) -> Estimate {
        let all = [self.nominal, self.static_map, self.recalibrated];
        all.into_iter().fold(self.nominal, |best, next| if next.value < best.value { next } else { best })
    }
}

/// Root mean square errors on held-out trials, in the SI unit of the outputs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// SI unit of the outputs, or `of each range` where outputs have several units.
    pub unit: String,
    /// White noise of the outputs.
    pub noise: f64,
    /// Errors without the effects.
    pub baselines: Baselines,
    /// Error with the effects.
    pub after: Estimate,
    /// Error with the effects, offsets of each trial removed; where offsets between trials were found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub after_without_offsets: Option<Estimate>,
    /// Mean over blocks of the change in mean square against the best baseline, with its 95 % interval: negative is better.
    pub change: Estimate,
}

impl Errors {
    /// Returns how values in [`Errors::unit`] are shown: one prefix, by the size of the largest error.
    pub fn display(&self) -> Display {
        let Baselines { nominal, static_map, recalibrated } = &self.baselines;
        let all = [nominal, static_map, recalibrated, &self.after].map(|error| error.value);
        let largest = all.into_iter().filter(|error| error.is_finite()).fold(0.0, f64::max);
        Display::of(&self.unit, largest)
    }
}

/// Confirmation of a model by held-out trials.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Confirmation {
    /// The error fell: the 95 % interval of the paired change is below zero.
    Confirmed,
    /// The interval holds zero.
    Open,
    /// The error rose: the interval is above zero.
    Refuted,
    /// Nothing was added, or no trial is held out.
    NotTested,
}
