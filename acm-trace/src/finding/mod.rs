//! The result of closing the loop, as it is written to `loop.json`. Tables, figures and the page are drawn from it alone.

use acm_core::{display::Display, effects::Site};
use serde::{Deserialize, Serialize};

pub mod experiment;
pub(crate) mod figures;
pub(crate) mod found;
pub mod intervals;
mod open;
pub mod sentence;
pub mod title;
pub mod verdict;

/// What was found.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Finding {
    /// Version of this layout.
    pub format: u32,
    /// In one sentence, for a reader who sees nothing else.
    pub sentence: String,
    /// What may be concluded.
    pub verdict: Verdict,
    /// Effects that the model lacked, in the order in which they were found.
    pub effects: Vec<FoundEffect>,
    /// Names of all effects that explain as much as the first one does, itself included.
    pub equivalent: Vec<String>,
    /// Seconds by which the actuators' time stamps are late; no effect, since it looks ahead.
    pub clock_correction: Option<FoundParameter>,
    /// Root mean square of the offset that each trial has of its own, unrecorded; in the unit of the errors.
    pub trial_offset: Option<f64>,
    /// Errors on held-out trials, in the unit of [`Errors::unit`].
    pub errors: Errors,
    /// Share of the removable error that is gone, F = (b² − a²)/(b² − noise²) with b the best baseline; none where there was
    /// nothing to remove.
    pub removed: Option<f64>,
    /// What the held-out trials say of the model.
    pub confirmation: Confirmation,
    /// Which models were compared on the way, from the nominal model to the last: cross-validated on development trials.
    pub steps: Vec<Step>,
    /// What remains, and what was tried on it.
    pub left: Left,
    /// A formula for what no known effect explains.
    pub symbolic: Option<Symbolic>,
    /// The cheapest experiment that would tell apart what these data cannot.
    pub next_experiment: Option<String>,
    /// What weakens the conclusion, each in one sentence: blocks instead of trials, no calibration trials, …
    pub cautions: Vec<String>,
    /// Nominal, with effect, with network, with both: where networks were trained.
    pub networks: Vec<NetworkRow>,
    /// What the figures show.
    pub figures: Figures,
    /// Which data.
    pub data: Data,
    /// Seconds of computing; informative.
    pub seconds: f64,
    /// As resolved.
    pub configuration: serde_json::Value,
    /// Of this program.
    pub version: String,
}

impl Finding {
    /// Whether anything was added to the model: an effect, or a correction of the actuators' clock.
    pub fn adds(&self) -> bool {
        !self.effects.is_empty() || self.clock_correction.is_some()
    }
}

/// What may be concluded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Verdict {
    /// Nothing but noise is left.
    #[serde(rename = "no effect")]
    NoEffect,
    /// One effect (or several) explains what the model missed.
    #[serde(rename = "named")]
    Named,
    /// The effect is clear; its form is not quite that of the library.
    #[serde(rename = "named, form imperfect")]
    FormImperfect,
    /// An effect explains a part; the rest has another cause.
    #[serde(rename = "partial")]
    Partial,
    /// The inputs explain what is left, but no known effect does.
    #[serde(rename = "unknown structure")]
    UnknownStructure,
    /// A slip, a spectral line, the offset of one trial.
    #[serde(rename = "event")]
    Event,
    /// What is left is no noise, and neither effects nor the probes of [`Left`] explain it.
    #[serde(rename = "unmeasured disturbance")]
    UnmeasuredDisturbance,
}

/// An effect with its values.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct FoundEffect {
    /// Stable name.
    pub name: String,
    /// In words.
    pub meaning: String,
    /// Where it acts.
    pub site: Site,
    /// The signal that carries it, where there is one.
    pub carrier: Option<String>,
    /// Values in SI units.
    pub parameters: Vec<FoundParameter>,
    /// Root mean square of what it does to the outputs, in the unit of the errors.
    pub size: f64,
    /// How sure the name is.
    pub confidence: Confidence,
    /// Names of effects that explain as much, itself first.
    pub equivalent: Vec<String>,
    /// What was chosen in its place in resamples of the blocks.
    pub alternatives: Vec<Alternative>,
    /// Whether it acts in the calibration trials too; none where there are none of their own.
    pub in_calibration: Option<bool>,
    /// Where its equation comes from.
    pub source: String,
}

