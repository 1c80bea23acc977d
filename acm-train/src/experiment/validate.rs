//! Values that have the right type and still cannot be.

use super::{Experiment, Nominal};
use crate::learn::{self, LearnError, TrainingFault};

/// One value that cannot be, by its dotted key.
#[derive(Debug)]
pub struct Fault {
    key: String,
    /// The value, and why it cannot be.
    pub what: String,
    /// What to write instead.
    pub help: String,
}

impl Fault {
    /// `what` goes on from the key: `is 0`.
    pub fn new(key: &str, what: impl Into<String>, help: impl Into<String>) -> Self {
        Self { key: key.into(), what: format!("`{key}` {}", what.into()), help: help.into() }
    }

    /// The parts of the dotted key.
    pub fn key(&self) -> Vec<String> {
        self.key.split('.').map(String::from).collect()
    }
}

/// Every fault that can be seen without the data, the first of each table first.
pub fn faults(experiment: &Experiment) -> Vec<Fault> {
    [
        device(experiment),
        windows(experiment),
        network(experiment),
        baseline(experiment),
        training(experiment),
        protocol(experiment),
        inputs(experiment),
        nominal(&experiment.nominal),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn network(experiment: &Experiment) -> Vec<Fault> {
    let fault =
        |e: acm_models::ConfigError| Fault::new(&format!("network.{}", e.field), format!("is {}", e.value), e.remedy);
    experiment.network.validate().err().map(fault).into_iter().collect()
}

fn baseline(experiment: &Experiment) -> Vec<Fault> {
    experiment.baseline.as_ref().map_or_else(Vec::new, |baseline| baseline.faults(experiment.windows.length))
}

fn device(experiment: &Experiment) -> Vec<Fault> {
    let fault = |error: LearnError| {
        Fault::new("device", format!("cannot be used: {error}"), "device = \"flex\" computes on any CPU")
    };
    learn::device(&experiment.device).err().map(fault).into_iter().collect()
}

fn training(experiment: &Experiment) -> Vec<Fault> {
    let fault = |f: TrainingFault| Fault::new(&format!("training.{}", f.field), format!("is {}", f.value), f.remedy);
    experiment.training.validate().err().map(fault).into_iter().collect()
}

fn windows(experiment: &Experiment) -> Vec<Fault> {
    let w = &experiment.windows;
    let mut faults = vec![];
    for (key, value) in
        [("windows.length", w.length), ("windows.stride", w.stride), ("windows.evaluation_stride", w.evaluation_stride)]
    {
        if value == 0 {
            faults.push(Fault::new(key, "is 0", "write a whole number of samples, 1 or more"));
        }
    }
    if w.reach < w.length {
        let what = format!("is {}, shorter than windows.length = {}", w.reach, w.length);
        let help = "reach is the longest window among the models that are compared: at least windows.length";
        faults.push(Fault::new("windows.reach", what, help));
    }
    if w.max_gap <= 0.0 {
        faults.push(Fault::new(
            "windows.max_gap",
            format!("is {} s", w.max_gap),
            "write the longest gap between two samples of one sequence, in s, above 0",
        ));
    }
    faults
}

fn protocol(experiment: &Experiment) -> Vec<Fault> {
    let p = &experiment.protocol;
    let mut faults = vec![];
    if p.seeds.is_empty() {
        faults.push(Fault::new(
            "protocol.seeds",
            "is empty, so there is nothing to run",
            "write at least one: seeds = [1]",
        ));
    }
    if let Some(twice) = p.seeds.iter().enumerate().find_map(|(i, seed)| p.seeds[..i].contains(seed).then_some(seed)) {
        faults.push(Fault::new(
            "protocol.seeds",
            format!("names seed {twice} twice; both runs would be the same"),
            "name each seed once",
        ));
    }
    if !p.cross_validation && !p.final_runs {
        faults.push(Fault::new(
            "protocol.final",
            "and cross_validation are both false, so there is nothing to run",
            "set at least one of them to true",
        ));
    }
    if let Some(fold) = p.folds.as_ref().and_then(|folds| folds.iter().position(Vec::is_empty)) {
        faults.push(Fault::new(
            "protocol.folds",
            format!("has no trial in fold {fold}"),
            "name the validation trials of each fold",
        ));
    }
    if p.held_out.as_ref().is_some_and(Vec::is_empty) {
        let help = "name the trials that take no part in learning, or leave the key out for the manifest's";
        faults.push(Fault::new("protocol.held_out", "is empty", help));
    }
    faults
}

fn inputs(experiment: &Experiment) -> Vec<Fault> {
    let i = &experiment.inputs;
    let mut faults = vec![];
    if i.learn_from.is_empty() {
        faults.push(Fault::new(
            "inputs.learn_from",
            "is empty, so there is nothing to learn from",
            "name roles of trials: learn_from = [\"development\"]",
        ));
    }
    if i.learn_from.iter().any(|role| !crate::plan::may_learn_from(*role)) {
        faults.push(Fault::new(
            "inputs.learn_from",
            "names trials that must take no part in learning",
            "only \"calibration\" and \"development\" trials may be learned from",
        ));
    }
    if i.channels.as_ref().is_some_and(Vec::is_empty) {
        faults.push(Fault::new(
            "inputs.channels",
            "is empty, so the network would see nothing",
            "name channels, or leave the key out for all actuators and context signals",
        ));
    }
    if let Some(twice) =
        i.channels.as_ref().and_then(|c| (1..c.len()).find(|k| c[..*k].contains(&c[*k])).map(|k| &c[k]))
    {
        faults.push(Fault::new("inputs.channels", format!("names \"{twice}\" twice"), "name each channel once"));
    }
    faults
}

/// The faults of `[nominal]`.
pub fn nominal(n: &Nominal) -> Vec<Fault> {
    let mut faults = vec![];
    for (key, value) in [("nominal.length", n.length), ("nominal.tolerance", n.tolerance)] {
        if value.is_some_and(|value| value <= 0.0) {
            faults.push(Fault::new(key, format!("is {} m", value.unwrap_or_default()), "write a length above 0, in m"));
        }
    }
    for (key, value) in [("nominal.degree", n.degree), ("nominal.steps", n.steps)] {
        if value == Some(0) {
            faults.push(Fault::new(key, "is 0", "write a whole number, 1 or more"));
        }
    }
    faults.extend(augmented(n));
    faults
}

/// A saved model brings what the other keys would say.
fn augmented(n: &Nominal) -> Option<Fault> {
    if n.augmented.is_none() {
        let alone =
            || Fault::new("nominal.augmented_sha256", "has no nominal.augmented", "name the file, or delete the hash");
        return n.augmented_sha256.as_ref().map(|_| alone());
    }
    let said = [
        ("model", n.model.is_some()),
        ("length", n.length.is_some()),
        ("axis", n.axis.is_some()),
        ("strain", n.strain.is_some()),
        ("degree", n.degree.is_some()),
        ("steps", n.steps.is_some()),
        ("tolerance", n.tolerance.is_some()),
    ];
    let (key, _) = said.into_iter().find(|(_, said)| *said)?;
    let what = "stands beside nominal.augmented, which brings a model of its own";
    Some(Fault::new(&format!("nominal.{key}"), what, "delete one of the two"))
}
