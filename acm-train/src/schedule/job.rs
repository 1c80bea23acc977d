//! One experiment: from its file to its run folder.

use std::{path::Path, slice};

use acm_datasets::text::hint::command;

use super::engine::answer::{Answer, nothing_to_submit};
use super::engine::{self, queue};
use super::error::ScheduleError;
use super::ready::{Campaigns, Ready};
use super::request::Request;
use super::study::eliminate::settled;
use crate::config::{Experiment, Source};
use crate::run::evaluation::{intervals, summary, verdict};
use crate::run::record::RunRecord;
use crate::store::Hold;

/// Computes the runs of an experiment as the request says, and returns the text to print: the table, or the progress.
///
/// # Errors
/// Anything in [`ScheduleError`]; finished runs are kept, and unfinished ones are checkpointed.
pub fn conduct(experiment: Experiment, source: &Source, request: &Request) -> Result<String, ScheduleError> {
    let mut campaigns = Campaigns::default();
    let (experiment, chosen) = match settled(experiment, source, request.out, request, &mut campaigns)? {
        Answer::Waiting(text) => return Ok(text),
        Answer::Finished(settled) => settled,
    };
    let ready = Ready::new(experiment, source, request, &mut campaigns)?;
    let folder = ready.claim(request.out, request.hold())?;
    tell(&ready, request);
    Ok(match engine::run(slice::from_ref(&ready), slice::from_ref(&folder), request)? {
        Answer::Waiting(text) => text,
        Answer::Finished(_) if request.engine.only_looks() => nothing_to_submit(ready.plans.len()),
        Answer::Finished(records) => {
            let between = if chosen.is_empty() { "" } else { "\n\n" };
            chosen + between + &report(&records.concat(), request.out)?
        }
    })
}

fn tell(ready: &Ready, request: &Request) {
    request.progress.note(&ready.description());
    request.progress.note(&summary::count(ready.plans.len(), "run"));
}

/// Runs an experiment here to its final scores; `source` says where its values came from, and paths are found from there.
///
/// The same experiment with another `nominal` is scored at the same time stamps ([`crate::run::evaluation::held_out`]).
///
/// # Errors
/// As [`conduct`].
pub fn run(experiment: Experiment, source: &Source, request: &Request) -> Result<Vec<RunRecord>, ScheduleError> {
    let mut campaigns = Campaigns::default();
    let Answer::Finished((experiment, _)) = settled(experiment, source, request.out, request, &mut campaigns)? else {
        return Err(ScheduleError::Usage {
            what: "inputs.select = true waits for others".into(),
            help: "choose the inputs with acm-train first, and name them in inputs.channels".into(),
        });
    };
    let ready = Ready::new(experiment, source, request, &mut campaigns)?;
    let folder = ready.claim(request.out, Hold::Alone { resume: request.resume })?;
    tell(&ready, request);
    Ok(queue::run(slice::from_ref(&ready), slice::from_ref(&folder), request)?.into_iter().flatten().collect())
}

/// Writes the report of the finished runs in a folder.
///
/// # Errors
/// Their intervals cannot be read.
pub fn report(records: &[RunRecord], out: &Path) -> Result<String, ScheduleError> {
    let records: Vec<&RunRecord> = records.iter().collect();
    let intervals = intervals::read(out)?.map(|intervals| intervals.text(&records));
    let verdict = verdict::of(&records).map(|verdict| verdict.sentence(&records));
    let page = command("acm-eval", "report", out, "");
    let written = format!("records, predictions, training.log: {}\nfigures and a page: {page}", out.display());
    let parts = [Some(summary::text(&records)), intervals, verdict, Some(written)];
    Ok(parts.into_iter().flatten().collect::<Vec<_>>().join("\n\n"))
}
