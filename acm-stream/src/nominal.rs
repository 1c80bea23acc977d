//! What predicts the outputs before the network adds to them.

use acm_core::NominalModel;
use acm_core::augmented::{AugmentedModel, OnlineModel, Point, Sample, Snapshot};
use serde::{Deserialize, Serialize};

/// A nominal model.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Nominal {
    /// Calibrated: a function of the actuators.
    Model(NominalModel),
    /// With effects, which remember.
    Augmented(AugmentedModel),
    /// The prediction comes with each sample: one value for each of so many outputs.
    Given(usize),
}

impl Nominal {
    /// Number of outputs M, of which the estimator's are some.
    pub fn outputs(&self) -> usize {
        match self {
            Self::Model(model) => model.outputs(),
            Self::Augmented(model) => model.rig().outputs.len(),
            Self::Given(outputs) => *outputs,
        }
    }

    /// Predictions that must come with each sample.
    pub(crate) fn predicted(&self) -> usize {
        match self {
            Self::Model(_) => 0,
            Self::Augmented(model) => {
                if model.needs_prediction() {
                    self.outputs()
                } else {
                    0
                }
            }
            Self::Given(outputs) => *outputs,
        }
    }

    /// Components of the carrier's acceleration that must come with each sample.
    pub(crate) fn acceleration(&self) -> usize {
        match self {
            Self::Augmented(model) if model.rig().carried => 3,
            _ => 0,
        }
    }
}

/// The same, under way.
#[derive(Debug)]
pub(crate) enum Running {
    Model(Box<Point>),
    /// With what it remembered before the last step.
    Augmented(Box<(OnlineModel, Snapshot)>),
    Given,
}

impl Running {
    pub fn new(nominal: &Nominal) -> Self {
        match nominal {
            Nominal::Model(model) => Self::Model(Box::new(Point::new(model.clone(), None))),
            Nominal::Augmented(model) => {
                let model = OnlineModel::new(model);
                let before = model.snapshot();
                Self::Augmented(Box::new((model, before)))
            }
            Nominal::Given(_) => Self::Given,
        }
    }

    /// Outputs [M] at the next sample.
    pub fn step(&mut self, sample: &Sample, out: &mut [f64]) {
        match self {
            Self::Model(point) => point.evaluate(sample.actuators, out),
            Self::Augmented(running) => {
                let (model, before) = running.as_mut();
                model.save(before);
                model.step(sample, out);
            }
            Self::Given => out.copy_from_slice(sample.predicted),
        }
    }

    /// Takes the last step back.
    pub fn undo(&mut self) {
        if let Self::Augmented(running) = self {
            let (model, before) = running.as_mut();
            model.restore(before);
        }
    }

    /// Forgets the trial.
    pub fn restart(&mut self) {
        if let Self::Augmented(running) = self {
            running.0.restart();
        }
    }
}
