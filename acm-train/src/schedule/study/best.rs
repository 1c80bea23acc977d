//! Choice of the best model: all are compared under the same folds, and only the winner is scored on held-out trials.
//!
//! ```text
//! runs/<name>/
//!   study.json                  StudyRecord: every experiment that was run
//!   best.json                   BestRecord: every candidate, what was chosen, why, and its held-out error
//!   predictions/best.parquet    what the winner says of the held-out trials
//!   intervals.json              Intervals: how far off its predictions may be, from those of the folds
//!   runs/<base>/                a base in cross-validation; with inputs.select, its choice of inputs in inputs/
//!   runs/<base>-loop/           the same upon the loop's model
//!   runs/final-<base>/          of the winner alone: its final runs
//! ```
//!
//! 1. Each base is trained in cross-validation, and once more with the loop's model below where one is named.
//! 2. Candidates are the nominal model, the loop's model, each of the former, and averages ([`average`]).
//! 3. The simplest candidate within one standard error of the best, or 1 % of its error, is chosen ([`candidate`]).
//! 4. Its members are trained in final runs, whose epochs are chosen on one fold after the other, and the mean of what they
//!    predict is scored once on the held-out trials. With `protocol.final = false` it ends before.
//!
//! No held-out trial is read before 4. A base is the mean over its seeds, in the folds as in the end.

pub mod asked;
pub mod average;
pub mod candidate;
mod entrant;
mod forecast;
mod optimism;
pub mod record;
mod search;
pub mod text;
mod winner;

use asked::Asked;
use average::Pool;
use candidate::{Candidate, choose, mean};
use entrant::{Loop, entrants};
use record::{BestRecord, FILE};
use search::Search;

use super::{batch::Batches, list, of_sequences};
use crate::config::{Kind, Source};
use crate::run::evaluation::intervals::{self, Predicted};
use crate::run::record::FORMAT;
use crate::schedule::engine::answer::{Answer, nothing_to_submit};
use crate::schedule::error::ScheduleError;
use crate::schedule::ready::Campaigns;
use crate::schedule::request::Request;
use crate::store::{StudyFolder, hashed};

/// Finds the model to be used, and returns the table with the reasons.
///
/// # Errors
/// Anything in [`ScheduleError`]; finished runs are kept, and unfinished ones are checkpointed.
pub fn conduct(source: &Source, request: &Request) -> Result<String, ScheduleError> {
    let list = list::read(source, Kind::Best)?;
    if of_sequences::asks(&list, source) {
        return of_sequences::best::conduct(&list, source, request);
    }
    let upon = Loop::of(&list, source)?;
    let entrants = entrants(&list, source, upon.as_ref())?;
    let _folder = StudyFolder::hold(request.out, request.hold())?;
    let batches = Batches::new(Kind::Best, list.question.clone(), source.file_name(), request);
    let mut search = Search { upon, entrants, batches, campaigns: Campaigns::default() };
    match answer(&mut search, &list.best.unwrap_or_default())? {
        Answer::Waiting(text) => Ok(text),
        Answer::Finished(_) if request.engine.only_looks() => {
            Ok(nothing_to_submit(search.batches.records.iter().map(Vec::len).sum()))
        }
        Answer::Finished(record) => {
            hashed::write(&request.out.join(FILE), &record)?;
            Ok(text::of(&record, intervals::read(request.out)?.as_ref(), request.out))
        }
    }
}

/// Runs all steps of the head of this file.
fn answer(search: &mut Search, asked: &Asked) -> Result<Answer<BestRecord>, ScheduleError> {
    if let Answer::Waiting(text) = search.cross_validate()? {
        return Ok(Answer::Waiting(text));
    }
    let (singles, measured) = search.singles()?;
    let names: Vec<String> = singles.iter().map(|single| single.name.clone()).collect();
    let may: Vec<usize> = (0..singles.len()).filter(|&place| singles[place].streams || !asked.robot).collect();
    let error = |places: &[usize]| candidate::errors(places, &singles, &measured).mean();
    let (averages, steps) = average::grow(&Pool { names: &names, may: &may, error }, asked.average);
    let all: Vec<Vec<usize>> = (0..singles.len()).map(|place| vec![place]).chain(averages).collect();
    let mut candidates: Vec<Candidate> = all.iter().map(|places| Candidate::of(places, &singles, &measured)).collect();
    let chosen = choose(&mut candidates, asked.robot);
    let left_out = measured.trials.iter().zip(&measured.values).enumerate();
    let left_out: Vec<Predicted> = left_out
        .map(|(f, (trial, measured))| Predicted { trial, measured, predicted: mean(&all[chosen], &singles, f) })
        .collect();
    let winner = match winner::conduct(search, &candidates[chosen], &left_out)? {
        Answer::Waiting(text) => return Ok(Answer::Waiting(text)),
        Answer::Finished(winner) => winner,
    };
    let first = search.first()?;
    Ok(Answer::Finished(BestRecord {
        format: FORMAT,
        kind: Kind::Best,
        question: search.batches.question.clone(),
        config: search.batches.config.clone(),
        data: first.data.clone(),
        versions: first.versions.clone(),
        outputs: first.outputs.clone(),
        folds: first.folds.as_ref().map_or(String::new(), |folds| folds.made.clone()),
        optimism: singles.iter().map(|single| (single.name.clone(), single.optimism.clone())).collect(),
        augmented: search.upon.as_ref().map(Loop::stamp),
        notes: search.notes(),
        candidates,
        steps,
        winner,
    }))
}
