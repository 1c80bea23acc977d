//! Weighted average of several estimators. All get the same samples; each reads the inputs that it needs.
//!
//! ```text
//! y_k = Σ_m w_m y_{m,k}          Σ_m w_m = 1
//! ```
//!
//! | symbol    | meaning                                              | unit |
//! | --------- | ---------------------------------------------------- | ---- |
//! | `y_{m,k}` | answer of estimator m to sample k ([`Estimator`])    | SI   |
//! | `w_m`     | its weight                                           | –    |
//!
//! Nominal predictions are averaged with the same weights. Estimators may differ in everything but their outputs: nominal
//! model, network, channels. A step allocates nothing.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::estimator::{Estimator, StepError};
use crate::interval::Interval;
use crate::parts::{Parts, PartsError};
use crate::saved::SavedError;

/// Parts of an average: inputs, members, weights.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AverageParts {
    /// Names of the inputs of a sample, in order.
    pub inputs: Vec<String>,
    /// Members of the average; at least one.
    pub members: Vec<MemberParts>,
    /// Prediction interval of the average; none in files of earlier versions, or with fewer than two trials left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interval: Option<Interval>,
}

/// One estimator of an average.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MemberParts {
    /// Parts of the estimator.
    pub parts: Parts,
    /// Index of each of the estimator's inputs among the inputs of a sample.
    pub places: Vec<usize>,
    /// Weight of the estimator in the average.
    pub weight: f64,
}

/// Reasons why the parts are refused.
#[derive(Debug, Error, PartialEq)]
pub enum AverageError {
    /// The average has no member.
    #[error("an average needs a member; take all parts from one run")]
    Empty,
    /// A member has other outputs, or needs an input that is missing.
    #[error("member {member} does not fit the others: {what}; take all parts from one run")]
    Member {
        /// Index of the member.
        member: usize,
        /// Description of the mismatch.
        what: &'static str,
    },
    /// The weights do not add up to 1.
    #[error("the weights add up to {sum}; they must be above 0 and add up to 1")]
    Weights {
        /// Sum of the weights as given.
        sum: f64,
    },
    /// A member cannot be built.
    #[error(transparent)]
    Parts(#[from] PartsError),
}

/// Tolerance for the rounding of weights such as three times 1/3.
const ROUNDING: f64 = 1e-9;

impl AverageParts {
    /// Returns the average of one estimator, which answers as that estimator does.
    pub fn of_one(parts: Parts) -> Self {
        let labels = parts.labelled().inputs;
        let inputs: Vec<String> = labels.into_iter().map(|label| label.column.unwrap_or(label.name)).collect();
        let places = (0..inputs.len()).collect();
        Self { inputs, members: vec![MemberParts { parts, places, weight: 1.0 }], interval: None }
    }

    /// Returns the bytes of a JSON file with its SHA-256; numbers keep every bit.
    ///
    /// # Errors
    /// A number is not finite.
    pub fn to_json(&self) -> serde_json::Result<Vec<u8>> {
        acm_hashed::encode(self)
    }

    /// Reads the bytes that [`AverageParts::to_json`] wrote, and checks their SHA-256.
    ///
    /// # Errors
    /// The bytes were changed, or are no average.
    pub fn from_json(bytes: &[u8]) -> Result<Self, SavedError> {
        Ok(serde_json::from_str(&acm_hashed::verify(bytes)?)?)
    }