/// A value with its 95 % interval.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FoundParameter {
    /// Such as `width_q1`; `width_q1 per payload` for a dependence on a context signal.
    pub name: String,
    /// SI.
    pub value: f64,
    /// SI.
    pub unit: String,
    /// Bounds that cover the true value in 95 % of cases: sandwich covariance over blocks ([`crate::fit::interval`]). Open where
    /// nothing bounds it; null in the file.
    #[serde(with = "open")]
    pub interval: [f64; 2],
    /// The context signal that this value is multiplied with.
    pub depends_on: Option<String>,
    /// Whether the value rests on a bound of what the effect admits, so that the data would have it go on.
    #[serde(default)]
    pub at_bound: bool,
    /// Whether the data leave the value open: no finite interval, or one that is many times wider than a typical value.
    #[serde(default)]
    pub undetermined: bool,
}

impl FoundEffect {
    /// What was chosen in its place in resamples, largest share first.
    pub fn replaced_by(&self) -> impl Iterator<Item = &Alternative> {
        self.alternatives.iter().filter(|other| other.effect() != self.name)
    }
}

impl FoundParameter {
    /// Whether the data determine the value, and its interval leaves out zero.
    pub fn differs_from_zero(&self) -> bool {
        let [low, high] = self.interval;
        !self.undetermined && (low > 0.0 || high < 0.0)
    }
}

/// A number with its 95 % interval: bootstrap over trials (or blocks).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Root mean square error.
    pub value: f64,
    /// 95 %.
    pub interval: [f64; 2],
}

/// Models without the effects that the result is compared with.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Baselines {
    /// The nominal model as calibrated.
    pub nominal: Estimate,
    /// With the static map from the calibration trials.
    pub static_map: Estimate,
    /// Calibrated again on everything but the held-out trials.
    pub recalibrated: Estimate,
}

impl Baselines {
    /// The one with the smallest error.
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
    /// Without the effects.
    pub baselines: Baselines,
    /// With the effects.
    pub after: Estimate,
    /// With the effects, offsets of each trial removed; where offsets between trials were found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub after_without_offsets: Option<Estimate>,
    /// Mean over blocks of the change in mean square against the best baseline, with its 95 % interval: negative is better.
    pub change: Estimate,
}

impl Errors {
    /// How values in [`Errors::unit`] are shown: one prefix, by the size of the largest error.
    pub fn display(&self) -> Display {
        let Baselines { nominal, static_map, recalibrated } = &self.baselines;
        let all = [nominal, static_map, recalibrated, &self.after].map(|error| error.value);
        let largest = all.into_iter().filter(|error| error.is_finite()).fold(0.0, f64::max);
        Display::of(&self.unit, largest)
    }
}

/// What held-out trials say of a model that was chosen without them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Confirmation {
    /// The error fell: the 95 % interval of the paired change lies below zero.
    Confirmed,
    /// The interval holds zero.
    Open,
    /// The error rose: the interval lies above zero.
    Refuted,
    /// Nothing was added, or no trial is held out.
    NotTested,
}

/// How sure an effect is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Confidence {
    /// In words.
    pub level: Level,
    /// Share of the resamples of the blocks in which the effect, or its like, is chosen again.
    pub share: f64,
}

/// Confidence in words.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Level {
    /// Chosen again in fewer than half of the resamples.
    Possible,
    /// In half of them or more.
    Likely,
    /// In 95 % or more.
    Sure,
}

impl Level {
    /// As an adverb.
    pub fn adverb(self) -> &'static str {
        match self {
            Self::Possible => "possibly",
            Self::Likely => "likely",
            Self::Sure => "surely",
        }
    }
}

