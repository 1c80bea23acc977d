//! Truth of a campaign; only the scorer reads it.

use super::design::Design;
use serde::{Deserialize, Serialize};

/// Correct class of answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Class {
    /// No effect is present.
    Null,
    /// One effect of the library.
    Inside,
    /// Two effects of the library.
    Pair,
    /// One to six effects of the library, possibly with further imperfections.
    Several,
    /// A mechanism that the library does not have.
    Outside,
}

/// Onset of a mechanism.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Since {
    /// All trials; effects of the rotors are absent where these stand still.
    Start,
    /// Development and held-out trials only.
    AfterCalibration,
    /// One trial only.
    OneTrial,
}

/// A value in the parametrisation of the effect library.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// Name in the effect library.
    pub name: String,
    /// Value, SI.
    pub value: f64,
    /// Unit.
    pub unit: String,
    /// The truth's formula is another one: a fitted value may differ by this much and be right.
    pub tolerance: f64,
}

impl Parameter {
    /// Returns a value with its tolerance.
    pub fn new(name: impl Into<String>, value: f64, unit: &str, tolerance: f64) -> Self {
        Self { name: name.into(), value, unit: unit.into(), tolerance }
    }
}

/// One mechanism that acts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrueEffect {
    /// Name of the mechanism.
    pub kind: String,
    /// The effect of the library that a finder should name; none outside of the library.
    pub name: Option<String>,
    /// Further effects of the library whose formula becomes that of the mechanism for some of their values: right names, too.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub contained_in: Vec<String>,
    /// Whether the library has it.
    pub inside: bool,
    /// Onset of the mechanism.
    pub since: Since,
    /// The trial, where it acts in one only.
    pub trial: Option<String>,
    /// Values that the library has a counterpart for.
    pub parameters: Vec<Parameter>,
    /// Equation and numbers.
    pub formula: String,
    /// RMS of its displacement of the tip alone in the held-out trials, 3-D, without noise, mm.
    pub held_out_rms_mm: f64,
    /// Whether its absence shows: see [`super::separable`]. Another effect may explain it as well.
    #[serde(default)]
    pub separable: bool,
    /// Standard errors by which its absence worsens blocks left out.
    #[serde(default)]
    pub missed: f64,
}

/// Truth of a campaign.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// Seed of the campaign.
    pub seed: u64,
    /// Design of the campaign.
    pub design: Design,
    /// Name of the kind that was drawn.
    pub kind: String,
    /// Correct class of answer.
    pub class: Class,
    /// Acting mechanisms: none to six.
    pub effects: Vec<TrueEffect>,
    /// RMS of their joint displacement of the tip in the held-out trials, 3-D, without noise, mm.
    pub held_out_rms_mm: f64,
    /// Standard deviation of white noise of the tip, 3-D, mm.
    pub white_noise_mm: f64,
    /// Standard deviation of coloured noise on top, 3-D, mm.
    pub coloured_noise_mm: f64,
    /// Standard deviation of the encoders' noise, mrad; zero where it is the usual one.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub encoder_noise_mrad: f64,
    /// Standard deviation of the tip's unrecorded offset from trial to trial, 3-D, mm.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub offset_mm: f64,
    /// RMS in the held-out trials of errors that no recording explains: white and coloured noise and the offset of each
    /// trial, 3-D, mm.
    #[serde(default)]
    pub irreducible_mm: f64,
    /// Standard deviation of what stamps are off by, ms.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub stamp_error_ms: f64,
}

#[allow(clippy::trivially_copy_pass_by_ref)] // serde hands over a reference
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

impl Truth {
    /// Returns the names that a finder should give.
    pub fn names(&self) -> Vec<&str> {
        self.effects.iter().filter_map(|effect| effect.name.as_deref()).collect()
    }

    /// Returns all effects of the library that have the form of a mechanism.
    pub fn forms(&self) -> Vec<&str> {
        let further = self.effects.iter().flat_map(|effect| &effect.contained_in);
        self.names().into_iter().chain(further.map(String::as_str)).collect()
    }
}
