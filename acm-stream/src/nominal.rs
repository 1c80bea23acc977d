//! Nominal models of an estimator.

use std::ops::Range;

use acm_core::NominalModel;
use acm_core::augmented::{AugmentedModel, NeedsFuture, OnlineModel, Point, Sample, Snapshot};
use acm_core::rig::Signal;
use acm_core::tip_model::StrainModel;
use serde::{Deserialize, Serialize};

use crate::labels::Label;

/// A nominal model.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Nominal {
    /// A calibrated function of the actuators.
    Model(NominalModel),
    /// Model with effects that have a state.
    Augmented(AugmentedModel),
    /// The prediction comes with each sample, as this many inputs.
    Given(usize),
}

impl Nominal {
    /// Returns the number of outputs M, among them those of the estimator.
    pub fn outputs(&self) -> usize {
        match self {
            Self::Model(model) => model.outputs(),
            Self::Augmented(model) => model.rig().outputs.len(),
            Self::Given(outputs) => *outputs,
        }
    }

    /// Returns the arm whose slopes say how an actuator moves the outputs: the model, or the one within a model with
    /// effects; none where there is no arm.
    pub(crate) fn arm(&self) -> Option<&StrainModel> {
        match self {
            Self::Model(NominalModel::Strain(arm)) => Some(arm),
            Self::Augmented(model) => match model.nominal() {
                NominalModel::Strain(arm) => Some(arm),
                _ => None,
            },
            Self::Model(_) | Self::Given(_) => None,
        }
    }

    /// Returns the number of predictions that each sample must include.
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

    /// Returns the labels of all inputs of a sample, of which `signals` are the first.
    pub(crate) fn input_labels<'a>(&self, signals: impl Iterator<Item = &'a String>) -> Vec<Label> {
        let known: Vec<&Signal> = match self {
            Self::Augmented(model) => model.rig().actuators.iter().chain(&model.rig().contexts).collect(),
            Self::Model(_) | Self::Given(_) => vec![],
        };
        let unit = |k: usize| known.get(k).map_or("", |signal| signal.unit.as_str());
        let mut all: Vec<Label> = signals.enumerate().map(|(k, name)| Label::in_si(name, unit(k))).collect();
        let axes = ["x", "y", "z"].iter().take(self.acceleration());
        all.extend(axes.map(|axis| Label::in_si(format!("acceleration_{axis}"), "m/s^2")));
        all.extend(self.output_labels(0..self.predicted()));
        all
    }

    /// Returns the labels of some outputs.
    pub(crate) fn output_labels(&self, outputs: Range<usize>) -> Vec<Label> {
        let label = |o: usize| match self {
            Self::Augmented(model) if o < model.rig().outputs.len() => {
                let Signal { name, unit, .. } = &model.rig().outputs[o];
                Label::in_si(name, unit)
            }
            _ => Label::in_si(format!("output_{o}"), ""),
        };
        outputs.map(label).collect()
    }

    /// Returns the number of components of the carrier's acceleration that each sample must include.
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

/// A model with effects, and its state before the last step where that may overflow.
#[derive(Debug)]
pub(crate) struct WithEffects {
    model: OnlineModel,
    before: Snapshot,
    saved: bool,
}

/// Inputs up to this size, SI, cannot overflow an effect with realistic parameters, so their step need not be undone.
/// Saving the state before each step costs as much as half a step of seven effects.
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

    /// Computes the outputs [M] at the next sample.
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

    /// Undoes the last step. A model that overflows at ordinary inputs is reset.
    pub fn undo(&mut self) {
        if let Self::Augmented(running) = self {
            match running.saved {
                true => running.model.restore(&running.before),
                false => running.model.restart(),
            }
        }
    }

    /// Resets the state.
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
