//! The winner: its final runs, and their mean prediction of the held-out trials, which are read here for the first time.

use std::path::{Path, PathBuf};

use acm_datasets::DataError;
use acm_datasets::files::table::write_parquet_groups;
use nalgebra::DMatrix;

use super::{
    asked::LOOP,
    candidate::Candidate,
    entrant::{self, Entrant},
    forecast::{self, Targets},
    record::{WINNER, Winner, WinnerMember},
    search::Search,
};
use crate::run::RunError;
use crate::run::evaluation::alone;
use crate::run::evaluation::intervals::{self, Predicted};
use crate::run::evaluation::score::{TrialPrediction, part_scores};
use crate::run::record::RunRecord;
use crate::run::record::predictions::groups;
use crate::schedule::engine::answer::Answer;
use crate::schedule::error::ScheduleError;
use crate::schedule::ready::Ready;
use crate::schedule::study::list::Member;
use crate::schedule::study::record::folder;
use crate::store::{StoreError, hashed};

/// Path of the table of its predictions.
const TABLE: &str = "predictions/best.parquet";

/// Trains the members of the winner and scores their mean; with `protocol.final = false` neither. `left_out` is what it predicts
/// of each fold; its intervals are written from it.
///
/// # Errors
/// Anything in [`ScheduleError`]; finished runs are kept, and unfinished ones are checkpointed.
pub fn conduct(
    search: &mut Search,
    winner: &Candidate,
    left_out: &[Predicted],
) -> Result<Answer<Winner>, ScheduleError> {
    let learned = |name: &String| search.entrants.iter().position(|entrant| entrant.name == *name);
    let places: Vec<Option<usize>> = winner.members.iter().map(learned).collect();
    let wanted = search.entrants.first().is_some_and(|first| first.experiment.protocol.final_runs);
    let members = winner.members.iter().zip(&places).map(|(name, place)| member(search, name, *place, wanted));
    let members: Vec<WinnerMember> = members.collect::<Result<_, _>>()?;
    if !wanted {
        write_intervals(search, left_out, &Targets::default(), vec![])?;
        return Ok(Answer::Finished(Winner { members, trained: false, held_out: None, predictions: None }));
    }
    let runs: Vec<Member> = places.iter().flatten().map(|&place| search.entrants[place].to_the_end()).collect();
    let before = search.batches.records.len();
    if !runs.is_empty()
        && let Answer::Waiting(text) = search.batches.run(runs, &mut search.campaigns)?
    {
        return Ok(Answer::Waiting(text));
    }
    let mut trials = alone_of(search, false)?;
    let outputs = names_of_outputs(search)?;
    let mut finals = search.batches.records[before..].iter().cloned();
    let mut sum = vec![0.0; targets(&trials).measured.len()];
    let said = winner.members.iter().zip(&places);
    let said: Vec<(&String, Option<Vec<RunRecord>>)> =
        said.map(|(name, place)| (name, place.and_then(|_| finals.next()))).collect();
    for ((name, records), member) in said.into_iter().zip(&members) {
        let own = match records {
            Some(records) => learned_of(search, &records, &member.folder, &targets(&trials), name)?,
            None => flat(&alone_of(search, name == LOOP)?, |trial| &trial.nominal),
        };
        forecast::add(&mut sum, &own);
    }
    sum.iter_mut().for_each(|value| *value /= winner.members.len() as f64);
    fill(&mut trials, &sum);
    write_intervals(search, left_out, &targets(&trials), sum)?;
    let (mut held_out, mut predictions) = (None, None);
    if !trials.is_empty() && !search.batches.request.engine.only_looks() {
        held_out = Some(part_scores(&trials, WINNER));
        predictions = Some(table(search.batches.request.out, &trials, &outputs)?);
    }
    Ok(Answer::Finished(Winner { members, trained: true, held_out, predictions }))
}

