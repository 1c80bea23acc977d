//! The protocol as a list of runs: who learns from which trials, and with which seed.
//!
//! | stage             | runs                  | learns from      | epoch chosen on | scored on             |
//! | ----------------- | --------------------- | ---------------- | --------------- | --------------------- |
//! | cross-validation  | one per fold and seed | the other folds  | the fold        | the fold              |
//! | final             | one per seed          | all but one fold | that fold       | that fold; held-out trials once, at the end |
//!
//! Trials of the roles in `inputs.learn_from` that no fold names are learned from in every run. `protocol.held_out` takes
//! the place of the manifest's held-out trials, which are then learned from as well.

use std::collections::BTreeSet;

use acm_datasets::Role;

use crate::{
    config::{ConfigError, Experiment, Fault, Source},
    run::{
        data::Data,
        names,
        plan::Plan,
        record::{Split, Stage},
    },
};

/// All runs that the experiment asks for, cross-validation first.
///
/// # Errors
/// A fold names a trial that is not learned from, or leaves none to learn from; there is no such fold.
pub fn plans(experiment: &Experiment, source: &Source, data: &Data) -> Result<Vec<Plan>, ConfigError> {
    let (learners, held_out) = parts(experiment, source, data)?;
    let folds = folds(experiment, source, data, &learners)?;
    let protocol = &experiment.protocol;
    let split = |fold: usize, held_out: &[String]| {
        let left_out: BTreeSet<&String> = folds[fold].iter().collect();
        let training = learners.iter().filter(|trial| !left_out.contains(trial)).cloned().collect();
        Split { training, validation: folds[fold].clone(), held_out: held_out.to_vec() }
    };
    let mut plans = vec![];
    if protocol.cross_validation {
        let runs = (0..folds.len()).flat_map(|fold| protocol.seeds.iter().map(move |&seed| (fold, seed)));
        plans.extend(runs.map(|(fold, seed)| {
            let stage = Stage::CrossValidation { fold };
            Plan { id: format!("fold{fold}-seed{seed}"), stage, seed, fold, split: split(fold, &[]) }
        }));
    }
    if protocol.final_runs {
        let fold = protocol.validation_fold;
        plans.extend(protocol.seeds.iter().map(|&seed| Plan {
            id: format!("final-seed{seed}"),
            stage: Stage::Final,
            seed,
            fold,
            split: split(fold, &held_out),
        }));
    }
    Ok(plans)
}

/// Trials to learn from, and trials to be left out of everything.
fn parts(experiment: &Experiment, source: &Source, data: &Data) -> Result<(Vec<String>, Vec<String>), ConfigError> {
    let learned = |role: Role| experiment.inputs.learn_from.contains(&role);
    let Some(asked) = &experiment.protocol.held_out else {
        return Ok((names(data, learned), names(data, |role| role == Role::HeldOut)));
    };
    let all = names(data, |role| learned(role) || role == Role::HeldOut);
    let stranger = asked.iter().find(|trial| !all.contains(trial));
    source.refuse_first(stranger.map(|trial| {
        let what = format!("names trial {trial:?}, which is neither learned from nor held out");
        Fault::new("protocol.held_out", what, format!("name some of {}", names::some(&all, ", ")))
    }))?;
    let (held_out, learners) = all.into_iter().partition(|trial| asked.contains(trial));
    Ok((learners, held_out))
}

fn names(data: &Data, wanted: impl Fn(Role) -> bool) -> Vec<String> {
    data.entries.iter().filter(|entry| wanted(entry.role)).map(|entry| entry.name.clone()).collect()
}

fn folds(
    experiment: &Experiment,
    source: &Source,
    data: &Data,
    learners: &[String],
) -> Result<Vec<Vec<String>>, ConfigError> {
    let refuse = |key: &[&str], what: String, help: String| {
        let key: Vec<String> = key.iter().map(ToString::to_string).collect();
        Err(ConfigError::from(Box::new(source.complaint(&key, what, help))))
    };
    let folds = experiment.protocol.folds.clone().unwrap_or_else(|| data.folds());
    let learned: BTreeSet<&String> = learners.iter().collect();
    for (k, fold) in folds.iter().enumerate() {
        if let Some(stranger) = fold.iter().find(|trial| !learned.contains(trial)) {
            let what = format!("fold {k} names trial \"{stranger}\", which is not among the trials learned from");
            let known = names::some(learners, ", ");
            let help = match experiment.protocol.folds {
                Some(_) => format!(
                    "learned from, by inputs.learn_from, are {known}: name some of them, or delete `folds`, which may be of \
                     other data; folds are then those of the manifest, or are made of the development trials"
                ),
                None => format!("learned from, by inputs.learn_from, are {known}"),
            };
            return refuse(&["protocol", "folds", &k.to_string()], what, help);
        }
        if fold.iter().collect::<BTreeSet<_>>() == learned {
            let what = format!("fold {k} takes all trials for validation and leaves none to learn from");
            return refuse(
                &["protocol", "folds", &k.to_string()],
                what,
                "leave at least one trial out of each fold".into(),
            );
        }
    }
    let chosen = experiment.protocol.validation_fold;
    if chosen >= folds.len() {
        let what = format!("`protocol.validation_fold` is {chosen}, and there are {} folds", folds.len());
        let help = match folds.len() {
            0 => "at least two trials to learn from are needed: one of them chooses the epoch".into(),
            count => format!("write 0 to {}", count - 1),
        };
        return refuse(&["protocol", "validation_fold"], what, help);
    }
    Ok(folds)
}
