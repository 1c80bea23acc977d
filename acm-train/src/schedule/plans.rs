//! The protocol as a list of runs: training trials and seed of each.
//!
//! | stage             | runs                  | learns from      | epoch chosen on | scored on             |
//! | ----------------- | --------------------- | ---------------- | --------------- | --------------------- |
//! | cross-validation  | one per fold and seed | the other folds  | the fold        | the fold              |
//! | final             | one per seed          | all but one fold | that fold       | that fold; held-out trials once, at the end |
//! | final, with cross-validation and a carried state | one per seed | all folds | the runs of cross-validation | held-out trials once, at the end |
//!
//! What the folds are, [`acm_datasets::folds`] says. In final runs the k-th seed leaves out the k-th of K folds, then k mod K, so that all of
//! them choose epochs; `protocol.validation_fold` asks for one of them.
//!
//! Trials of the roles in `inputs.learn_from` that no fold names are learned from in every run. `protocol.held_out` takes
//! the place of the manifest's held-out trials, which are then learned from as well.

use std::collections::BTreeSet;

use acm_datasets::{
    Entry, Manifest, Role,
    folds::{By, Folds, LeaveOut, folds as rule},
    manifest::FoldTable,
};

use super::error::ScheduleError;
use crate::{
    config::{ConfigError, Experiment, Fault, Source},
    run::{
        data::Data,
        names,
        plan::Plan,
        record::{FoldStamp, Split, Stage},
    },
};

/// Returns all runs that the experiment requests, cross-validation first; `folds` are of `data`.
///
/// # Errors
/// There is no such fold.
pub fn plans(experiment: &Experiment, source: &Source, data: &Data, folds: &Folds) -> Result<Vec<Plan>, ConfigError> {
    let (learners, held_out) = parts(experiment, source, data)?;
    let (protocol, count) = (&experiment.protocol, folds.validation.len());
    refuse_unknown_fold(protocol.validation_fold.unwrap_or(0), count, source)?;
    let split = |fold: usize, held_out: &[String]| {
        let left_out: BTreeSet<&String> = folds.validation[fold].iter().collect();
        let training = learners.iter().filter(|trial| !left_out.contains(trial)).cloned().collect();
        Split { training, validation: folds.validation[fold].clone(), held_out: held_out.to_vec() }
    };
    let value_of = match &folds.by {
        By::Value(signal) => Some(signal.clone()),
        By::List | By::Trial | By::Block => None,
    };
    let stamp = |fold: usize| FoldStamp { made: folds.to_string(), count, fold, value_of: value_of.clone() };
    let mut plans = vec![];
    if protocol.cross_validation {
        // Where the folds only choose for the final runs, one seed of each is enough.
        let seeds = &protocol.seeds[..if experiment.refits() { 1 } else { protocol.seeds.len() }];
        let runs = (0..count).flat_map(|fold| seeds.iter().map(move |&seed| (fold, seed)));
        plans.extend(runs.map(|(fold, seed)| {
            let (id, stage) = (format!("fold{fold}-seed{seed}"), Stage::CrossValidation { fold });
            Plan { id, stage, seed, folds: stamp(fold), split: split(fold, &[]) }
        }));
    }
    if protocol.final_runs {
        plans.extend(protocol.seeds.iter().enumerate().map(|(k, &seed)| {
            let fold = protocol.validation_fold.unwrap_or(k % count);
            let (id, stage) = (format!("final-seed{seed}"), Stage::Final);
            let all = Split { training: learners.clone(), validation: vec![], held_out: held_out.clone() };
            let split = if experiment.refits() { all } else { split(fold, &held_out) };
            Plan { id, stage, seed, folds: stamp(fold), split }
        }));
    }
    Ok(plans)
}

/// Returns the folds of the experiment, and its data as they need them: cut in blocks of time where those are left out.
///
/// # Errors
/// A fold names a trial that is not learned from, or leaves none to learn from; a signal that is to be left out is not
/// constant within trials; a trial that cannot be read.
pub fn folds(experiment: &Experiment, source: &Source, mut data: Data) -> Result<(Folds, Data), ScheduleError> {
    let (learners, held_out) = parts(experiment, source, &data)?;
    let folds = made(experiment, source, &data, &learners, &held_out)?;
    if folds.by == By::Block {
        let cut = validating(&data, &learners).into_iter().map(|entry| entry.name.clone()).collect::<Vec<_>>();
        data.cut(&cut, folds.validation.len(), experiment.windows.gap(), experiment.memory.is_trial())?;
    }
    let (learners, _) = parts(experiment, source, &data)?;
    refuse_unknown_trials(experiment, source, &learners, &folds)?;
    Ok((folds, data))
}

