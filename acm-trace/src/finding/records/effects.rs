//! Effects that the model lacked, with their values and how sure they are.

use acm_core::effects::Site;
use serde::{Deserialize, Serialize};

/// An effect with its values.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct FoundEffect {
    /// Stable name.
    pub name: String,
    /// Meaning in words.
    pub meaning: String,
    /// Site where the effect acts.
    pub site: Site,
    /// The signal that carries it, where there is one.
    pub carrier: Option<String>,
    /// Values in SI units.
    pub parameters: Vec<FoundParameter>,
    /// Root mean square of the effect's change of the outputs, in the unit of the errors.
    pub size: f64,
    /// Root of the rise of the mean square on blocks left out when the effect is removed and the others are refined, in the unit of the
    /// errors.
    #[serde(default)]
    pub removes: f64,
    /// Confidence in the name.
    pub confidence: Confidence,
    /// Reasons why the name is not sure, whatever its share.
    #[serde(default)]
    pub doubts: Vec<Doubt>,
    /// Root mean square of the residual that the effect predicts, in the unit of the errors; none where that is too little to put the name
    /// in doubt, or the effect is in doubt for another reason.
    #[serde(default)]
    pub follows: Option<f64>,
    /// Names of effects that explain as much, itself first.
    pub equivalent: Vec<String>,
    /// Effects that were chosen instead in resamples of the blocks.
    pub alternatives: Vec<Alternative>,
    /// Whether it acts in the calibration trials too; none without calibration trials.
    pub in_calibration: Option<bool>,
    /// Origin of the equation.
    pub source: String,
}

impl FoundEffect {
    /// Returns the effects that were chosen instead in resamples, largest share first.
    pub fn replaced_by(&self) -> impl Iterator<Item = &Alternative> {
        self.alternatives.iter().filter(|other| other.effect() != self.name)
    }

    /// Returns whether a value rests on a bound that the effect admits.
    pub fn is_at_bound(&self) -> bool {
        self.parameters.iter().any(|parameter| parameter.at_bound)
    }
}

/// A minor effect: the model predicts better with it, by too little to name it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct MinorEffect {
    /// Stable name.
    pub name: String,
    /// Meaning in words.
    pub meaning: String,
    /// The signal that carries it, where there is one.
    pub carrier: Option<String>,
    /// Values in SI units.
    pub parameters: Vec<FoundParameter>,
    /// Root mean square of the effect's change of the outputs, in the unit of the errors.
    pub size: f64,
}

/// A value with its 95 % interval.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FoundParameter {
    /// Name such as `width_q1`; `width_q1 per payload` for a dependence on a context signal.
    pub name: String,
    /// Value, SI.
    pub value: f64,
    /// SI unit.
    pub unit: String,
    /// 95 % interval, by a jackknife over blocks ([`crate::fit::interval`]).
    /// Infinite where nothing bounds the value; null in the file.
    #[serde(with = "crate::finding::records::open")]
    pub interval: [f64; 2],
    /// The context signal that this value is multiplied with.
    pub depends_on: Option<String>,
    /// Whether the value rests on a bound of the effect: the data would move it beyond.
    #[serde(default)]
    pub at_bound: bool,
    /// Whether the data leave the value undetermined: no finite interval, or one that is many times wider than a
    /// typical value.
    #[serde(default)]
    pub undetermined: bool,
}

impl FoundParameter {
    /// Returns whether the data determine the value, and its interval leaves out zero.
    pub fn differs_from_zero(&self) -> bool {
        let [low, high] = self.interval;
        !self.undetermined && (low > 0.0 || high < 0.0)
    }
}

/// Confidence in an effect.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Confidence {
    /// Level in words.
    pub level: Level,
    /// Share of the resamples of the blocks in which the effect, or its like, is chosen again.
    pub share: f64,
}

/// Reason why an effect is not sure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Doubt {
    /// Another effect predicts as well.
    Equivalent,
    /// A value rests on a bound that the effect admits.
    AtBound,
    /// The intervals of all its sizes hold zero.
    MayBeZero,
    /// Other effects cancel most of what it does to the outputs.
    TakenBack,
    /// It predicts more of the residual than chance: another effect of its kind may act.
    Followed,
    /// The verdict is unknown structure.
    UnknownStructure,
    /// The saved model predicts otherwise than the search did.
    ModelDisagrees,
}

impl Doubt {
    /// Returns it in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Equivalent => "another effect predicts as well",
            Self::AtBound => "a value rests on its bound",
            Self::MayBeZero => "the intervals of its sizes hold zero",
            Self::TakenBack => "other effects take back most of what it does",
            Self::Followed => "what is left follows it: another of its kind may act",
            Self::UnknownStructure => "a part of what is missing has an unknown structure",
            Self::ModelDisagrees => "the saved model predicts otherwise than the search did",
        }
    }
}

/// Confidence in words.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Level {
    /// Chosen again in fewer than half of the resamples.
    Possible,
    /// Chosen again in half of the resamples or more.
    Likely,
    /// Chosen again in 95 % or more, and there is no [`Doubt`].
    Sure,
}

impl Level {
    /// Returns the level as an adverb.
    pub fn adverb(self) -> &'static str {
        match self {
            Self::Possible => "possibly",
            Self::Likely => "likely",
            Self::Sure => "surely",
        }
    }
}

/// Another effect that was chosen instead of one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Alternative {
    /// Stable name, with carrier and signal; empty where nothing was chosen.
    pub name: String,
    /// Share of the resamples.
    pub share: f64,
}

impl Alternative {
    /// Returns the name of the effect, without carrier and signal.
    pub fn effect(&self) -> &str {
        self.name.split(['(', ' ']).next().unwrap_or(&self.name)
    }
}
