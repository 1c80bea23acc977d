//! Lists of questions about sequences: sweeps, ablations, comparisons and choices of inputs, as of experiments ([`super::lists`]).
//!
//! ```text
//! runs/<name>/
//!   study.json         StudyRecord
//!   runs/<id>/         a run folder of each question
//!   best-<base>.toml   of a sweep or a choice of inputs: what was chosen, ready to be run
//! ```
//!
//! `study = "best"` has a file of its own ([`best`]).
//!
//! Sequences have a validation part, which takes the place of folds: settings and inputs are chosen by their errors there, and nobody
//! looks at the test part. Differences are of pairs that share a sequence; windows of one sequence count as one.

pub mod best;

use std::path::Path;

use toml::Value;

use super::{
    inputs::{self, Tried},
    label::label,
    list::{self, Base, List, slug},
    record::{self, MemberRecord, StudyRecord},
    sequence_table::{self, Row},
    sweep::{Setting, Sweep},
};
use crate::config::{Kind, Persistence, Question, QuestionData, Source, read_question};
use crate::run::evaluation::summary::count;
use crate::run::record::FORMAT;
use crate::run::sequences::units;
use crate::schedule::engine::answer::Answer;
use crate::schedule::error::ScheduleError;
use crate::schedule::request::{Engine, Request};
use crate::schedule::sequences::{Answered, answer};
use crate::store::{StoreError, StudyFolder, atomic, hashed};

/// Returns whether a list is one of questions about sequences; that of its first base counts.
pub fn asks(list: &List, source: &Source) -> bool {
    let of_sequences = |base: &Base| {
        let file = source.path().parent().unwrap_or(Path::new("")).join(&base.experiment);
        let tree = Source::read(&file, &[]).ok().map(|file| file.tree);
        tree.is_some_and(|tree| tree.get("study").and_then(Value::as_str) == Some("sequences"))
    };
    list.base.first().is_some_and(of_sequences)
}

/// Runs a list of questions, and returns the table to print.
///
/// # Errors
/// Anything in [`ScheduleError`]; finished runs are kept, and unfinished ones are checkpointed.
pub fn conduct(kind: Kind, list: &List, source: &Source, request: &Request) -> Result<String, ScheduleError> {
    if !matches!(request.engine, Engine::Local) {
        return Err(ScheduleError::Usage {
            what: "lists of questions about sequences are computed here".into(),
            help: "leave --engine out, or submit the questions one by one".into(),
        });
    }
    let folder = StudyFolder::hold(request.out, request.hold())?;
    let mut study = Study { kind, list, source, request, rows: vec![] };
    let answer = match (&list.sweep, kind) {
        (Some(sweep), _) => study.sweep(sweep)?,
        (None, Kind::Inputs) => study.inputs()?,
        (None, _) => study.variants()?,
    };
    if let Answer::Waiting(text) = answer {
        return Ok(text);
    }
    let chosen = study.write_best(&folder)?;
    let root = request.out.display();
    let text = sequence_table::text(kind, &list.question, &study.rows);
    Ok(format!("{text}{chosen}\n\nrecords and predictions: {root}"))
}

struct Study<'a> {
    kind: Kind,
    list: &'a List,
    source: &'a Source,
    request: &'a Request<'a>,
    rows: Vec<Row>,
}