fn made(
    experiment: &Experiment,
    source: &Source,
    data: &Data,
    learners: &[String],
    held_out: &[String],
) -> Result<Folds, ConfigError> {
    let protocol = &experiment.protocol;
    if let Some(listed) = &protocol.folds {
        return Ok(Folds::listed(listed.clone()));
    }
    let asked = match protocol.leave_out.as_deref() {
        None => LeaveOut::Rule,
        Some("trial") => LeaveOut::Trial,
        Some("block") => LeaveOut::Block,
        Some(signal) => LeaveOut::Value(signal.into()),
    };
    let held_out: Vec<&Entry> = data.entries.iter().filter(|entry| held_out.contains(&entry.name)).collect();
    // The manifest's folds are of its own parts.
    let listed = if protocol.held_out.is_some() { FoldTable::default() } else { data.manifest.folds.clone() };
    let manifest = Manifest { folds: listed, ..data.manifest.clone() };
    let made = rule(&manifest, &asked, &validating(data, learners), &held_out, experiment.targets(1).reach);
    made.ok_or_else(|| {
        let signal = protocol.leave_out.as_deref().unwrap_or_default();
        let what = format!("is {signal:?}, which is no signal that is constant within trials and differs between them");
        let help = "write \"trial\", \"block\", or the name of a context signal, an actuator or a condition";
        let fault = Fault::new("protocol.leave_out", what, help);
        Box::new(source.complaint(&fault.key, fault.what, fault.help)).into()
    })
}

/// Returns the trials that validate in turn: those learned from but calibration trials, unless there are no others.
fn validating<'d>(data: &'d Data, learners: &[String]) -> Vec<&'d Entry> {
    let learned = || data.entries.iter().filter(|entry| learners.contains(&entry.name));
    let others: Vec<&Entry> = learned().filter(|entry| entry.role != Role::Calibration).collect();
    if others.is_empty() { learned().collect() } else { others }
}

/// Returns the trials to learn from, and trials to be left out of everything.
fn parts(experiment: &Experiment, source: &Source, data: &Data) -> Result<(Vec<String>, Vec<String>), ConfigError> {
    let learned = |role: Role| experiment.inputs.learn_from.contains(&role);
    let Some(asked) = &experiment.protocol.held_out else {
        return Ok((names(data, learned), names(data, |role| role == Role::HeldOut)));
    };
    let all = names(data, |role| learned(role) || role == Role::HeldOut);
    let unknown = asked.iter().find(|trial| !all.contains(trial));
    source.refuse_first(unknown.map(|trial| {
        let what = format!("names trial {trial:?}, which is neither learned from nor held out");
        Fault::new("protocol.held_out", what, format!("name some of {}", names::some(&all, ", ")))
    }))?;
    let (held_out, learners) = all.into_iter().partition(|trial| asked.contains(trial));
    Ok((learners, held_out))
}

fn names(data: &Data, wanted: impl Fn(Role) -> bool) -> Vec<String> {
    data.entries.iter().filter(|entry| wanted(entry.role)).map(|entry| entry.name.clone()).collect()
}

fn refuse_unknown_trials(
    experiment: &Experiment,
    source: &Source,
    learners: &[String],
    folds: &Folds,
) -> Result<(), ConfigError> {
    let learned: BTreeSet<&String> = learners.iter().collect();
    let refuse = |fold: usize, what: String, help: String| {
        let key = ["protocol".to_string(), "folds".to_string(), fold.to_string()];
        Err(ConfigError::from(Box::new(source.complaint(&key, what, help))))
    };
    for (k, fold) in folds.validation.iter().enumerate() {
        if let Some(unknown) = fold.iter().find(|trial| !learned.contains(trial)) {
            let what = format!("fold {k} names trial \"{unknown}\", which is not among the trials learned from");
            let known = names::some(learners, ", ");
            let help = match experiment.protocol.folds {
                Some(_) => format!(
                    "learned from, by inputs.learn_from, are {known}: name some of them, or delete `folds`, which may be of \
                     other data; folds are then those of the manifest, or are made of the development trials"
                ),
                None => format!("learned from, by inputs.learn_from, are {known}"),
            };
            return refuse(k, what, help);
        }
        if fold.iter().collect::<BTreeSet<_>>() == learned {
            let what = format!("fold {k} takes all trials for validation and leaves none to learn from");
            return refuse(k, what, "leave at least one trial out of each fold".into());
        }
    }
    Ok(())
}

fn refuse_unknown_fold(chosen: usize, count: usize, source: &Source) -> Result<(), ConfigError> {
    if chosen < count {
        return Ok(());
    }
    let key = ["protocol".to_string(), "validation_fold".to_string()];
    let what = format!("`protocol.validation_fold` is {chosen}, and there are {count} folds");
    let help = match count {
        0 => "at least two trials to learn from are needed: one of them chooses the epoch".into(),
        count => format!("write 0 to {}", count - 1),
    };
    Err(ConfigError::from(Box::new(source.complaint(&key, what, help))))
}
