//! Validation of values beyond their types.

use std::collections::BTreeSet;

use acm_core::{ArmError, ArmSpec, actuation::LARGEST_DEGREE};
use acm_datasets::Role;
use acm_models::{DeviceError, NetworkConfig, device as open};

use super::experiment::{Experiment, Nominal, NominalKind};
use super::network::Corrected;
use super::parse::fault::{Fault, TrainingFault};

/// Largest number of samples of a window or a step.
const MOST_SAMPLES: usize = 1_000_000;
/// Largest number of seeds; more runs are a mistake.
const MOST_SEEDS: usize = 10_000;
/// Largest number of parameters. Weights, gradient, two moments and the best weights of more do not fit where
/// experiments are run.
const MOST_PARAMETERS: usize = 100_000_000;
/// An arm beyond it was written in millimetres.
const LONGEST_ARM: f64 = 100.0;

/// Returns every fault that can be found without the data, the first of each table first.
pub fn faults(experiment: &Experiment) -> Vec<Fault> {
    [
        data(experiment),
        device(experiment),
        memory(experiment),
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

fn data(experiment: &Experiment) -> Vec<Fault> {
    let empty = experiment.data.as_os_str().is_empty();
    let fault = || Fault::new("data", "is empty", "name a folder with a manifest.toml: data = \"datasets/acm-twin\"");
    empty.then(fault).into_iter().collect()
}

fn network(experiment: &Experiment) -> Vec<Fault> {
    network_fault(&experiment.network).into_iter().chain(corrects_fault(experiment)).collect()
}

/// Returns the fault of corrections that a network cannot make, as far as the experiment shows.
fn corrects_fault(experiment: &Experiment) -> Option<Fault> {
    let fault = |what: &str, help: &str| Some(Fault::new("network.corrects", what, help));
    let asked = &experiment.network.corrects;
    if asked.is_empty() || asked == &[Corrected::Tip] {
        return None;
    }
    if !asked.contains(&Corrected::Tip) {
        return fault("leaves out the tip", "write [\"tip\"] or [\"tip\", \"actuators\"]");
    }
    if experiment.baseline.is_some() {
        return fault("is of a network, and [baseline] takes its place", "delete one of the two");
    }
    let strain = experiment.nominal.model.is_none_or(|kind| kind == NominalKind::Strain);
    if !strain {
        return fault(CORRECTS_NO_ARM, CORRECTS_NO_ARM_HELP);
    }
    None
}

/// Actuators are corrected through the slopes of the arm alone.
pub const CORRECTS_NO_ARM: &str = "names the actuators, and the nominal model is no arm";

/// Advice to the user.
pub const CORRECTS_NO_ARM_HELP: &str =
    "write [\"tip\"], or nominal.model = \"strain\", or a nominal.augmented that an arm stands in";

/// Returns the fault of a network's sizes, or of their total.
pub fn network_fault(network: &NetworkConfig) -> Option<Fault> {
    if let Err(e) = network.validate() {
        return Some(Fault::new(&format!("network.{}", e.field), format!("is {}", e.value), e.remedy));
    }
    let parameters = network.parameter_count(1);
    (parameters > MOST_PARAMETERS).then(|| {
        let help = format!("take fewer layers or units: {MOST_PARAMETERS} parameters at most");
        Fault::new("network", format!("has {parameters} parameters"), help)
    })
}

fn baseline(experiment: &Experiment) -> Vec<Fault> {
    experiment.baseline.as_ref().map_or_else(Vec::new, |baseline| baseline.faults(experiment.windows.length))
}

fn device(experiment: &Experiment) -> Vec<Fault> {
    let fault = |error: DeviceError| {
        Fault::new("device", format!("cannot be used: {error}"), "device = \"flex\" computes on any CPU")
    };
    open(&experiment.device).err().map(fault).into_iter().collect()
}

fn training(experiment: &Experiment) -> Vec<Fault> {
    let fault = |f: TrainingFault| Fault::new(&format!("training.{}", f.field), format!("is {}", f.value), f.remedy);
    experiment.training.validate().err().map(fault).into_iter().collect()
}

fn memory(experiment: &Experiment) -> Vec<Fault> {
    if experiment.memory.is_trial() { experiment.memory.faults() } else { vec![] }
}

fn windows(experiment: &Experiment) -> Vec<Fault> {
    let w = &experiment.windows;
    let mut faults = vec![];
    for (key, value, example) in [
        ("windows.length", w.length, "50"),
        ("windows.stride", w.stride, "1"),
        ("windows.evaluation_stride", w.evaluation_stride, "1"),
        ("windows.reach", w.reach.max(1), "50"),
    ] {
        faults.extend(Fault::count(key, value, 1, MOST_SAMPLES, example));
    }
    if w.reach < w.length {
        let what = format!("is {}, shorter than windows.length = {}", w.reach, w.length);
        let help = "reach is the longest window among the models that are compared: at least windows.length";
        faults.push(Fault::new("windows.reach", what, help));
    }
    if w.gap() <= 0.0 {
        faults.push(Fault::new(
            "windows.max_gap",
            format!("is {} s", w.gap()),
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
    if p.seeds.len() > MOST_SEEDS {
        let what = format!("names {} seeds", p.seeds.len());
        faults.push(Fault::new("protocol.seeds", what, format!("name {MOST_SEEDS} at most; each is a run")));
    }
    if let Some(twice) = twice(&p.seeds) {
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
    let in_folds: Vec<&String> = p.folds.iter().flatten().flatten().collect();
    for (key, twice) in [("folds", twice(in_folds)), ("held_out", twice(p.held_out.iter().flatten()))] {
        faults.extend(twice.map(|trial| {
            Fault::new(&format!("protocol.{key}"), format!("names trial {trial:?} twice"), "name each trial once")
        }));
    }
    if p.folds.as_ref().is_some_and(Vec::is_empty) {
        let help = "name the validation trials of each fold: folds = [[\"1\"], [\"2\"]], or leave the key out";
        faults.push(Fault::new("protocol.folds", "is empty, so no epoch could be chosen", help));
    }
    if let (Some(folds), Some(chosen)) = (&p.folds, p.validation_fold)
        && folds.len() <= chosen
    {
        let what = format!("is {chosen}, and protocol.folds has {} folds", folds.len());
        let help = format!("write 0 to {}", folds.len().max(1) - 1);
        faults.push(Fault::new("protocol.validation_fold", what, help));
    }
    if p.leave_out.is_some() && p.folds.is_some() {
        let help = "delete one of the two: folds lists trials, leave_out has them found";
        faults.push(Fault::new("protocol.leave_out", "is set together with protocol.folds", help));
    }
    if p.leave_out.as_ref().is_some_and(String::is_empty) {
        let help = "write \"trial\", \"block\" or the name of a signal, or leave the key out for the rule";
        faults.push(Fault::new("protocol.leave_out", "is empty", help));
    }
    if p.held_out.as_ref().is_some_and(Vec::is_empty) {
        let help = "name the trials that take no part in learning, or leave the key out for the manifest's";
        faults.push(Fault::new("protocol.held_out", "is empty", help));
    }
    faults
}

/// Returns whether a network may learn from trials of this role. Held-out and excluded trials take no part.
fn may_learn_from(role: Role) -> bool {
    matches!(role, Role::Calibration | Role::Development)
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
    if i.learn_from.iter().any(|role| !may_learn_from(*role)) {
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
    if i.chosen_from.as_ref().is_some_and(Vec::is_empty) {
        let help = "delete it: a run that chooses its inputs writes what they were chosen from";
        faults.push(Fault::new("inputs.chosen_from", "is empty", help));
    }
    for (key, twice) in [
        ("channels", twice(i.channels.iter().flatten())),
        ("chosen_from", twice(i.chosen_from.iter().flatten())),
        ("shuffled", twice(&i.shuffled)),
    ] {
        faults.extend(twice.map(|name| {
            Fault::new(&format!("inputs.{key}"), format!("names {name:?} twice"), "name each channel once")
        }));
    }
    faults
}

/// Returns the first value that occurs twice.
fn twice<T: Ord>(all: impl IntoIterator<Item = T>) -> Option<T> {
    let mut seen = BTreeSet::new();
    for one in all {
        if seen.contains(&one) {
            return Some(one);
        }
        seen.insert(one);
    }
    None
}

/// Returns the faults of `[nominal]`.
pub fn nominal(n: &Nominal) -> Vec<Fault> {
    let mut faults = vec![];
    for (key, value) in [("nominal.length", n.length), ("nominal.tolerance", n.tolerance)] {
        if value.is_some_and(|value| value <= 0.0) {
            faults.push(Fault::new(key, format!("is {} m", value.unwrap_or_default()), "write a length above 0, in m"));
        }
    }
    if n.length.is_some_and(|length| length > LONGEST_ARM) {
        let length = n.length.unwrap_or_default();
        faults.push(Fault::new(
            "nominal.length",
            format!("is {length} m"),
            format!("write it in m, {LONGEST_ARM} at most; 620 mm are 0.62"),
        ));
    }
    let usual = ArmSpec::default();
    let arm = ArmSpec {
        length: 1.0,
        strain: n.strain.unwrap_or(usual.strain),
        degree: n.degree.unwrap_or(usual.degree),
        steps: n.steps.unwrap_or(usual.steps),
        ..usual
    };
    faults.extend(arm.validate().err().map(|error| of_arm(&error)));
    faults.extend(Fault::count("nominal.comparator_degree", n.comparator_degree, 1, LARGEST_DEGREE, "3"));
    faults.extend(augmented(n));
    faults
}

/// Converts the refusal of an arm to terms of the experiment.
fn of_arm(error: &ArmError) -> Fault {
    match error {
        ArmError::OutOfRange { what, value, least, most } => Fault::new(
            &format!("nominal.{what}"),
            format!("is {value}"),
            format!("write a whole number from {least} to {most}"),
        ),
        other => Fault::new("nominal", format!("cannot be: {other}"), "correct the value, or leave it out"),
    }
}

/// Returns the fault of keys beside a saved model, which brings their values itself.
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
    let what = "is set together with nominal.augmented, which has its own model";
    Some(Fault::new(&format!("nominal.{key}"), what, "delete one of the two"))
}
