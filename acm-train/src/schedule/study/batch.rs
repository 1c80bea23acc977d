//! Batches of a study's members, each in a run folder below that of the study.

use super::{
    list::Member,
    record::{self, MemberRecord, Runs, StudyRecord},
};
use crate::config::Kind;
use crate::run::evaluation::summary;
use crate::run::record::{FORMAT, RunRecord};
use crate::schedule::engine;
use crate::schedule::engine::answer::Answer;
use crate::schedule::error::ScheduleError;
use crate::schedule::ready::{Campaigns, Ready};
use crate::schedule::request::Request;
use crate::store::{RunFolder, hashed};

/// Progress of a study.
pub struct Batches<'a> {
    /// Kind of the study.
    pub kind: Kind,
    /// Question of the study.
    pub question: String,
    /// Name of the file of the study.
    pub config: String,
    /// Settings of how and where the job runs.
    pub request: &'a Request<'a>,
    /// The members so far.
    pub members: Vec<Member>,
    /// Records of each member.
    pub records: Vec<Vec<RunRecord>>,
}

impl<'a> Batches<'a> {
    /// Returns a study without runs.
    pub fn new(kind: Kind, question: String, config: String, request: &'a Request<'a>) -> Self {
        Self { kind, question, config, request, members: vec![], records: vec![] }
    }

    /// Runs some members beside those that are done.
    ///
    /// # Errors
    /// Anything in [`ScheduleError`]; finished runs are kept, and unfinished ones are checkpointed.
    pub fn run(&mut self, members: Vec<Member>, campaigns: &mut Campaigns) -> Result<Answer<()>, ScheduleError> {
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

    /// Returns the members of a base with their records.
    pub fn of<'s>(&'s self, base: &'s str) -> impl Iterator<Item = (&'s Member, &'s [RunRecord])> {
        let all = self.members.iter().zip(self.records.iter().map(Vec::as_slice));
        all.filter(move |(member, _)| member.base == base)
    }

    /// Returns the record of the study so far.
    pub fn record(&self) -> StudyRecord {
        let member = |member: &Member| MemberRecord {
            id: member.id.clone(),
            base: member.base.clone(),
            variant: member.variant.clone(),
            values: member.values.iter().map(|(key, value)| (key.clone(), value.to_string())).collect(),
        };
        let members = self.members.iter().map(member).collect();
        let (question, config) = (self.question.clone(), self.config.clone());
        StudyRecord { format: FORMAT, kind: self.kind, question, config, members }
    }

    /// Returns the members and their runs.
    pub fn runs<'r>(&'r self, record: &'r StudyRecord) -> Vec<Runs<'r>> {
        record.members.iter().zip(&self.records).map(|(member, records)| Runs { member, records }).collect()
    }
}
