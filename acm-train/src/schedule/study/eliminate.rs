//! Running an elimination of inputs ([`super::inputs`]), for a study or at the start of a run.
//!
//! ```text
//! runs/<name>/             a study, study = "inputs"; or inputs/ below the folder of a run with inputs.select = true
//!   study.json             StudyRecord: each set that was tried, in order
//!   runs/<id>/             its runs in cross-validation
//! ```
//!
//! Each set is trained in cross-validation alone: no held-out trial is read to choose.

use std::path::Path;

use toml::Value;

use super::{
    batch::Batches,
    inputs::{self, Tried},
    list::{Member, folder},
    steps,
};
use crate::config::{Experiment, Kind, Source};
use crate::schedule::engine::answer::Answer;
use crate::schedule::error::ScheduleError;
use crate::schedule::ready::{Campaigns, Ready};
use crate::schedule::request::Request;
use crate::store::{RunFolder, StudyFolder};

/// Folder of the elimination within that of a run.
pub const FOLDER: &str = "inputs";

/// An experiment whose inputs are to be chosen.
#[derive(Debug)]
pub struct Base {
    /// Name in tables.
    pub name: String,
    /// Experiment of the base.
    pub experiment: Experiment,
    /// Source of its values.
    pub source: Source,
}

impl Base {
    /// Returns the experiment with these inputs, or with all, in cross-validation.
    fn member(&self, inputs: Option<&[String]>) -> Member {
        let mut experiment = self.experiment.clone();
        experiment.inputs.select = false;
        (experiment.protocol.cross_validation, experiment.protocol.final_runs) = (true, false);
        let mut values = vec![];
        if let Some(inputs) = inputs {
            experiment.inputs.channels = Some(inputs.to_vec());
            experiment.inputs.shuffled.retain(|name| inputs.contains(name));
            let list = inputs.iter().cloned().map(Value::String).collect();
            values.push(("inputs.channels".to_string(), Value::Array(list)));
        }
        let variant = inputs.map_or("all inputs".into(), |inputs| inputs.join(" "));
        let (base, source) = (self.name.clone(), self.source.clone());
        Member { id: folder(&base, &variant), base, variant, values, experiment, source }
    }
}

/// Tries set after set for all bases at once.
///
/// # Errors
/// Anything in [`ScheduleError`]; finished runs are kept, and unfinished ones are checkpointed.
pub fn conduct(bases: &[Base], batches: &mut Batches, campaigns: &mut Campaigns) -> Result<Answer<()>, ScheduleError> {
    let mut batch: Vec<Member> = bases.iter().map(|base| base.member(None)).collect();
    while !batch.is_empty() {
        if let Answer::Waiting(text) = batches.run(batch, campaigns)? {
            return Ok(Answer::Waiting(text));
        }
        let next = |base: &Base| -> Vec<Member> {
            let sets = inputs::next(&tried(&base.name, batches));
            sets.iter().map(|set| base.member(Some(set))).collect()
        };
        batch = bases.iter().flat_map(next).collect();
    }
    Ok(Answer::Finished(()))
}

/// Returns the sets of a base so far.
fn tried(base: &str, batches: &Batches) -> Vec<Tried> {
    batches.of(base).filter_map(|(_, records)| steps::tried(records)).collect()
}

/// Returns the experiment to be run in `out`: with `inputs.select`, the one with the chosen inputs, and a text on the
/// choice.
///
/// # Errors
/// As [`conduct`].
pub fn settled(
    experiment: Experiment,
    source: &Source,
    out: &Path,
    request: &Request,
    campaigns: &mut Campaigns,
) -> Result<Answer<(Experiment, String)>, ScheduleError> {
    if !experiment.inputs.select {
        return Ok(Answer::Finished((experiment, String::new())));
    }
    let base = Base { name: experiment.kind(), experiment: alone(&experiment), source: source.clone() };
    let member = base.member(None);
    // What cannot be run leaves no folder.
    Ready::new(member.experiment, source, request, campaigns)?;
    let _whole = RunFolder::hold(out, request.hold())?;
    let inner = out.join(FOLDER);
    let _folder = StudyFolder::hold(&inner, request.hold())?;
    let request = Request { out: &inner, ..*request };
    let question = "Which inputs carry the estimate?".to_string();
    let mut batches = Batches::new(Kind::Inputs, question, source.file_name(), &request);
    if let Answer::Waiting(text) = conduct(std::slice::from_ref(&base), &mut batches, campaigns)? {
        return Ok(Answer::Waiting(text));
    }
    let sets = tried(&base.name, &batches);
    let record = batches.record();
    let text = steps::text(&record, &batches.runs(&record));
    Ok(Answer::Finished((with(experiment, &sets), text)))
}

/// Returns the experiment with one seed, which suffices to compare sets: each pair shares it.
fn alone(experiment: &Experiment) -> Experiment {
    let mut alone = experiment.clone();
    alone.protocol.seeds.truncate(1);
    alone.protocol.validation_fold = None;
    alone
}

/// Returns the experiment with the inputs that were chosen from the first of the sets.
fn with(mut experiment: Experiment, sets: &[Tried]) -> Experiment {
    if let Some(all) = sets.first() {
        let chosen = sets[inputs::chosen(sets)].inputs.clone();
        experiment.inputs.shuffled.retain(|name| chosen.contains(name));
        experiment.inputs.chosen_from = Some(all.inputs.clone());
        experiment.inputs.channels = Some(chosen);
        experiment.inputs.select = false;
    }
    experiment
}
