//! What predicts the outputs before the network adds to them.

use acm_core::NominalModel;
use acm_core::augmented::{AugmentedModel, NeedsFuture, OnlineModel, Point, Sample, Snapshot};
use serde::{Deserialize, Serialize};

/// A nominal model.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Nominal {
    /// Calibrated: a function of the actuators.
    Model(NominalModel),
    /// Model with effects that have a state.
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
    pub fn predicted(&self) -> usize {
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
    pub fn acceleration(&self) -> usize {
        match self {
            Self::Augmented(model) if model.rig().carried => 3,
            _ => 0,
        }
    }
}

/// A nominal model with its state during a trial.
#[derive(Debug)]
pub(crate) enum Running {
    Model(Box<Point>),
    Augmented(Box<WithEffects>),
    Given,
}

/// A model with effects, and what it remembered before the last step where that may overflow.
#[derive(Debug)]
pub(crate) struct WithEffects {
    model: OnlineModel,
    before: Snapshot,
    saved: bool,
}

/// Inputs up to this size, SI, carry no effect with values of this world beyond what f64 holds, so that their step need not be
/// taken back. To remember the state before each step costs as much as half a step of seven effects.
const ORDINARY: f64 = 1e12;

impl Running {
    pub fn new(nominal: &Nominal) -> Result<Self, NeedsFuture> {
        Ok(match nominal {
            Nominal::Model(model) => Self::Model(Box::new(Point::new(model.clone(), None))),
            Nominal::Augmented(model) => {
                let model = OnlineModel::new(model)?;
                let before = model.snapshot();
                Self::Augmented(Box::new(WithEffects { model, before, saved: false }))
            }
            Nominal::Given(_) => Self::Given,
        })
    }

    /// Outputs [M] at the next sample.
    pub fn step(&mut self, sample: &Sample, out: &mut [f64]) {
        match self {
            Self::Model(point) => point.evaluate(sample.actuators, out),
            Self::Augmented(running) => {
                running.saved = !is_ordinary(sample);
                if running.saved {
                    running.model.save(&mut running.before);
                }
                running.model.step(sample, out);
            }
            Self::Given => out.copy_from_slice(sample.predicted),
        }
    }

    /// Takes the last step back. A model that overflows at ordinary inputs has values that no state helps: it starts again.
    pub fn undo(&mut self) {
        if let Self::Augmented(running) = self {
            match running.saved {
                true => running.model.restore(&running.before),
                false => running.model.restart(),
            }
        }
    }

    /// Forgets the trial.
    pub fn restart(&mut self) {
        if let Self::Augmented(running) = self {
            running.model.restart();
        }
    }
}

fn is_ordinary(sample: &Sample) -> bool {
    let all = [sample.actuators, sample.contexts, sample.acceleration, sample.predicted];
    sample.time.abs() <= ORDINARY && all.into_iter().flatten().all(|value| value.abs() <= ORDINARY)
}