impl Study<'_> {
    /// Runs each variant of each base.
    fn variants(&mut self) -> Result<Answer<()>, ScheduleError> {
        let (list, source) = (self.list, self.source);
        for base in &list.base {
            for (name, values) in list.variants_of(base) {
                let edited = list.source_of(source, base, name, &values)?;
                if let Answer::Waiting(text) = self.run(base, name, values, edited, |_| ())? {
                    return Ok(Answer::Waiting(text));
                }
            }
        }
        Ok(Answer::Finished(()))
    }

    /// Runs setting after setting; proposals depend on the validation errors before.
    fn sweep(&mut self, sweep: &Sweep) -> Result<Answer<()>, ScheduleError> {
        let (list, source) = (self.list, self.source);
        for base in &list.base {
            let epochs = read_question(&mut list.source_of(source, base, "", &[])?)?.training.epochs;
            let mut tried: Vec<Setting> = vec![];
            loop {
                let batch = sweep.next(&tried, &self.errors(&base.name), epochs);
                if batch.is_empty() {
                    break;
                }
                for setting in batch {
                    let name = label(&setting);
                    let edited = list.source_of(source, base, &name, &setting)?;
                    let blind = |question: &mut Question| question.test = false;
                    if let Answer::Waiting(text) = self.run(base, &name, setting.clone(), edited, blind)? {
                        return Ok(Answer::Waiting(text));
                    }
                    tried.push(setting);
                }
            }
        }
        Ok(Answer::Finished(()))
    }

    /// Runs set after set of inputs.
    fn inputs(&mut self) -> Result<Answer<()>, ScheduleError> {
        let (list, source) = (self.list, self.source);
        for base in &list.base {
            let edited = list.source_of(source, base, "", &[])?;
            let all = seen(&edited)?;
            let mut batch = vec![all];
            while !batch.is_empty() {
                for set in batch {
                    let name = if self.of(&base.name).next().is_none() { "all inputs".into() } else { set.join(" ") };
                    let values = vec![(
                        "data.inputs".to_string(),
                        Value::Array(set.iter().cloned().map(Value::String).collect()),
                    )];
                    let chosen = |question: &mut Question| {
                        question.test = false;
                        see(question, &set);
                    };
                    if let Answer::Waiting(text) = self.run(base, &name, values, edited.clone(), chosen)? {
                        return Ok(Answer::Waiting(text));
                    }
                }
                batch = inputs::next(&self.tried(&base.name));
            }
        }
        Ok(Answer::Finished(()))
    }

    /// Runs one question in a folder of its own, after a change.
    fn run(
        &mut self,
        base: &Base,
        variant: &str,
        values: Vec<(String, Value)>,
        mut source: Source,
        change: impl Fn(&mut Question),
    ) -> Result<Answer<()>, ScheduleError> {
        let mut question = read_question(&mut source)?;
        change(&mut question);
        let id = list::folder(&base.name, variant);
        let out = record::folder(self.request.out, &id);
        let request = Request { out: &out, ..*self.request };
        let Answered { records, folder, set, .. } = match answer(&question, &source, &request, self.rows.is_empty())? {
            Answer::Waiting(text) => return Ok(Answer::Waiting(text)),
            Answer::Finished(answered) => answered,
        };
        let errors = records.iter().map(|record| units::errors(folder.root(), record)).collect::<Result<_, _>>()?;
        let values = values.into_iter().map(|(key, value)| (key, value.to_string())).collect();
        let member = MemberRecord { id, base: base.name.clone(), variant: variant.into(), values };
        self.rows.push(Row { member, question, inputs: set.channels, records, errors });
        self.note()
    }

    /// Writes the record of the study so far.
    fn note(&self) -> Result<Answer<()>, ScheduleError> {
        let members = self.rows.iter().map(|row| row.member.clone()).collect();
        let (question, config) = (self.list.question.clone(), self.source.file_name());
        let record = StudyRecord { format: FORMAT, kind: self.kind, question, config, members };
        hashed::write(&self.request.out.join("study.json"), &record)?;
        Ok(Answer::Finished(()))
    }

    fn of<'s>(&'s self, base: &'s str) -> impl Iterator<Item = &'s Row> {
        self.rows.iter().filter(move |row| row.member.base == base)
    }

    fn errors(&self, base: &str) -> Vec<f64> {
        self.of(base).map(Row::validation_error).collect()
    }

    fn tried(&self, base: &str) -> Vec<Tried> {
        self.of(base).map(Row::tried).collect()
    }

    /// Writes the settings chosen by a sweep or an elimination, with the seeds of the base and its test setting.
    fn write_best(&self, folder: &StudyFolder) -> Result<String, ScheduleError> {
        let mut text = String::new();
        for base in &self.list.base {
            let rows: Vec<&Row> = self.of(&base.name).collect();
            let place = match self.kind {
                Kind::Sweep => sequence_table::ranked(&rows).first().copied(),
                Kind::Inputs if !rows.is_empty() => Some(inputs::chosen(&self.tried(&base.name))),
                _ => None,
            };
            let Some(row) = place.map(|place| rows[place]) else { continue };
            let original = read_question(&mut self.list.untouched(self.source, base)?)?;
            let chosen = Question { seeds: original.seeds, test: original.test, ..row.question.clone() };
            let path = folder.path(&format!("best-{}.toml", slug(&base.name)));
            let asked = toml::to_string(&chosen)
                .map_err(|error| StoreError::io("write", &path, std::io::Error::other(error)))?;
            let from = count(rows.len(), "question");
            let head = format!("# {}\n# Chosen by validation error from {from}.\n\n", chosen.question);
            atomic::write(&path, (head + &asked).as_bytes())?;
            text += &format!("\n\nchosen, ready to be run: {}", path.display());
        }
        Ok(text)
    }
}

/// Leaves all other inputs out.
fn see(question: &mut Question, inputs: &[String]) {
    if let QuestionData::Table(asked) = &mut question.data {
        asked.inputs = inputs.to_vec();
    }
}

/// Returns the inputs of a question, of which some may be left out.
fn seen(source: &Source) -> Result<Vec<String>, ScheduleError> {
    let question = read_question(&mut source.clone())?;
    match (&question.data, question.nominal) {
        (QuestionData::Table(asked), Persistence::None) => Ok(asked.inputs.clone()),
        (QuestionData::Table(_), _) => Err(ScheduleError::Usage {
            what: "inputs cannot be left out of a question whose answers are added to the last value seen".into(),
            help: "choose them with nominal = \"none\" in [set]".into(),
        }),
        _ => Err(ScheduleError::Usage {
            what: "streams of bits have one input".into(),
            help: "choose inputs of tables: data.kind = \"table\"".into(),
        }),
    }
}
