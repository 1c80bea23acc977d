//! A list of experiments: every run of every member side by side, then the table.

use toml::Value;

use super::{
    list::{self, List, Member},
    record::{self, MemberRecord, Runs, StudyRecord},
    sweep::{Setting, Sweep},
    table,
};
use crate::{
    config::{Experiment, Kind, Source},
    run::{
        record::{FORMAT, RunRecord},
        summary,
    },
    schedule::{
        answer::{Answer, nothing_to_submit},
        engine,
        error::ScheduleError,
        ready::{Campaigns, Ready},
        request::Request,
    },
    store::{RunFolder, StoreError, StudyFolder, atomic, hashed},
};

/// Conducts a sweep, an ablation or a comparison, and returns the table to print.
///
/// # Errors
/// Anything in [`ScheduleError`]; finished runs are kept, and unfinished ones are checkpointed.
pub fn conduct(kind: Kind, source: &Source, request: &Request) -> Result<String, ScheduleError> {
    let list = list::read(source, kind)?;
    let folder = StudyFolder::hold(request.out, request.hold())?;
    let mut study = Study { kind, list: &list, source, request, members: vec![], records: vec![] };
    let answer = match &list.sweep {
        None => study.run(list.members(source)?, &mut Campaigns::default())?,
        Some(sweep) => study.sweep(sweep)?,
    };
    if let Answer::Waiting(text) = answer {
        return Ok(text);
    }
    if request.engine.only_looks() {
        return Ok(nothing_to_submit(study.records.iter().map(Vec::len).sum()));
    }
    let record = study.record();
    let runs: Vec<Runs> =
        record.members.iter().zip(&study.records).map(|(member, records)| Runs { member, records }).collect();
    if kind == Kind::Sweep {
        study.write_best(&folder, &runs)?;
    }
    let root = request.out.display();
    let text = table::text(&record, &runs);
    Ok(format!("{text}\n\nrecords and predictions: {root}\na page: cargo run -p acm-eval -- report {root}"))
}

struct Study<'a> {
    kind: Kind,
    list: &'a List,
    source: &'a Source,
    request: &'a Request<'a>,
    members: Vec<Member>,
    /// Of each member.
    records: Vec<Vec<RunRecord>>,
}

impl Study<'_> {
    /// Runs some members beside those that are done.
    fn run(&mut self, members: Vec<Member>, campaigns: &mut Campaigns) -> Result<Answer<()>, ScheduleError> {
        let ready = |member: &Member| Ready::new(member.experiment.clone(), &member.source, self.request, campaigns);
        let ready: Vec<Ready> = members.iter().map(ready).collect::<Result<_, _>>()?;
        let claim = |(ready, member): (&Ready, &Member)| {
            ready.claim(&record::folder(self.request.out, &member.id), self.request.hold())
        };
        let folders: Vec<RunFolder> = ready.iter().zip(&members).map(claim).collect::<Result<_, _>>()?;
        self.members.extend(members);
        if !self.request.engine.only_looks() {
            hashed::write(&self.request.out.join("study.json"), &self.record())?;
        }
        if let (true, Some(first)) = (self.records.is_empty(), ready.first()) {
            self.request.progress.note(&first.description());
        }
        let runs = ready.iter().map(|ready| ready.plans.len()).sum();
        let experiments = summary::count(ready.len(), "experiment");
        self.request.progress.note(&format!("{experiments}, {}", summary::count(runs, "run")));
        Ok(match engine::run(&ready, &folders, self.request)? {
            Answer::Waiting(text) => Answer::Waiting(text),
            Answer::Finished(records) => {
                self.records.extend(records);
                Answer::Finished(())
            }
        })
    }

    /// Batch after batch for all bases at once, each base with its own settings.
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

    /// Validation errors of the settings of a base so far.
    fn errors(&self, base: &str) -> Vec<f64> {
        let of = self.members.iter().zip(&self.records).filter(|(member, _)| member.base == base);
        of.map(|(_, records)| table::validation_error(records).unwrap_or(f64::INFINITY)).collect()
    }

    fn record(&self) -> StudyRecord {
        let member = |member: &Member| MemberRecord {
            id: member.id.clone(),
            base: member.base.clone(),
            variant: member.variant.clone(),
            values: member.values.iter().map(|(key, value)| (key.clone(), value.to_string())).collect(),
        };
        let members = self.members.iter().map(member).collect();
        StudyRecord {
            format: FORMAT,
            kind: self.kind,
            question: self.list.question.clone(),
            config: self.source.file_name(),
            members,
        }
    }

    /// The experiment with the smallest validation error of each base, with that base's own protocol.
    fn write_best(&self, folder: &StudyFolder, runs: &[Runs]) -> Result<(), ScheduleError> {
        for base in &self.list.base {
            let Some(best) = table::ranked(&base.name, runs).first().map(|runs| &runs.member.id) else { continue };
            let Some(member) = self.members.iter().find(|member| member.id == *best) else { continue };
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

/// `length=25 units=16`: the last part of each key with its value.
fn label(setting: &Setting) -> String {
    let part = |(key, value): &(String, Value)| {
        let text = value.as_str().map_or_else(|| value.to_string(), String::from);
        format!("{}={text}", key.rsplit('.').next().unwrap_or(key))
    };
    setting.iter().map(part).collect::<Vec<_>>().join(" ")
}
