//! Running a list of experiments: every run of every member, then the table.

use acm_datasets::text::hint::command;

use super::{
    batch::Batches,
    eliminate::{self, Base, settled},
    label::label,
    list::{self, List, Member},
    of_sequences,
    record::{self, Runs},
    steps,
    sweep::{Setting, Sweep},
    table,
};
use crate::config::{Experiment, Kind, Source};
use crate::schedule::engine::answer::{Answer, nothing_to_submit};
use crate::schedule::error::ScheduleError;
use crate::schedule::ready::Campaigns;
use crate::schedule::request::Request;
use crate::store::{StoreError, StudyFolder, atomic};

/// Runs a sweep, an ablation, a comparison or a choice of inputs, and returns the table to print.
///
/// # Errors
/// Anything in [`ScheduleError`]; finished runs are kept, and unfinished ones are checkpointed.
pub fn conduct(kind: Kind, source: &Source, request: &Request) -> Result<String, ScheduleError> {
    let list = list::read(source, kind)?;
    if of_sequences::asks(&list, source) {
        return of_sequences::conduct(kind, &list, source, request);
    }
    let folder = StudyFolder::hold(request.out, request.hold())?;
    let batches = Batches::new(kind, list.question.clone(), source.file_name(), request);
    let mut study = Study { list: &list, source, batches };
    let answer = match (&list.sweep, kind) {
        (Some(sweep), _) => study.sweep(sweep)?,
        (None, Kind::Inputs) => study.inputs()?,
        (None, _) => study.run(list.members(source)?, &mut Campaigns::default())?,
    };
    if let Answer::Waiting(text) = answer {
        return Ok(text);
    }
    if request.engine.only_looks() {
        return Ok(nothing_to_submit(study.batches.records.iter().map(Vec::len).sum()));
    }
    let record = study.batches.record();
    let runs = study.batches.runs(&record);
    if kind == Kind::Sweep {
        study.write_best(&folder, &runs)?;
    }
    let root = request.out.display();
    let text = match kind {
        Kind::Inputs => format!("{}\n\n{}", record.question, steps::text(&record, &runs)),
        _ => table::text(&record, &runs),
    };
    let page = command("acm-eval", "report", request.out, "");
    Ok(format!("{text}\n\nrecords and predictions: {root}\na page: {page}"))
}

struct Study<'a> {
    list: &'a List,
    source: &'a Source,
    batches: Batches<'a>,
}

impl Study<'_> {
    /// Runs some members beside those that are done; the inputs of those that ask for it are chosen first.
    fn run(&mut self, mut members: Vec<Member>, campaigns: &mut Campaigns) -> Result<Answer<()>, ScheduleError> {
        let request = self.batches.request;
        for member in &mut members {
            let out = record::folder(request.out, &member.id);
            match settled(member.experiment.clone(), &member.source, &out, request, campaigns)? {
                Answer::Waiting(text) => return Ok(Answer::Waiting(text)),
                Answer::Finished((experiment, _)) => member.experiment = experiment,
            }
        }
        self.batches.run(members, campaigns)
    }

    /// Runs set after set for all bases at once.
    fn inputs(&mut self) -> Result<Answer<()>, ScheduleError> {
        let base = |base: &list::Base| {
            let Member { experiment, source, .. } = self.list.member(self.source, base, "", vec![])?;
            Ok(Base { name: base.name.clone(), experiment, source })
        };
        let bases: Vec<Base> = self.list.base.iter().map(base).collect::<Result<_, ScheduleError>>()?;
        eliminate::conduct(&bases, &mut self.batches, &mut Campaigns::default())
    }

    /// Runs batch after batch for all bases at once, each base with its own settings.
    fn sweep(&mut self, sweep: &Sweep) -> Result<Answer<()>, ScheduleError> {
        let mut campaigns = Campaigns::default();
        let mut tried: Vec<Vec<Setting>> = vec![vec![]; self.list.base.len()];
        let epochs = |base| self.list.epochs(self.source, base);
        let epochs: Vec<usize> = self.list.base.iter().map(epochs).collect::<Result<_, _>>()?;
        loop {
            let mut batch = vec![];
            for ((base, epochs), tried) in self.list.base.iter().zip(&epochs).zip(&mut tried) {
                for setting in sweep.next(tried, &self.errors(&base.name), *epochs) {
                    batch.push(self.list.member(self.source, base, &label(&setting), setting.clone())?);
                    tried.push(setting);
                }
            }
            if batch.is_empty() {
                return Ok(Answer::Finished(()));
            }
            if let Answer::Waiting(text) = self.run(batch, &mut campaigns)? {
                return Ok(Answer::Waiting(text));
            }
        }
    }

    /// Returns the validation errors of the settings of a base so far.
    fn errors(&self, base: &str) -> Vec<f64> {
        let errors = self.batches.of(base).map(|(_, records)| table::validation_error(records));
        errors.map(|error| error.unwrap_or(f64::INFINITY)).collect()
    }

    /// Writes the experiment with the smallest validation error of each base, with that base's own protocol.
    fn write_best(&self, folder: &StudyFolder, runs: &[Runs]) -> Result<(), ScheduleError> {
        for base in &self.list.base {
            let Some(best) = table::ranked(&base.name, runs).first().map(|runs| &runs.member.id) else { continue };
            let Some(member) = self.batches.members.iter().find(|member| member.id == *best) else { continue };
            let original = self.list.original(self.source, base)?;
            let chosen = Experiment { protocol: original.protocol, ..member.experiment.clone() };
            let path = folder.path(&format!("best-{}.toml", list::slug(&base.name)));
            let text = toml::to_string(&chosen)
                .map_err(|error| StoreError::io("write", &path, std::io::Error::other(error)))?;
            let head =
                format!("# {}\n# Chosen by validation error from {} experiments.\n\n", chosen.question, runs.len());
            atomic::write(&path, (head + &text).as_bytes())?;
        }
        Ok(())
    }
}