    fn check(&self) -> Result<(), AverageError> {
        let Some(first) = self.members.first() else { return Err(AverageError::Empty) };
        for (member, one) in self.members.iter().enumerate() {
            let refuse = |what| Err(AverageError::Member { member, what });
            if one.parts.tip.len() != first.parts.tip.len() {
                return refuse("the number of outputs");
            }
            if one.places.len() != one.parts.width() || one.places.iter().any(|place| *place >= self.inputs.len()) {
                return refuse("its inputs");
            }
        }
        if let Some(interval) = &self.interval {
            let (found, needed) = (interval.half_widths.len(), first.parts.tip.len());
            if found != needed {
                return Err(PartsError::Count { what: "half-widths", found, needed }.into());
            }
            if !interval.is_valid() {
                let remedy = "above 0 and below 1, with half-widths of 0 or more";
                return Err(PartsError::Value { what: "the interval's level", value: interval.level, remedy }.into());
            }
        }
        let sum: f64 = self.members.iter().map(|one| one.weight).sum();
        let positive = self.members.iter().all(|one| one.weight > 0.0);
        if positive && (sum - 1.0).abs() <= ROUNDING { Ok(()) } else { Err(AverageError::Weights { sum }) }
    }
}

/// An average of estimators with their states.
#[derive(Debug)]
pub struct Average {
    members: Vec<Member>,
    interval: Option<Interval>,
    /// Number of inputs of a sample.
    width: usize,
    tip: Vec<f64>,
    nominal: Vec<f64>,
}

#[derive(Debug)]
struct Member {
    estimator: Estimator,
    places: Vec<usize>,
    weight: f64,
    /// Inputs of the member at the current sample.
    inputs: Vec<f64>,
}

impl Average {
    /// Returns the estimator before the first sample of a trial.
    ///
    /// # Errors
    /// Reasons why the parts are refused.
    pub fn new(parts: AverageParts) -> Result<Self, AverageError> {
        parts.check()?;
        let (width, outputs) = (parts.inputs.len(), parts.members[0].parts.tip.len());
        let member = |one: MemberParts| {
            let inputs = vec![0.0; one.places.len()];
            Ok(Member { estimator: Estimator::new(one.parts)?, places: one.places, weight: one.weight, inputs })
        };
        let members = parts.members.into_iter().map(member).collect::<Result<_, PartsError>>()?;
        Ok(Self { members, interval: parts.interval, width, tip: vec![0.0; outputs], nominal: vec![0.0; outputs] })
    }

    /// Returns the tip at the next sample, SI, as [`Estimator::step`]: `inputs` in the order of
    /// [`AverageParts::inputs`].
    ///
    /// # Errors
    /// The sample is refused; nothing changes. Where a later member overflows at a sample that earlier ones took, all
    /// members are reset.
    pub fn step(&mut self, inputs: &[f64], elapsed: f64) -> Result<&[f64], StepError> {
        self.each(inputs, |estimator, inputs| estimator.step(inputs, elapsed).map(drop))
    }

    /// Returns the nominal answer to a sample outside of the networks' domain, as [`Estimator::step_unseen`].
    ///
    /// # Errors
    /// As [`Average::step`].
    pub fn step_unseen(&mut self, inputs: &[f64], elapsed: f64) -> Result<&[f64], StepError> {
        self.each(inputs, |estimator, inputs| estimator.step_unseen(inputs, elapsed).map(drop))
    }

    fn each(
        &mut self,
        inputs: &[f64],
        step: impl Fn(&mut Estimator, &[f64]) -> Result<(), StepError>,
    ) -> Result<&[f64], StepError> {
        let (found, needed) = (inputs.len(), self.width);
        if found != needed {
            return Err(StepError::Count { found, needed });
        }
        if let Some(index) = inputs.iter().position(|value| !value.is_finite()) {
            return Err(StepError::NotFinite { index, value: inputs[index] });
        }
        for m in 0..self.members.len() {
            let Member { estimator, places, inputs: own, .. } = &mut self.members[m];
            own.iter_mut().zip(places.iter()).for_each(|(own, &place)| *own = inputs[place]);
            if let Err(error) = step(estimator, own) {
                if m > 0 {
                    self.restart();
                }
                return Err(error);
            }
        }
        self.gather();
        Ok(&self.tip)
    }

    fn gather(&mut self) {
        self.tip.fill(0.0);
        self.nominal.fill(0.0);
        for Member { estimator, weight, .. } in &self.members {
            self.tip.iter_mut().zip(estimator.tip()).for_each(|(sum, tip)| *sum += weight * tip);
            self.nominal.iter_mut().zip(estimator.nominal()).for_each(|(sum, nominal)| *sum += weight * nominal);
        }
    }

    /// Returns the answer to the last sample, SI.
    pub fn tip(&self) -> &[f64] {
        &self.tip
    }

    /// Returns the weighted mean of the nominal predictions at the last sample, SI.
    pub fn nominal(&self) -> &[f64] {
        &self.nominal
    }

    /// Returns the interval of the answers, where there is one.
    pub fn interval(&self) -> Option<&Interval> {
        self.interval.as_ref()
    }

    /// Returns whether the last sample was in the training range of all members; none where one has no ranges.
    pub fn in_range(&self) -> Option<bool> {
        self.members.iter().try_fold(true, |all, member| Some(all && member.estimator.in_range()?))
    }

    /// Returns the smallest [`Estimator::history`] of the members.
    pub fn history(&self) -> u64 {
        self.members.iter().map(|member| member.estimator.history()).min().unwrap_or(0)
    }

    /// Resets all states, for a new trial.
    pub fn restart(&mut self) {
        self.members.iter_mut().for_each(|member| member.estimator.restart());
    }
}
