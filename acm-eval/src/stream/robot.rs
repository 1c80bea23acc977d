//! What answers beside a robot: one estimator, or the average of several.

use acm_stream::{Average, Estimator, Interval, StepError};

/// Estimator that answers samples: one, or the average of several.
pub enum Robot {
    /// Of one run.
    One(Box<Estimator>),
    /// Of the winner of a study of the best model.
    Mean(Average),
}

impl Robot {
    /// As [`Estimator::step`], or [`Estimator::step_unseen`] where the networks do not see the sample.
    ///
    /// # Errors
    /// A sample that cannot be taken; nothing changes.
    pub fn step(&mut self, inputs: &[f64], elapsed: f64, seen: bool) -> Result<(), StepError> {
        match (self, seen) {
            (Self::One(one), true) => one.step(inputs, elapsed).map(drop),
            (Self::One(one), false) => one.step_unseen(inputs, elapsed).map(drop),
            (Self::Mean(mean), true) => mean.step(inputs, elapsed).map(drop),
            (Self::Mean(mean), false) => mean.step_unseen(inputs, elapsed).map(drop),
        }
    }

    /// As [`Estimator::tip`].
    pub fn tip(&self) -> &[f64] {
        match self {
            Self::One(one) => one.tip(),
            Self::Mean(mean) => mean.tip(),
        }
    }

    /// As [`Estimator::nominal`].
    pub fn nominal(&self) -> &[f64] {
        match self {
            Self::One(one) => one.nominal(),
            Self::Mean(mean) => mean.nominal(),
        }
    }

    /// As [`Estimator::in_range`].
    pub fn in_range(&self) -> Option<bool> {
        match self {
            Self::One(one) => one.in_range(),
            Self::Mean(mean) => mean.in_range(),
        }
    }

    /// As [`Estimator::history`].
    pub fn history(&self) -> u64 {
        match self {
            Self::One(one) => one.history(),
            Self::Mean(mean) => mean.history(),
        }
    }

    /// About the answers; an average of several estimators has none.
    pub fn interval(&self) -> Option<&Interval> {
        match self {
            Self::One(one) => one.parts().interval.as_ref(),
            Self::Mean(_) => None,
        }
    }

    /// As [`Estimator::restart`].
    pub fn restart(&mut self) {
        match self {
            Self::One(one) => one.restart(),
            Self::Mean(mean) => mean.restart(),
        }
    }
}