/// Another effect that was chosen in the place of one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Alternative {
    /// Stable name, with carrier and signal; empty where nothing was chosen.
    pub name: String,
    /// Share of the resamples.
    pub share: f64,
}

impl Alternative {
    /// Name of the effect, without carrier and signal.
    pub fn effect(&self) -> &str {
        self.name.split(['(', ' ']).next().unwrap_or(&self.name)
    }
}

/// One model on the way.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Step {
    /// `nominal`, `+ backlash`, `− actuator_lag`, `payload → tip_load`.
    pub model: String,
    /// Cross-validated error on development trials.
    pub error: f64,
    /// Improvement in standard errors of the paired difference.
    pub significance: Option<f64>,
    /// Share of the cross-validated mean square that is gone.
    pub gain: Option<f64>,
    /// Largest gain that any candidate reaches by chance in 99 % of cases.
    pub by_chance: Option<f64>,
    /// Whether it was accepted.
    pub accepted: bool,
    /// The same for every candidate of this step that was fitted, best first.
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

/// What remains.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Left {
    /// √(after² − floor²) on development trials, cross-validated.
    pub rms: f64,
    /// Whether recorded inputs predict what is left on blocks left out.
    pub probe: Option<Probe>,
    /// The same by a small recurrent network: [`crate::diagnose::recurrent`].
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
    /// Of the nominal residual.
    pub before: Vec<f64>,
    /// Of what is left.
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

/// One row of the table with networks; errors on held-out trials at identical time stamps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NetworkRow {
    /// `nominal`, `nominal + effect`, `nominal + network`, `nominal + effect + network`.
    pub model: String,
    /// Mean over seeds.
    pub error: f64,
    /// Standard deviation over seeds, where there are several.
    pub sd: Option<f64>,
}

/// Which data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Data {
    /// Of the campaign.
    pub name: String,
    /// One line.
    pub title: String,
    /// SHA-256 of manifest and files.
    pub hash: String,
    /// A simulation made them.
    pub synthetic: bool,
    /// Names of the trials that calibrate.
    pub calibration: Vec<String>,
    /// Names of the trials that the effect is found on.
    pub development: Vec<String>,
    /// Names of the trials that took no part.
    pub held_out: Vec<String>,
}

/// What the figures show: held-out trials, thinned to what a figure can hold.
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
    /// Of the effect that the signal carries.
    pub effect: String,
    /// Name of the signal on the horizontal axis, such as `q1` or `rate of q1` or `time`.
    pub signal: String,
    /// SI.
    pub unit: String,
    /// Output that the effect moves most, such as `x`.
    pub output: String,
    /// `[N]`, in order of time, so that neighbours can be joined to loops.
    pub x: Vec<f64>,
    /// measured − nominal `[N]`, in the unit of the errors.
    pub before: Vec<f64>,
    /// measured − model with effect `[N]`.
    pub after: Vec<f64>,
    /// Whether sample k continues sample k − 1 `[N]`; false starts a new loop.
    pub continues: Vec<bool>,
}

/// Measured and predicted output over time.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Trace {
    /// Of the trial.
    pub trial: String,
    /// Of the output.
    pub output: String,
    /// s.
    pub time: Vec<f64>,
    /// In the unit of the errors.
    pub measured: Vec<f64>,
    /// By the nominal model.
    pub nominal: Vec<f64>,
    /// With the effect.
    pub after: Vec<f64>,
}

/// Errors of one held-out trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrialErrors {
    /// Name.
    pub name: String,
    /// By the nominal model.
    pub nominal: f64,
    /// By the best baseline.
    pub best_baseline: f64,
    /// With the effect.
    pub after: f64,
}

/// What these data cannot tell apart, as written to `separability.json`.
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
    /// Groups of effects that cannot be told apart, each in words with the cheapest experiment that would.
    pub groups: Vec<Group>,
    /// Which data.
    pub data: Data,
    /// Of this program.
    pub version: String,
}

/// Effects that these data cannot tell apart.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Group {
    /// Names.
    pub effects: Vec<String>,
    /// In words.
    pub experiment: String,
}
