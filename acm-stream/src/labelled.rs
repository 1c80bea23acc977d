//! The labels of an estimator's inputs and outputs.

use acm_core::rig::Signal;

use crate::labels::{Label, Labels};
use crate::nominal::Nominal;
use crate::parts::Parts;

impl Parts {
    /// Returns the labels; where the parts have none, those of the nominal model's signals.
    pub fn labelled(&self) -> Labels {
        self.labels.clone().unwrap_or_else(|| Labels { inputs: self.input_labels(), outputs: self.output_labels() })
    }

    fn input_labels(&self) -> Vec<Label> {
        let signals = self.signals.actuators.iter().chain(&self.signals.contexts);
        let known: Vec<&Signal> = match &self.nominal {
            Nominal::Augmented(model) => model.rig().actuators.iter().chain(&model.rig().contexts).collect(),
            _ => vec![],
        };
        let unit = |k: usize| known.get(k).map_or("", |signal| signal.unit.as_str());
        let mut all: Vec<Label> = signals.enumerate().map(|(k, name)| Label::in_si(name, unit(k))).collect();
        let axes = ["x", "y", "z"].iter().take(self.nominal.acceleration());
        all.extend(axes.map(|axis| Label::in_si(format!("acceleration_{axis}"), "m/s^2")));
        all.extend((0..self.nominal.predicted()).map(|o| self.output_label(o)));
        all
    }

    fn output_labels(&self) -> Vec<Label> {
        self.tip.clone().map(|o| self.output_label(o)).collect()
    }

    fn output_label(&self, o: usize) -> Label {
        let known = match &self.nominal {
            Nominal::Augmented(model) => model.rig().outputs.get(o),
            _ => None,
        };
        known.map_or_else(|| Label::in_si(format!("output_{o}"), ""), |signal| Label::in_si(&signal.name, &signal.unit))
    }
}