/// Writes the intervals of the winner, where two units or more were left out.
fn write_intervals(
    search: &Search,
    left_out: &[Predicted],
    held_out: &Targets,
    predicted: Vec<f64>,
) -> Result<(), ScheduleError> {
    let request = search.batches.request;
    let value_of = search.first()?.folds.as_ref().and_then(|folds| folds.value_of.as_ref());
    let held_out = Predicted { trial: &held_out.trial, measured: &held_out.measured, predicted };
    match intervals::of_folds(&search.first()?.outputs, value_of, left_out, &held_out) {
        Some(found) if !request.engine.only_looks() => Ok(hashed::write(&request.out.join(intervals::FILE), &found)?),
        _ => Ok(()),
    }
}

fn member(search: &Search, name: &str, place: Option<usize>, wanted: bool) -> Result<WinnerMember, ScheduleError> {
    let same_nominal = search.entrants.iter().find(|entrant| entrant.above == (name == LOOP));
    let below = |id: &str| folder(Path::new(""), id);
    let folder = match (place, wanted) {
        (Some(place), true) => below(&search.entrants[place].to_the_end().id),
        (Some(place), false) => below(&search.entrants[place].id),
        (None, _) => below(&same_nominal.ok_or_else(entrant::no_folds)?.id),
    };
    Ok(WinnerMember { name: name.into(), folder, learned: place.is_some() })
}

fn names_of_outputs(search: &Search) -> Result<Vec<String>, ScheduleError> {
    Ok(search.first()?.outputs.clone())
}

/// Returns the nominal model, or that of the loop, on held-out trials; the mean over folds where each calibrates its
/// own.
fn alone_of(search: &mut Search, above: bool) -> Result<Vec<TrialPrediction>, ScheduleError> {
    let found = search.entrants.iter().find(|entrant: &&Entrant| entrant.above == above);
    let Member { mut experiment, source, .. } = found.ok_or_else(entrant::no_folds)?.to_the_end();
    experiment.protocol.cross_validation = true;
    let ready = Ready::new(experiment, &source, search.batches.request, &mut search.campaigns)?;
    Ok(alone::held_out(&ready.setting(), &ready.plans)?)
}

/// Returns the mean over the final runs of a member.
fn learned_of(
    search: &Search,
    records: &[RunRecord],
    place: &Path,
    targets: &Targets,
    name: &str,
) -> Result<Vec<f64>, ScheduleError> {
    let records: Vec<&RunRecord> = records.iter().collect();
    let place = search.batches.request.out.join(place);
    let Some(found) = forecast::mean(&place, &records, "held_out")? else { return Err(entrant::no_folds()) };
    forecast::same(targets, &found.targets, name)?;
    Ok(found.predicted)
}

/// Returns a matrix of each trial as one list, target by target.
fn flat(trials: &[TrialPrediction], of: fn(&TrialPrediction) -> &DMatrix<f64>) -> Vec<f64> {
    trials.iter().flat_map(|trial| of(trial).transpose().as_slice().to_vec()).collect()
}

fn targets(trials: &[TrialPrediction]) -> Targets {
    let named =
        |trial: &TrialPrediction| std::iter::repeat_n(trial.trial.clone(), trial.time.len()).collect::<Vec<_>>();
    Targets {
        trial: trials.iter().flat_map(named).collect(),
        time: trials.iter().flat_map(|trial| trial.time.clone()).collect(),
        measured: flat(trials, |trial| &trial.measured),
    }
}

/// Writes a list, target by target, to the predictions of the trials.
fn fill(trials: &mut [TrialPrediction], values: &[f64]) {
    let mut rest = values;
    for trial in trials {
        let (rows, columns) = trial.predicted.shape();
        let (own, others) = rest.split_at(rows * columns);
        trial.predicted = DMatrix::from_row_slice(rows, columns, own);
        rest = others;
    }
}

fn table(out: &Path, trials: &[TrialPrediction], outputs: &[String]) -> Result<(PathBuf, String), ScheduleError> {
    let path = out.join(TABLE);
    let folder = path.parent().unwrap_or(out);
    std::fs::create_dir_all(folder).map_err(|source| StoreError::io("make", folder, source))?;
    let rows = trials.iter().map(|trial| Ok::<_, DataError>(("held_out", trial.clone())));
    write_parquet_groups(&path, groups(rows, outputs)).map_err(RunError::from)?;
    Ok((TABLE.into(), hashed::of_file(&path)?))
}
