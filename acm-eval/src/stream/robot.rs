//! The estimator beside a robot: that of one run, or the average of several.

use acm_stream::{Average, Estimator, Interval, StepError};

/// Estimator that answers samples: one, or the average of several.
pub enum Robot {
    /// Estimator of one run.
    One(Box<Estimator>),
    /// Average of the winner of a study of the best model.
    Mean(Average),
}

impl Robot {
    /// Answers a sample by [`Estimator::step`], or by [`Estimator::step_unseen`] where the networks do not process it.
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

    /// Returns the answer; see [`Estimator::tip`].
    pub fn tip(&self) -> &[f64] {
        match self {
            Self::One(one) => one.tip(),
            Self::Mean(mean) => mean.tip(),
        }
    }

    /// Returns the nominal prediction; see [`Estimator::nominal`].
    pub fn nominal(&self) -> &[f64] {
        match self {
            Self::One(one) => one.nominal(),
            Self::Mean(mean) => mean.nominal(),
        }
    }

    /// Returns whether the channels were in range; see [`Estimator::in_range`].
    pub fn in_range(&self) -> Option<bool> {
        match self {
            Self::One(one) => one.in_range(),
            Self::Mean(mean) => mean.in_range(),
        }
    }

    /// Returns the number of samples; see [`Estimator::history`].
    pub fn history(&self) -> u64 {
        match self {
            Self::One(one) => one.history(),
            Self::Mean(mean) => mean.history(),
        }
    }

    /// Returns the interval of the answers, where there is one.
    pub fn interval(&self) -> Option<&Interval> {
        match self {
            Self::One(one) => one.parts().interval.as_ref(),
            Self::Mean(mean) => mean.interval(),
        }
    }

    /// Resets the states; see [`Estimator::restart`].
    pub fn restart(&mut self) {
        match self {
            Self::One(one) => one.restart(),
            Self::Mean(mean) => mean.restart(),
        }
    }
}
